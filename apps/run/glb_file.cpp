#include "apps/run/glb_file.h"

#include "apps/run/exporting.h"
#include "apps/run/gltf_buffer.h"
#include "apps/run/gltf_scene.h"
#include "apps/run/stored_scene.h"
#include "meshing/scene_error.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <numbers>

namespace patchlight {

namespace {

constexpr std::size_t deepest_json = 64;
constexpr const char* schema = "patchlight-solution/1";

std::vector<float> floats_of(std::span<const Vec3> values, double scale, double highest)
{
    std::vector<float> result;
    result.reserve(values.size() * 3);
    for (const Vec3& v : values) {
        for (int k = 0; k < 3; ++k) {
            result.push_back(static_cast<float>(std::min(v[k] * scale, highest)));
        }
    }
    return result;
}

void add_geometry(const Scene& scene, const PatchMesh& mesh, const VertexRadiosity& vertex_B, double scale,
                  tinygltf::Model& model, GltfBuffer& buffer)
{
    const double unbounded = std::numeric_limits<double>::infinity();
    std::map<std::string, int> attributes;
    attributes["POSITION"] = buffer.floats(floats_of(mesh.arrays().positions, 1, unbounded), 3, true);
    attributes["COLOR_0"] = buffer.floats(floats_of(vertex_B.values(), scale / std::numbers::pi, 1), 3, false);
    attributes["_RADIOSITY"] = buffer.floats(floats_of(vertex_B.values(), 1, unbounded), 3, false);
    std::vector<std::vector<std::uint32_t>> corners(scene.materials.size());
    for (PatchId patch : mesh.patches()) {
        const auto& t = mesh.arrays().triangles[patch.value];
        auto& list = corners[scene.surface(mesh.surface(patch)).material.value];
        list.insert(list.end(), t.begin(), t.end());
    }
    tinygltf::Mesh entry;
    entry.name = "patches";
    for (std::size_t m = 0; m < corners.size(); ++m) {
        model.materials.push_back(unlit_material(scene.materials[m]));
        if (corners[m].empty()) {
            continue;
        }
        tinygltf::Primitive primitive;
        primitive.attributes = attributes;
        primitive.indices = buffer.indices(corners[m]);
        primitive.material = static_cast<int>(m);
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        entry.primitives.push_back(primitive);
    }
    model.meshes.push_back(entry);
}

/// tinygltf reads extras recursively: a deep one would end in a stack overflow, so look before it does.
void check_header(std::string_view bytes)
{
    std::uint32_t length = 0;
    if (bytes.size() < 20 || bytes.substr(0, 4) != "glTF" || bytes.size() > 0x7fffffffU) {
        throw SceneError("solution", "is not a stored solution");
    }
    std::memcpy(&length, bytes.data() + 12, 4);
    if (length > bytes.size() - 20) {
        throw SceneError("solution", "is cut short");
    }
    if (json_depth(bytes.substr(20, length)) > deepest_json) {
        throw SceneError("solution", "is nested too deeply");
    }
}

tinygltf::FsCallbacks no_files()
{
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = [](const std::string&, void*) { return false; };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>*, std::string*, const std::string&, void*) {
        return false;
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    };
    return callbacks;
}

tinygltf::Model parsed(std::string_view bytes)
{
    check_header(bytes);
    tinygltf::Model model;
    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks(no_files());
    reader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                             void*) { return false; },
                          nullptr);
    std::string error, warning;
    bool read = false;
    try {
        read =
            reader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()),
                                        static_cast<unsigned int>(bytes.size()));
    } catch (const std::exception& problem) {
        error = problem.what();
    }
    if (!read) {
        throw SceneError("solution", "can't be read: " + error);
    }
    return model;
}

}  // namespace

std::string encode_glb(const Scene& scene, const PatchMesh& mesh, const VertexRadiosity& vertex_B,
                       const ByteViews& views)
{
    tinygltf::Model model;
    GltfBuffer buffer(model);
    // COLOR_0 must lie in [0, 1].
    const double scale = display_scale(scene, mesh, vertex_B);
    add_geometry(scene, mesh, vertex_B, scale, model, buffer);
    add_nodes(scene, model);
    tinygltf::Value::Object names;
    for (const auto& [name, bytes] : views) {
        if (!bytes.empty()) {
            names[name] = tinygltf::Value(buffer.view(bytes.data(), bytes.size()));
        }
    }
    model.extras = tinygltf::Value(tinygltf::Value::Object{
        {"patchlight", tinygltf::Value(tinygltf::Value::Object{{"schema", tinygltf::Value(std::string(schema))},
                                                               {"color_scale", tinygltf::Value(scale)},
                                                               {"views", tinygltf::Value(names)}})}});
    return glb_of(model);
}

ByteViews decode_glb(std::string_view bytes)
{
    const tinygltf::Model model = parsed(bytes);
    if (!model.extras.IsObject() || !model.extras.Has("patchlight") || !model.extras.Get("patchlight").Has("views")) {
        throw SceneError("solution", "holds no patchlight solution");
    }
    const tinygltf::Value& ours = model.extras.Get("patchlight");
    if (!ours.Get("schema").IsString() || ours.Get("schema").Get<std::string>() != schema) {
        throw SceneError("solution", "is of another schema than " + std::string(schema));
    }
    ByteViews views;
    for (const std::string& name : ours.Get("views").Keys()) {
        const tinygltf::Value& number = ours.Get("views").Get(name);
        const int index = number.IsInt() ? number.Get<int>() : -1;
        if (index < 0 || static_cast<std::size_t>(index) >= model.bufferViews.size()) {
            throw SceneError("solution", "the array \"" + name + "\" is missing");
        }
        const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(index)];
        if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size()) {
            throw SceneError("solution", "the array \"" + name + "\" is missing");
        }
        const auto& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
        if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
            throw SceneError("solution", "the array \"" + name + "\" is cut short");
        }
        const auto first = data.begin() + static_cast<std::ptrdiff_t>(view.byteOffset);
        views[name].assign(first, first + static_cast<std::ptrdiff_t>(view.byteLength));
    }
    return views;
}

}  // namespace patchlight
