#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace patchlight {

/// An index that can't be mixed up with another kind of index. A default-made one is invalid.
template <class Tag>
struct Id {
    static constexpr std::uint32_t invalid_value = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t value = invalid_value;

    constexpr Id() = default;
    explicit constexpr Id(std::size_t index) : value(static_cast<std::uint32_t>(index)) {}

    constexpr bool valid() const { return value != invalid_value; }
    constexpr auto operator<=>(const Id&) const = default;
};

using SurfaceId = Id<struct SurfaceTag>;
using MaterialId = Id<struct MaterialTag>;
using ObjectId = Id<struct ObjectTag>;
using PatchId = Id<struct PatchTag>;
using VertexId = Id<struct VertexTag>;

}  // namespace patchlight
