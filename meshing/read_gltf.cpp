#include "meshing/gltf_accessors.h"
#include "meshing/gltf_file.h"
#include "meshing/gltf_nodes.h"
#include "meshing/gltf_textures.h"
#include "meshing/raw_scene.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <numbers>
#include <set>

namespace patchlight {

namespace {

constexpr std::size_t most_corners = 100'000'000;

const std::set<std::string> understood_extensions = {"KHR_materials_emissive_strength",
                                                     "KHR_mesh_quantization",
                                                     "KHR_materials_unlit",
                                                     "KHR_texture_transform",
                                                     "KHR_materials_ior",
                                                     "KHR_materials_specular",
                                                     "KHR_lights_punctual"};

/// Turns a model into faces, node by node.
class GltfCollector {
public:
    GltfCollector(const GltfFile& gltf, double unit, RawScene& raw) : gltf_(gltf), unit_(unit), raw_(raw) {}

    void read_materials();
    void read_nodes();

private:
    Rgb with_texture(const Rgb& factor, int texture, const std::string& material, const char* what);
    Material material_of(const tinygltf::Material& read, std::size_t index);
    void add_mesh(const PlacedNode& node);
    void add_primitive(const tinygltf::Primitive& primitive, const PlacedNode& node, const std::string& where);
    void add_camera(const PlacedNode& node);
    MaterialId default_material();

