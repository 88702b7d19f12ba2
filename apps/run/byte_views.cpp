#include "apps/run/byte_views.h"

#include "meshing/scene_error.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace patchlight {

static_assert(std::endian::native == std::endian::little, "arrays are stored as they are in memory");
static_assert(sizeof(Vec3) == 3 * sizeof(double));

namespace {

template <class T>
std::vector<unsigned char> copied(std::span<const T> values)
{
    std::vector<unsigned char> bytes(values.size_bytes());
    if (!bytes.empty()) {
        std::memcpy(bytes.data(), values.data(), bytes.size());
    }
    return bytes;
}

const std::vector<unsigned char>& find(const ByteViews& views, const std::string& name)
{
    const auto found = views.find(name);
    if (found == views.end()) {
        throw SceneError("solution", "the array \"" + name + "\" is missing");
    }
    return found->second;
}

template <class T>
std::vector<T> values_in(const ByteViews& views, const std::string& name)
{
    const std::vector<unsigned char>& bytes = find(views, name);
    if (bytes.size() % sizeof(T) != 0) {
        throw SceneError("solution", "the array \"" + name + "\" is cut short");
    }
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!bytes.empty()) {
        std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
    }
    return values;
}

}  // namespace

std::vector<unsigned char> bytes_of(std::span<const double> values)
{
    return copied(values);
}

std::vector<unsigned char> bytes_of(std::span<const std::uint32_t> values)
{
    return copied(values);
}

std::vector<unsigned char> bytes_of(std::span<const Vec3> values)
{
    return copied(values);
}

std::vector<double> doubles_in(const ByteViews& views, const std::string& name)
{
    std::vector<double> values = values_in<double>(views, name);
    for (double value : values) {
        if (!std::isfinite(value)) {
            throw SceneError("solution", "the array \"" + name + "\" holds a number that is not finite");
        }
    }
    return values;
}

std::vector<std::uint32_t> integers_in(const ByteViews& views, const std::string& name)
{
    return values_in<std::uint32_t>(views, name);
}

std::vector<Vec3> vectors_in(const ByteViews& views, const std::string& name)
{
    const std::vector<double> values = doubles_in(views, name);
    if (values.size() % 3 != 0) {
        throw SceneError("solution", "the array \"" + name + "\" is cut short");
    }
    std::vector<Vec3> vectors(values.size() / 3);
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        vectors[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    }
    return vectors;
}

std::string text_in(const ByteViews& views, const std::string& name)
{
    const std::vector<unsigned char>& bytes = find(views, name);
    return {bytes.begin(), bytes.end()};
}

}  // namespace patchlight
