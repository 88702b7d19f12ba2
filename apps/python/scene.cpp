#include "apps/python/arrays.h"
#include "apps/python/bindings.h"
#include "apps/python/long_call.h"
#include "apps/run/camera_file.h"
#include "formfactor/ray_caster.h"
#include "meshing/read_scene.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>

namespace py = pybind11;

namespace patchlight {

namespace {

Scene scene_in(const std::filesystem::path& file, const SceneOptions& options)
{
    LoadedScene loaded = long_call([&](LongCall&) {
        LoadedScene read = read_scene(file, options);
        if (read.scene.views.empty()) read.scene.views = cameras_beside(file, read.scene);
        return read;
    });
    for (const std::string& warning : loaded.report.warnings)
        if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 1) != 0) throw py::error_already_set();
    return std::move(loaded.scene);
}

void bind_parts(py::module_& module)
{
    py::class_<Material>(module, "Material", "A diffuse material.")
        .def_readonly("name", &Material::name)
        .def_readonly("reflectance", &Material::reflectance, "three bands, in [0, 1)")
        .def_readonly("emission", &Material::emission, "exitance, W/m2, three bands")
        .def_readonly("two_sided", &Material::two_sided);
    py::class_<Surface>(module, "Surface", "A planar polygon of one material.")
        .def_property_readonly(
            "material", [](const Surface& s) { return s.material.value; }, "index in Scene.materials")
        .def_property_readonly(
            "normal", [](const Surface& s) { return s.frame.n; }, "unit, of the front")
        .def_readonly("area", &Surface::area, "m2");
}

}  // namespace

void bind_scene(py::module_& module)
{
    bind_parts(module);
    py::class_<Scene>(module, "Scene", "What is solved: immutable once read.")
        .def_readonly("name", &Scene::name)
        .def_readonly("center", &Scene::center, "metres; the file's coordinates times unit are positions + center")
        .def_readonly("diameter", &Scene::diameter, "of the bounding box, m")
        .def_readonly("unit", &Scene::unit, "metres per unit of the file")
        .def_readonly("closed", &Scene::closed, "no light that surfaces emit can escape")
        .def_readonly("surfaces", &Scene::surfaces, "a new list of the Surfaces")
        .def_readonly("materials", &Scene::materials, "a new list of the Materials")
        .def_property_readonly(
            "vertices", [](const py::object& self) { return view_of(self.cast<const Scene&>().vertices, self); },
            "(n, 3) recentred metres; a read-only view")
        .def("__repr__", [](const Scene& s) {
            return "<Scene \"" + s.name + "\": " + std::to_string(s.surfaces.size()) + " surfaces>";
        });
    module.def(
        "read_scene", &scene_in, py::arg("file"), py::arg_v("options", SceneOptions(), "SceneOptions()"),
        "The scene in an OBJ, glTF or GLB file, with the cameras of STEM.view.json beside it. What was mended is told "
        "by warnings. Raises SceneError.");
    py::class_<RayCaster>(module, "RayCaster", "Visibility among a scene's surfaces; built once a scene.")
        .def(py::init([](const Scene& scene) {
                 return long_call([&](LongCall&) { return std::make_unique<RayCaster>(scene); });
             }),
             py::arg("scene"))
        .def_property_readonly("instruction_set", &RayCaster::instruction_set, "hits agree to the bit only within one");
}

}  // namespace patchlight