    const GltfFile& gltf_;
    double unit_;
    RawScene& raw_;
    MaterialId default_material_;
};

Rgb GltfCollector::with_texture(const Rgb& factor, int texture, const std::string& material, const char* what)
{
    if (texture < 0) return factor;
    std::string why;
    const auto mean = mean_texture_colour(gltf_, texture, why);
    if (!mean) {
        raw_.warnings.push_back(fmt::format("material {}: {} texture is ignored: {}", material, what, why));
        return factor;
    }
    raw_.warnings.push_back(fmt::format("material {}: {} texture counts as its mean colour {:.3f} {:.3f} {:.3f}",
                                        material, what, mean->r, mean->g, mean->b));
    return factor * *mean;
}

Material GltfCollector::material_of(const tinygltf::Material& read, std::size_t index)
{
    Material material;
    material.name = read.name.empty() ? fmt::format("material {}", index) : read.name;
    material.two_sided = read.doubleSided;
    const auto& colour = read.pbrMetallicRoughness.baseColorFactor;
    Rgb base{1.0};
    for (std::size_t k = 0; k < 3 && k < colour.size(); ++k) base[static_cast<int>(k)] = colour[k];
    material.reflectance =
        with_texture(base, read.pbrMetallicRoughness.baseColorTexture.index, material.name, "base colour");
    Rgb radiance{0.0};
    for (std::size_t k = 0; k < 3 && k < read.emissiveFactor.size(); ++k) {
        radiance[static_cast<int>(k)] = read.emissiveFactor[k];
    }
    if (radiance != Rgb{0.0}) {
        radiance = with_texture(radiance, read.emissiveTexture.index, material.name, "emissive");
        const auto strength = read.extensions.find("KHR_materials_emissive_strength");
        if (strength != read.extensions.end() && strength->second.Has("emissiveStrength")) {
            radiance *= strength->second.Get("emissiveStrength").GetNumberAsDouble();
        }
    }
    material.emission = std::numbers::pi * radiance;
    if (read.alphaMode == "BLEND" || read.alphaMode == "MASK") {
        raw_.warnings.push_back(fmt::format("material {}: transparency is ignored, it is opaque here", material.name));
    }
    return material;
}

void GltfCollector::read_materials()
{
    for (std::size_t m = 0; m < gltf_.model.materials.size(); ++m) {
        raw_.materials.push_back(material_of(gltf_.model.materials[m], m));
    }
}

MaterialId GltfCollector::default_material()
{
    if (!default_material_.valid()) {
        default_material_ = MaterialId(raw_.materials.size());
        raw_.materials.push_back(Material{.name = "default"});
        raw_.warnings.push_back(fmt::format("{}: faces without a material have reflectance 0.5", raw_.file_name));
    }
    return default_material_;
}

void GltfCollector::read_nodes()
{
    for (const PlacedNode& node : place_nodes(gltf_, raw_.warnings)) {
        const tinygltf::Node& read = gltf_.model.nodes[node.index];
        if (read.camera >= 0) add_camera(node);
        if (read.mesh >= 0) add_mesh(node);
    }
}

void GltfCollector::add_mesh(const PlacedNode& node)
{
    const tinygltf::Node& read = gltf_.model.nodes[node.index];
    if (static_cast<std::size_t>(read.mesh) >= gltf_.model.meshes.size()) {
        throw SceneError("gltf", fmt::format("{}: node {} refers to mesh {} of {}", gltf_.name, node.index, read.mesh,
                                             gltf_.model.meshes.size()));
    }
    const tinygltf::Mesh& mesh = gltf_.model.meshes[static_cast<std::size_t>(read.mesh)];
    raw_.objects.push_back(!read.name.empty()   ? read.name
                           : !mesh.name.empty() ? mesh.name
                                                : fmt::format("node {}", node.index));
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
        const std::string where = fmt::format("{}: mesh {} ({}), primitive {}", gltf_.name, read.mesh, mesh.name, p);
        const tinygltf::Primitive& primitive = mesh.primitives[p];
        if (primitive.mode >= 0 && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
            raw_.warnings.push_back(fmt::format("{}: points and lines are ignored", where));
        } else if (!has_data(gltf_, primitive)) {
            raw_.warnings.push_back(fmt::format("{}: ignored, its buffer was not opened", where));
        } else {
            add_primitive(primitive, node, where);
        }
    }
}

void GltfCollector::add_primitive(const tinygltf::Primitive& primitive, const PlacedNode& node,
                                  const std::string& where)
{
    const GltfTriangles mesh = read_triangles(gltf_, primitive, where);
    const auto material = static_cast<std::size_t>(primitive.material);
    if (primitive.material >= 0 && material >= gltf_.model.materials.size()) {
        throw SceneError("gltf", fmt::format("{}: material {} of {}", where, material, gltf_.model.materials.size()));
    }
    if (raw_.corners.size() + 3 * mesh.triangles.size() > most_corners) {
        throw SceneError("gltf", fmt::format("{}: more than {} triangles", gltf_.name, most_corners / 3));
    }
    const auto first = static_cast<std::int64_t>(raw_.vertices.size());
    for (const Vec3& p : mesh.positions) raw_.vertices.push_back(unit_ * node.place(p));
    for (auto triangle : mesh.triangles) {
        // A mirrored node turns the winding round, and with it the front.
        if (node.mirrored()) std::swap(triangle[1], triangle[2]);
        RawFace face{raw_.corners.size(), 3, {}, ObjectId(raw_.objects.size() - 1), 0};
        face.material = primitive.material >= 0 ? MaterialId(material) : default_material();
        raw_.faces.push_back(face);
        for (const std::uint32_t corner : triangle) raw_.corners.push_back(first + corner);
    }
}

void GltfCollector::add_camera(const PlacedNode& node)
{
    const auto index = static_cast<std::size_t>(gltf_.model.nodes[node.index].camera);
    if (index >= gltf_.model.cameras.size()) {
        throw SceneError("gltf", fmt::format("{}: node {} refers to camera {} of {}", gltf_.name, node.index, index,
                                             gltf_.model.cameras.size()));
    }
    const tinygltf::Camera& camera = gltf_.model.cameras[index];
    const std::string& node_name = gltf_.model.nodes[node.index].name;
    View view;
    view.name = !camera.name.empty() ? camera.name : !node_name.empty() ? node_name : fmt::format("camera {}", index);
    const double fov = camera.perspective.yfov * 180 / std::numbers::pi;
    if (camera.type != "perspective" || !(fov > 0 && fov < 180)) {
        raw_.warnings.push_back(fmt::format("camera {} is ignored: it is not a perspective one", view.name));
        return;
    }
    const Vec3 forward = node.direction({0, 0, -1}), up = node.direction({0, 1, 0});
    if (!(glm::length(glm::cross(forward, up)) > 0)) {
        raw_.warnings.push_back(fmt::format("camera {} is ignored: its node has no extent", view.name));
        return;
    }
    view.from = unit_ * node.place({0, 0, 0});
    view.forward = glm::normalize(forward);
    view.up = glm::normalize(up - glm::dot(up, view.forward) * view.forward);
    view.vertical_fov = fov;
    view.aspect = camera.perspective.aspectRatio > 0 ? camera.perspective.aspectRatio : 0;
    raw_.views.push_back(view);
}

}  // namespace

RawScene read_gltf(const std::filesystem::path& file, double unit)
{
    GltfFile gltf = load_gltf(file);
    RawScene raw;
    raw.format = "gltf";
    raw.file_name = gltf.name;
    raw.relative_precision = 0x1p-24;
    raw.warnings = std::move(gltf.warnings);
    for (const std::string& extension : gltf.required_extensions) {
        if (!understood_extensions.contains(extension)) {
            throw SceneError("gltf",
                             fmt::format("{}: needs the extension {}, which is not supported", gltf.name, extension));
        }
    }
    GltfCollector collector(gltf, unit, raw);
    collector.read_materials();
    collector.read_nodes();
    return raw;
}

}  // namespace patchlight
