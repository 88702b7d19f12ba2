#include "apps/run/glb_file.h"

#include "apps/run/exporting.h"
#include "apps/run/stored_scene.h"
#include "meshing/scene_error.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <numbers>
#include <sstream>

namespace patchlight {

namespace {

constexpr std::size_t deepest_json = 64;
constexpr const char* schema = "patchlight-solution/1";

/// Appends arrays to the one buffer of a model, each as a bufferView.
class BufferBuilder {
public:
    explicit BufferBuilder(tinygltf::Model& model) : model_(model) { model_.buffers.emplace_back(); }

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

    int floats(const std::vector<float>& values, bool with_bounds)
    {
        tinygltf::Accessor entry;
        entry.bufferView = view(values.data(), values.size() * sizeof(float), TINYGLTF_TARGET_ARRAY_BUFFER);
        entry.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
        entry.type = TINYGLTF_TYPE_VEC3;
        entry.count = values.size() / 3;
        for (std::size_t axis = 0; with_bounds && axis < 3; ++axis) {
            float low = values[axis], high = values[axis];
            for (std::size_t i = axis; i < values.size(); i += 3) {
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

tinygltf::Value value_of(const Rgb& c)
{
    return tinygltf::Value(tinygltf::Value::Array{tinygltf::Value(c.r), tinygltf::Value(c.g), tinygltf::Value(c.b)});
}

/// Unlit: the light is in the colours already.
tinygltf::Material material_of(const Material& material)
{
    tinygltf::Material entry;
    entry.name = as_utf8(material.name);
    entry.doubleSided = false;
    entry.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
    entry.extras = tinygltf::Value(tinygltf::Value::Object{{"reflectance", value_of(material.reflectance)},
                                                           {"emission", value_of(material.emission)}});
    return entry;
}

void add_geometry(const Scene& scene, const PatchMesh& mesh, const VertexRadiosity& vertex_B, double scale,
                  tinygltf::Model& model, BufferBuilder& buffer)
{
    const double unbounded = std::numeric_limits<double>::infinity();
    std::map<std::string, int> attributes;
    attributes["POSITION"] = buffer.floats(floats_of(mesh.arrays().positions, 1, unbounded), true);
    attributes["COLOR_0"] = buffer.floats(floats_of(vertex_B.values(), scale / std::numbers::pi, 1), false);
    attributes["_RADIOSITY"] = buffer.floats(floats_of(vertex_B.values(), 1, unbounded), false);
    std::vector<std::vector<std::uint32_t>> corners(scene.materials.size());
    for (PatchId patch : mesh.patches()) {
        const auto& t = mesh.arrays().triangles[patch.value];
        auto& list = corners[scene.surface(mesh.surface(patch)).material.value];
        list.insert(list.end(), t.begin(), t.end());
    }
    tinygltf::Mesh entry;
    entry.name = "patches";
    for (std::size_t m = 0; m < corners.size(); ++m) {
        model.materials.push_back(material_of(scene.materials[m]));
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

void add_node(const Scene& scene, tinygltf::Model& model)
{
    tinygltf::Node node;
    node.name = as_utf8(scene.name);
    node.mesh = 0;
    node.translation = {scene.center.x, scene.center.y, scene.center.z};
    model.nodes.push_back(node);
    tinygltf::Scene entry;
    entry.nodes = {0};
    model.scenes.push_back(entry);
    model.defaultScene = 0;
    model.extensionsUsed = {"KHR_materials_unlit"};
    model.asset.version = "2.0";
    model.asset.generator = "patchlight";
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
    BufferBuilder buffer(model);
    // COLOR_0 must lie in [0, 1].
    const double scale = display_scale(scene, mesh, vertex_B);
    add_geometry(scene, mesh, vertex_B, scale, model, buffer);
    add_node(scene, model);
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
    std::ostringstream out;
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&model, out, false, true)) {
        throw std::runtime_error("can't encode solution.glb");
    }
    return std::move(out).str();
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
