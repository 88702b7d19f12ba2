#pragma once

#include <tiny_gltf.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace patchlight {

/// Appends arrays to the one buffer of a model, each as a bufferView.
class GltfBuffer {
public:
    explicit GltfBuffer(tinygltf::Model& model) : model_(model) { model_.buffers.emplace_back(); }

    int view(const void* data, std::size_t bytes, int target = 0)
    {
        std::vector<unsigned char>& all = model_.buffers[0].data;
        all.resize((all.size() + 7) / 8 * 8);
        tinygltf::BufferView entry;
        entry.buffer = 0;
        entry.byteOffset = all.size();
        entry.byteLength = bytes;
        entry.target = target;
        const auto* first = static_cast<const unsigned char*>(data);
        all.insert(all.end(), first, first + bytes);
        model_.bufferViews.push_back(entry);
        return static_cast<int>(model_.bufferViews.size()) - 1;
    }

    /// Vectors of `components` floats, 2 or 3.
    int floats(const std::vector<float>& values, std::size_t components, bool with_bounds)
    {
        tinygltf::Accessor entry;
        entry.bufferView = view(values.data(), values.size() * sizeof(float), TINYGLTF_TARGET_ARRAY_BUFFER);
        entry.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
        entry.type = components == 2 ? TINYGLTF_TYPE_VEC2 : TINYGLTF_TYPE_VEC3;
        entry.count = values.size() / components;
        for (std::size_t axis = 0; with_bounds && axis < components; ++axis) {
            float low = values[axis], high = values[axis];
            for (std::size_t i = axis; i < values.size(); i += components) {
                low = std::min(low, values[i]);
                high = std::max(high, values[i]);
            }
            entry.minValues.push_back(static_cast<double>(low));
            entry.maxValues.push_back(static_cast<double>(high));
        }
        model_.accessors.push_back(entry);
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    int indices(const std::vector<std::uint32_t>& values)
    {
        tinygltf::Accessor entry;
        entry.bufferView =
            view(values.data(), values.size() * sizeof(std::uint32_t), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        entry.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        entry.type = TINYGLTF_TYPE_SCALAR;
        entry.count = values.size();
        model_.accessors.push_back(entry);
        return static_cast<int>(model_.accessors.size()) - 1;
    }

private:
    tinygltf::Model& model_;
};

}  // namespace patchlight
