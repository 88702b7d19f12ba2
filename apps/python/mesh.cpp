#include "apps/python/arrays.h"
#include "apps/python/bindings.h"
#include "apps/python/given_values.h"
#include "apps/python/long_call.h"
#include "solver/mesh_stages.h"

#include <pybind11/stl.h>

namespace py = pybind11;

namespace patchlight {

static_assert(sizeof(SurfaceId) == sizeof(std::uint32_t));

namespace {

py::array view_of_ids(const std::vector<SurfaceId>& ids, const py::object& owner)
{
    return view_of(reinterpret_cast<const std::uint32_t*>(ids.data()), {static_cast<py::ssize_t>(ids.size())}, owner);
}

/// The views that both a mesh and its arrays have; `arrays` tells where they are.
template <class Class, class Arrays>
void add_views(Class& python, const Arrays& arrays)
{
    python
        .def_property_readonly(
            "positions", [arrays](const py::object& self) { return view_of(arrays(self).positions, self); },
            "(vertices, 3) recentred metres; a read-only view")
        .def_property_readonly(
            "triangles",
            [arrays](const py::object& self) {
                const auto& t = arrays(self).triangles;
                return view_of(reinterpret_cast<const std::uint32_t*>(t.data()),
                               {static_cast<py::ssize_t>(t.size()), 3}, self);
            },
            "(patches, 3) vertices, counter-clockwise seen from the front; a read-only view")
        .def_property_readonly(
            "patch_surface", [arrays](const py::object& self) { return view_of_ids(arrays(self).patch_surface, self); },
            "(patches) the surface of each; a read-only view")
        .def_property_readonly(
            "vertex_surface",
            [arrays](const py::object& self) { return view_of_ids(arrays(self).vertex_surface, self); },
            "(vertices) the surface of each; a read-only view");
}

py::array_t<std::int64_t> neighbours_in(const PatchMesh& mesh)
{
    py::array_t<std::int64_t> all({static_cast<py::ssize_t>(mesh.patch_count()), py::ssize_t{3}});
    auto rows = all.mutable_unchecked<2>();
    for (const PatchId p : mesh.patches()) {
        const auto around = mesh.neighbours(p);
        for (std::size_t k = 0; k < 3; ++k)
            rows(p.value, static_cast<py::ssize_t>(k)) = around[k].valid() ? std::int64_t{around[k].value} : -1;
    }
    return all;
}

void bind_classes(py::module_& module)
{
    py::class_<PatchMeshArrays> arrays(module, "MeshArrays",
                                       "What a mesh is made from, as AdaptiveOptions.mesh takes it.");
    add_views(arrays,
              [](const py::object& self) -> const PatchMeshArrays& { return self.cast<const PatchMeshArrays&>(); });
    arrays.def("__repr__", [](const PatchMeshArrays& a) {
        return "<MeshArrays: " + std::to_string(a.triangles.size()) + " patches>";
    });
    py::class_<PatchMesh> mesh(module, "PatchMesh", "Triangles over the scene's surfaces; immutable. len(): patches.");
    add_views(mesh,
              [](const py::object& self) -> const PatchMeshArrays& { return self.cast<const PatchMesh&>().arrays(); });
    mesh.def("__len__", &PatchMesh::patch_count)
        .def_property_readonly("patch_count", &PatchMesh::patch_count)
        .def_property_readonly("vertex_count", &PatchMesh::vertex_count)
        .def_property_readonly(
            "areas", [](const py::object& self) { return view_of(self.cast<const PatchMesh&>().areas(), self); },
            "(patches) m2; a read-only view")
        .def_property_readonly(
            "neighbours", &neighbours_in,
            "(patches, 3) the patch beyond the edge from corner k to k + 1, -1 on a border; a new array")
        .def_property_readonly(
            "line_count", [](const PatchMesh& m) { return m.lines().size(); }, "edges that lie on lines")
        .def_property_readonly(
            "arrays", [](const PatchMesh& m) { return m.arrays(); }, "a copy, for AdaptiveOptions.mesh")
        .def("__repr__", [](const PatchMesh& m) {
            return "<PatchMesh: " + std::to_string(m.patch_count()) + " patches, " + std::to_string(m.vertex_count()) +
                   " vertices>";
        });
}

}  // namespace

void bind_mesh(py::module_& module)
{
    bind_classes(module);
    py::class_<SurfaceLine>(module, "SurfaceLine", "A straight piece of a line on a surface.")
        .def_property_readonly("surface", [](const SurfaceLine& l) { return l.surface.value; })
        .def_property_readonly(
            "kind", [](const SurfaceLine& l) { return std::string(name_of(l.kind)); }, "contact, EV, VE, EEE or plane")
        .def_property_readonly(
            "start", [](const SurfaceLine& l) { return py::make_tuple(l.start.x, l.start.y); }, "plane coordinates, m")
        .def_property_readonly(
            "end", [](const SurfaceLine& l) { return py::make_tuple(l.end.x, l.end.y); }, "plane coordinates, m");
    module.def(
        "triangulate",
        [](const Scene& scene, const MeshingOptions& options, const std::vector<SurfaceLine>& lines) {
            check_lines(scene, lines);
            return long_call([&](LongCall&) { return triangulate(scene, options, lines); });
        },
        py::arg("scene"), py::arg_v("options", MeshingOptions(), "MeshingOptions()"),
        py::arg("lines") = std::vector<SurfaceLine>(), "The uniform mesh, with the lines as edges.");
    module.def(
        "first_mesh",
        [](const Scene& scene, const AdaptiveOptions& options) {
            return long_call([&](LongCall&) { return first_mesh(scene, options); });
        },
        py::arg("scene"), py::arg("options"),
        "The mesh the adaptive loop begins with: options.mesh, or a uniform one that leaves the budget's greater part "
        "to refinement.");
}

}  // namespace patchlight
