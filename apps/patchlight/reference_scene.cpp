#include "apps/patchlight/reference_scene.h"

#include "meshing/build_scene.h"
#include "meshing/raw_scene.h"

#include <algorithm>

namespace patchlight {

namespace {

void add_object(const std::string& name, const std::vector<ReferencePolygon>& polygons, RawScene& raw)
{
    if (polygons.empty()) {
        return;
    }
    const ObjectId object(raw.objects.size());
    raw.objects.push_back(name);
    for (const ReferencePolygon& polygon : polygons) {
        raw.faces.push_back({raw.corners.size(), polygon.size(), MaterialId(std::size_t{0}), object, 0});
        for (const Vec3& corner : polygon) {
            raw.corners.push_back(static_cast<std::int64_t>(raw.vertices.size()));
            raw.vertices.push_back(corner);
        }
    }
}

}  // namespace

Scene reference_scene(const ReferencePair& pair)
{
    RawScene raw;
    raw.format = "built in";
    raw.file_name = pair.name;
    raw.materials.push_back(Material{.name = "grey"});
    add_object("from", pair.from, raw);
    add_object("to", pair.to, raw);
    add_object("blocker", pair.blockers, raw);
    SceneOptions options;
    options.require_emitter = false;
    options.join_objects = false;
    validate(raw, options);
    Scene scene = build_scene(raw, options).scene;
    scene.name = pair.name;
    return scene;
}

ObjectId reference_object(const Scene& scene, const std::string& name)
{
    return ObjectId(static_cast<std::size_t>(std::ranges::find(scene.objects, name) - scene.objects.begin()));
}

}  // namespace patchlight
