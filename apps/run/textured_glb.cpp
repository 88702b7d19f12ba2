#include "apps/run/textured_glb.h"

#include "apps/run/gltf_buffer.h"
#include "apps/run/gltf_scene.h"
#include "apps/run/stored_scene.h"

#include <array>
#include <map>
#include <utility>

namespace patchlight {

namespace {

/// The surfaces' triangles. A vertex belongs to one surface.
struct SurfaceTriangles {
    std::vector<float> positions, texture;
    std::vector<std::vector<std::uint32_t>> of_material;
};

SurfaceTriangles triangles_of(const Scene& scene,
                              const std::function<Vec2(SurfaceId surface, const Vec2& q)>& texture_at)
{
    SurfaceTriangles all;
    all.of_material.resize(scene.materials.size());
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    const auto vertex_of = [&](SurfaceId surface, std::uint32_t vertex) {
        const auto [entry, is_new] = known.try_emplace({surface.value, vertex}, all.texture.size() / 2);
        if (is_new) {
            const Vec3& p = scene.vertices[vertex];
            const Vec2 uv = texture_at(surface, scene.surface(surface).frame.to_plane(p));
            for (int k = 0; k < 3; ++k) all.positions.push_back(static_cast<float>(p[k]));
            for (int k = 0; k < 2; ++k) all.texture.push_back(static_cast<float>(uv[k]));
        }
        return entry->second;
    };
    const auto add = [&](SurfaceId surface, const std::array<std::uint32_t, 3>& corners) {
        if (!surface.valid()) return;
        auto& list = all.of_material[scene.surface(surface).material.value];
        for (const std::uint32_t corner : corners) list.push_back(vertex_of(surface, corner));
    };
    for (const SceneTriangle& triangle : scene.triangles) {
        const auto& v = triangle.vertices;
        add(triangle.front, v);
        add(triangle.back, {v[0], v[2], v[1]});
    }
    return all;
}

}  // namespace

std::string encode_textured_glb(const Scene& scene,
                                const std::function<Vec2(SurfaceId surface, const Vec2& q)>& texture_at,
                                const std::string& file)
{
    const SurfaceTriangles all = triangles_of(scene, texture_at);
    tinygltf::Model model;
    GltfBuffer buffer(model);
    const std::map<std::string, int> attributes{{"POSITION", buffer.floats(all.positions, 3, true)},
                                                {"TEXCOORD_0", buffer.floats(all.texture, 2, false)}};
    tinygltf::Mesh mesh;
    mesh.name = "surfaces";
    for (std::size_t m = 0; m < all.of_material.size(); ++m) {
        model.materials.push_back(lit_material(scene.materials[m]));
        if (all.of_material[m].empty()) continue;
        tinygltf::Primitive primitive;
        primitive.attributes = attributes;
        primitive.indices = buffer.indices(all.of_material[m]);
        primitive.material = static_cast<int>(m);
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        mesh.primitives.push_back(primitive);
    }
    model.meshes.push_back(mesh);
    add_nodes(scene, model);
    model.extras = tinygltf::Value(tinygltf::Value::Object{{"lightmap", tinygltf::Value(as_utf8(file))}});
    return glb_of(model);
}

}  // namespace patchlight
