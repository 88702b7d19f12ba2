#pragma once

#include "meshing/scene.h"

#include <tiny_gltf.h>

#include <string>

namespace patchlight {

/// The light is in the colours already: KHR_materials_unlit, base colour 1. Reflectance and exitance stand in extras.
tinygltf::Material unlit_material(const Material& material);

/// For programs that bring the light along, or add some: a rough dielectric whose base colour is the reflectance, and
/// whose emission is the radiance E/π (beyond 1 by KHR_materials_emissive_strength).
tinygltf::Material lit_material(const Material& material);

/// The scene: a node with the model's only mesh, which its translation carries to the scene's centre, and one a camera.
void add_nodes(const Scene& scene, tinygltf::Model& model);

/// The model as a GLB. Throws std::runtime_error.
std::string glb_of(tinygltf::Model& model);

}  // namespace patchlight
