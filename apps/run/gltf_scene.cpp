#include "apps/run/gltf_scene.h"

#include "apps/run/stored_scene.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace patchlight {

namespace {

tinygltf::Value value_of(const Rgb& c)
{
    return tinygltf::Value(tinygltf::Value::Array{tinygltf::Value(c.r), tinygltf::Value(c.g), tinygltf::Value(c.b)});
}

/// One-sided, too, when the material isn't: a two-sided polygon is two surfaces.
tinygltf::Material named_material(const Material& material)
{
    tinygltf::Material entry;
    entry.name = as_utf8(material.name);
    entry.doubleSided = false;
    entry.extras = tinygltf::Value(tinygltf::Value::Object{{"reflectance", value_of(material.reflectance)},
                                                           {"emission", value_of(material.emission)}});
    return entry;
}

/// A glTF camera looks along its node's −z, y up.
std::vector<double> rotation_of(const View& view)
{
    const Vec3 back = -glm::normalize(view.forward);
    Vec3 right = glm::cross(view.up, back);
    if (!(glm::length(right) > 1e-6 * glm::length(view.up))) {
        right = glm::cross(std::abs(back.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{0, 0, -1}, back);
    }
    right = glm::normalize(right);
    const glm::dquat q = glm::normalize(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back)));
    return {q.x, q.y, q.z, q.w};
}

void add_camera(const Scene& scene, const View& view, tinygltf::Model& model)
{
    tinygltf::Camera camera;
    camera.name = as_utf8(view.name);
    camera.type = "perspective";
    camera.perspective.yfov = view.vertical_fov * std::numbers::pi / 180;
    camera.perspective.aspectRatio = view.aspect;  // 0 isn't written
    camera.perspective.znear = 1e-3 * scene.diameter;
    camera.perspective.zfar = glm::length(view.from) + scene.diameter;
    tinygltf::Node node;
    node.name = camera.name;
    node.camera = static_cast<int>(model.cameras.size());
    const Vec3 from = view.from + scene.center;
    node.translation = {from.x, from.y, from.z};
    node.rotation = rotation_of(view);
    model.cameras.push_back(camera);
    model.nodes.push_back(node);
}

}  // namespace

tinygltf::Material unlit_material(const Material& material)
{
    tinygltf::Material entry = named_material(material);
    entry.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
    return entry;
}

tinygltf::Material lit_material(const Material& material)
{
    tinygltf::Material entry = named_material(material);
    const Rgb& rho = material.reflectance;
    entry.pbrMetallicRoughness.baseColorFactor = {rho.r, rho.g, rho.b, 1};
    entry.pbrMetallicRoughness.metallicFactor = 0;
    const Rgb radiance = material.emission / std::numbers::pi;
    const double strength = std::max({radiance.r, radiance.g, radiance.b, 1.0});
    if (material.emits()) {
        entry.emissiveFactor = {radiance.r / strength, radiance.g / strength, radiance.b / strength};
    }
    if (strength > 1) {
        entry.extensions["KHR_materials_emissive_strength"] =
            tinygltf::Value(tinygltf::Value::Object{{"emissiveStrength", tinygltf::Value(strength)}});
    }
    return entry;
}

void add_nodes(const Scene& scene, tinygltf::Model& model)
{
    tinygltf::Node node;
    node.name = as_utf8(scene.name);
    node.mesh = 0;
    node.translation = {scene.center.x, scene.center.y, scene.center.z};
    model.nodes.push_back(node);
    for (const View& view : scene.views) {
        add_camera(scene, view, model);
    }
    tinygltf::Scene entry;
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        entry.nodes.push_back(static_cast<int>(i));
    }
    model.scenes.push_back(entry);
    model.defaultScene = 0;
}

std::string glb_of(tinygltf::Model& model)
{
    model.asset.version = "2.0";
    model.asset.generator = "patchlight";
    for (const tinygltf::Material& material : model.materials) {
        for (const auto& [name, value] : material.extensions) {
            if (std::ranges::find(model.extensionsUsed, name) == model.extensionsUsed.end()) {
                model.extensionsUsed.push_back(name);
            }
        }
    }
    std::ostringstream out;
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&model, out, false, true)) {
        throw std::runtime_error("can't encode a GLB");
    }
    return std::move(out).str();
}

}  // namespace patchlight
