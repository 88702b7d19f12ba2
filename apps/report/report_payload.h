#pragma once

#include "apps/run/run_options.h"
#include "meshing/vectors.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

/// The page's numbers: arrays one after another, little endian, each at a multiple of four bytes. Each call adds one
/// and returns what the page needs to find it: {at, count, type}.
class ReportPayload {
public:
    Json floats(std::span<const float> values);
    /// In 16 bits a number, as parts of the largest, which is added as `scale`: relative precision 1/2048 down to
    /// 6e-5 of it, smaller than 3e-8 of it is 0. Numbers must be finite and not negative.
    Json halves(std::span<const float> values);
    /// Points in 16 bits a coordinate, as parts of their bounding box, whose `low` and `size` are added: exact to half
    /// of a 65535th of each side.
    Json rounded_points(std::span<const Vec3> points);
    Json integers(std::span<const std::uint32_t> values);
    /// As integers(), in 16 bits where all fit, else in 32.
    Json indices(std::span<const std::uint32_t> values);

    const std::string& bytes() const { return bytes_; }

private:
    Json add(const void* data, std::size_t size, std::size_t count, const char* type);

    std::string bytes_;
};

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// JSON that is safe inside a script element: no <, >, & and none of the two line ends that JavaScript knows.
std::string script_json(const Json& json);

}  // namespace patchlight
