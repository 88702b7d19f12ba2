#include "meshing/obj_text.h"
#include "meshing/raw_scene.h"
#include "meshing/read_mtl.h"
#include "meshing/scene_error.h"
#include "meshing/scene_files.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <set>
#include <sstream>

namespace patchlight {

namespace {

const std::string nameless_material = "default";

/// Collects what the reader calls back with, statement by statement.
class ObjCollector {
public:
    ObjCollector(RawScene& raw, const ObjText& text, const MtlLibrary& library) : raw_(raw), text_(text)
    {
        // Those that no face uses, too: options may name them.
        for (const auto& [name, material] : library.materials) {
            materials_[name] = MaterialId(raw.materials.size());
            raw.materials.push_back(material);
        }
    }

    void read(const std::string& text);

private:
    void add_face(const tinyobj::index_t* corners, int count);
    MaterialId material(const std::string& name);
    ObjectId object();

    RawScene& raw_;
    const ObjText& text_;
    std::map<std::string, MaterialId> materials_;
    std::map<std::string, ObjectId> objects_;
    std::string material_name_ = nameless_material;
    std::string object_name_;
    std::size_t vertices_so_far_ = 0;
    bool objects_are_named_ = false;  ///< by `o`; then groups don't name them
};

void ObjCollector::read(const std::string& text)
{
    tinyobj::callback_t callback;
    callback.vertex_cb = [](void* self, double, double, double, double) {
        ++static_cast<ObjCollector*>(self)->vertices_so_far_;
    };
    callback.index_cb = [](void* self, tinyobj::index_t* corners, int count) {
        static_cast<ObjCollector*>(self)->add_face(corners, count);
    };
    callback.usemtl_cb = [](void* self, const char* name, int) {
        static_cast<ObjCollector*>(self)->material_name_ = std::string(trimmed(name));
    };
    callback.object_cb = [](void* self, const char* name) {
        auto* collector = static_cast<ObjCollector*>(self);
        collector->object_name_ = std::string(trimmed(name));
        collector->objects_are_named_ = true;
    };
    callback.group_cb = [](void* self, const char** names, int count) {
        auto* collector = static_cast<ObjCollector*>(self);
        if (collector->objects_are_named_) return;
        collector->object_name_ = count > 0 ? names[0] : "";
    };
    std::istringstream stream(text);
    std::string warning, error;
    if (!tinyobj::LoadObjWithCallback(stream, callback, this, nullptr, &warning, &error)) {
        throw SceneError("obj", fmt::format("{}: {}", raw_.file_name, error));
    }
}

void ObjCollector::add_face(const tinyobj::index_t* corners, int count)
{
    RawFace face;
    face.line = text_.face_lines.at(raw_.faces.size());
    if (const auto bad = text_.bad_corners.find(face.line); bad != text_.bad_corners.end()) {
        throw SceneError("index", fmt::format("{}:{}: face refers to vertex {}, which is no index", raw_.file_name,
                                              face.line, bad->second));
    }
    face.first_corner = raw_.corners.size();
    face.count = static_cast<std::size_t>(count);
    face.material = material(material_name_);
    face.object = object();
    for (int k = 0; k < count; ++k) {
        const std::int64_t index = corners[k].vertex_index;
        const auto so_far = static_cast<std::int64_t>(vertices_so_far_);
        raw_.corners.push_back(index < 0 && -index <= so_far ? so_far + index : index - 1);
    }
    raw_.faces.push_back(face);
}

MaterialId ObjCollector::material(const std::string& name)
{
    if (const auto known = materials_.find(name); known != materials_.end()) return known->second;
    const MaterialId id(raw_.materials.size());
    raw_.materials.push_back(Material{.name = name});
    raw_.warnings.push_back(name == nameless_material
                                ? fmt::format("{}: faces without a material have reflectance 0.5", raw_.file_name)
                                : fmt::format("material {} is not defined, reflectance 0.5 is used", name));
    return materials_[name] = id;
}

ObjectId ObjCollector::object()
{
    const auto [known, is_new] = objects_.try_emplace(object_name_, ObjectId(raw_.objects.size()));
    if (is_new) raw_.objects.push_back(object_name_);
    return known->second;
}

}  // namespace

RawScene read_obj(const std::filesystem::path& file, double unit)
{
    RawScene raw;
    raw.format = "obj";
    raw.file_name = file.filename().string();
    const std::string text = cleaned_obj(read_whole_file(file));
    ObjText scanned = scan_obj(text);
    const SceneFolder folder(file);
    MtlLibrary library;
    std::set<std::string> done;
    for (const std::string& names : scanned.material_files) {
        if (done.insert(names).second) read_material_files(names, folder, raw.file_name, library);
    }
    raw.warnings = std::move(library.warnings);
    ObjCollector(raw, scanned, library).read(text);
    if (scanned.lines_and_points > 0) {
        raw.warnings.push_back(
            fmt::format("{}: {} lines and points are ignored", raw.file_name, scanned.lines_and_points));
    }
    if (scanned.curved > 0) {
        raw.warnings.push_back(
            fmt::format("{}: {} curves and curved surfaces are ignored", raw.file_name, scanned.curved));
    }
    raw.vertices = std::move(scanned.vertices);
    for (Vec3& v : raw.vertices) v *= unit;
    raw.vertex_lines = std::move(scanned.vertex_lines);
    return raw;
}

}  // namespace patchlight
