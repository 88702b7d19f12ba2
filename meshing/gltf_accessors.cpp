#include "meshing/gltf_accessors.h"

#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace patchlight {

namespace {

constexpr std::uint32_t unset = std::numeric_limits<std::uint32_t>::max();

[[noreturn]] void refuse(const std::string& where, const std::string& reason)
{
    throw SceneError("gltf", fmt::format("{}: {}", where, reason));
}

const tinygltf::Accessor* accessor_at(const GltfFile& gltf, int index)
{
    if (index < 0 || static_cast<std::size_t>(index) >= gltf.model.accessors.size()) return nullptr;
    return &gltf.model.accessors[static_cast<std::size_t>(index)];
}

int position_accessor(const tinygltf::Primitive& primitive)
{
    const auto position = primitive.attributes.find("POSITION");
    return position == primitive.attributes.end() ? -1 : position->second;
}

/// An accessor whose elements all lie inside their buffer.
struct Elements {
    const unsigned char* first = nullptr;
    std::size_t count = 0;
    std::size_t stride = 0;
    int component = 0;
    bool normalized = false;
};

Elements open_accessor(const GltfFile& gltf, int index, int type, const std::string& where)
{
    const tinygltf::Accessor* accessor = accessor_at(gltf, index);
    if (!accessor) refuse(where, fmt::format("accessor {} of {}", index, gltf.model.accessors.size()));
    if (accessor->sparse.isSparse) refuse(where, fmt::format("accessor {} is sparse, which is not supported", index));
    if (accessor->type != type) refuse(where, fmt::format("accessor {} has the wrong type", index));
    if (accessor->bufferView < 0 || static_cast<std::size_t>(accessor->bufferView) >= gltf.model.bufferViews.size()) {
        refuse(where, fmt::format("accessor {} has no buffer view", index));
    }
    const tinygltf::BufferView& view = gltf.model.bufferViews[static_cast<std::size_t>(accessor->bufferView)];
    const auto& data = gltf.model.buffers.at(static_cast<std::size_t>(view.buffer)).data;
    const int stride = accessor->ByteStride(view);
    const int component_size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor->componentType));
    if (stride <= 0 || component_size <= 0)
        refuse(where, fmt::format("accessor {} has a wrong stride or component type", index));
    const std::size_t element =
        static_cast<std::size_t>(component_size) *
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
    Elements elements{nullptr, accessor->count, static_cast<std::size_t>(stride), accessor->componentType,
                      accessor->normalized};
    if (elements.count == 0) return elements;
    const std::size_t room =
        view.byteOffset <= data.size() ? std::min(view.byteLength, data.size() - view.byteOffset) : 0;
    const bool fits = accessor->byteOffset <= room && element <= room - accessor->byteOffset &&
                      elements.count - 1 <= (room - accessor->byteOffset - element) / elements.stride;
    if (!fits) {
        refuse(where, fmt::format("accessor {} claims {} elements, its buffer view has {} bytes", index, elements.count,
                                  room));
    }
    elements.first = data.data() + view.byteOffset + accessor->byteOffset;
    return elements;
}

template <class T>
T load(const unsigned char* bytes)
{
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

template <class T>
double load_integer(const unsigned char* bytes, std::size_t k, bool normalized)
{
    const double value = load<T>(bytes + k * sizeof(T));
    if (!normalized) return value;
    return std::max(value / std::numeric_limits<T>::max(), -1.0);
}

double component(const Elements& elements, const unsigned char* at, std::size_t k, const std::string& where)
{
    switch (elements.component) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return load<float>(at + 4 * k);
    case TINYGLTF_COMPONENT_TYPE_DOUBLE:
        return load<double>(at + 8 * k);
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return load_integer<std::int8_t>(at, k, elements.normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return load_integer<std::uint8_t>(at, k, elements.normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return load_integer<std::int16_t>(at, k, elements.normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return load_integer<std::uint16_t>(at, k, elements.normalized);
    default:
        refuse(where, "positions have a component type that is not allowed");
    }
}

std::vector<std::size_t> read_indices(const GltfFile& gltf, int accessor, std::size_t vertices,
                                      const std::string& where)
{
    std::vector<std::size_t> indices;
    if (accessor < 0) {
        indices.resize(vertices);
        for (std::size_t i = 0; i < vertices; ++i) indices[i] = i;
        return indices;
    }
    const Elements elements = open_accessor(gltf, accessor, TINYGLTF_TYPE_SCALAR, where);
    indices.reserve(elements.count);
    for (std::size_t i = 0; i < elements.count; ++i) {
        const unsigned char* at = elements.first + i * elements.stride;
        switch (elements.component) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            indices.push_back(load<std::uint8_t>(at));
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            indices.push_back(load<std::uint16_t>(at));
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            indices.push_back(load<std::uint32_t>(at));
            break;
        default:
            refuse(where, "indices have a component type that is not allowed");
        }
        if (indices.back() >= vertices) {
            throw SceneError("index",
                             fmt::format("{}: index {} refers to vertex {} of {}", where, i, indices.back(), vertices));
        }
    }
    return indices;
}

std::array<std::size_t, 3> corners_of(std::size_t triangle, int mode)
{
    const std::size_t t = triangle;
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {0, t + 1, t + 2};
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) return {t, t + 1 + t % 2, t + 2 - t % 2};
    return {3 * t, 3 * t + 1, 3 * t + 2};
}

}  // namespace

bool has_data(const GltfFile& gltf, const tinygltf::Primitive& primitive)
{
    for (const int index : {primitive.indices, position_accessor(primitive)}) {
        const tinygltf::Accessor* accessor = accessor_at(gltf, index);
        if (!accessor || accessor->bufferView < 0) continue;
        const auto view = static_cast<std::size_t>(accessor->bufferView);
        if (view >= gltf.model.bufferViews.size()) continue;
        if (gltf.buffer_refused.at(static_cast<std::size_t>(gltf.model.bufferViews[view].buffer))) return false;
    }
    return true;
}

GltfTriangles read_triangles(const GltfFile& gltf, const tinygltf::Primitive& primitive, const std::string& where)
{
    const int position = position_accessor(primitive);
    if (position < 0) refuse(where, "has no POSITION");
    if (primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        refuse(where, fmt::format("has no known mode: {}", primitive.mode));
    const Elements elements = open_accessor(gltf, position, TINYGLTF_TYPE_VEC3, where);
    const std::vector<std::size_t> indices = read_indices(gltf, primitive.indices, elements.count, where);
    const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode < 0;
    const std::size_t count = list ? indices.size() / 3 : indices.size() < 3 ? 0 : indices.size() - 2;

    GltfTriangles result;
    std::vector<std::uint32_t> slot(elements.count, unset);
    for (std::size_t t = 0; t < count; ++t) {
        std::array<std::uint32_t, 3> triangle{};
        const auto corners = corners_of(t, primitive.mode);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t v = indices[corners[k]];
            if (slot[v] == unset) {
                slot[v] = static_cast<std::uint32_t>(result.positions.size());
                const unsigned char* at = elements.first + v * elements.stride;
                result.positions.emplace_back(component(elements, at, 0, where), component(elements, at, 1, where),
                                              component(elements, at, 2, where));
            }
            triangle[k] = slot[v];
        }
        result.triangles.push_back(triangle);
    }
    return result;
}

}  // namespace patchlight
