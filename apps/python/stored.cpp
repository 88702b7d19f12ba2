#include "apps/python/arrays.h"
#include "apps/python/bindings.h"
#include "apps/python/given_values.h"
#include "apps/python/long_call.h"
#include "apps/run/run_folder.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>

namespace py = pybind11;

namespace patchlight {

namespace {

MidpointRadiosity middles_of(const std::optional<DoubleArray>& array, std::size_t patches)
{
    if (!array || array->size() == 0) return {};
    if (array->ndim() != 3 || array->shape(0) != static_cast<py::ssize_t>(patches) || array->shape(1) != 3 ||
        array->shape(2) != 3)
        throw py::value_error("middle_B must have the shape (" + std::to_string(patches) + ", 3, 3)");
    MidpointRadiosity middles(patches);
    const auto* values = reinterpret_cast<const Rgb*>(array->data());
    for (std::size_t i = 0; i < 3 * patches; ++i) middles[PatchId(i / 3)][i % 3] = values[i];
    return middles;
}

py::bytes encoded(const Scene& scene, const PatchMesh& mesh, const DoubleArray& B, const DoubleArray& vertex_B,
                  const ErrorEstimate& error, const std::optional<DoubleArray>& middle_B)
{
    check_mesh(scene, mesh);
    check_estimate(mesh, error);
    const auto patch_B = field_of<Radiosity>(B, mesh.patch_count(), "B");
    const auto at_vertices = field_of<VertexRadiosity>(vertex_B, mesh.vertex_count(), "vertex_B");
    const MidpointRadiosity at_middles = middles_of(middle_B, mesh.patch_count());
    return long_call([&](LongCall&) {
        return encode_solution(scene, mesh, patch_B, at_vertices, error.eta, error.edge, at_middles);
    });
}

StoredSolution solution_in(const OpenedRun& run, const std::optional<int>& cycle)
{
    const WhichCycle which =
        cycle ? WhichCycle{WhichCycle::Kind::number, *cycle} : WhichCycle{WhichCycle::Kind::last, 0};
    return long_call([&](LongCall&) { return solution_of(run, which); });
}

void bind_solution(py::module_& module)
{
    py::class_<StoredSolution>(module, "StoredSolution", "A solution read back from its file.")
        .def_readonly("scene", &StoredSolution::scene)
        .def_readonly("mesh", &StoredSolution::mesh)
        .def_property_readonly(
            "B", [](const py::object& self) { return view_of(self.cast<const StoredSolution&>().B, self); },
            "(patches, 3) W/m2; a read-only view")
        .def_property_readonly(
            "vertex_B",
            [](const py::object& self) { return view_of(self.cast<const StoredSolution&>().vertex_B, self); },
            "(vertices, 3) W/m2; a read-only view")
        .def_property_readonly(
            "middle_B",
            [](const py::object& self) { return view_of(self.cast<const StoredSolution&>().middle_B, self); },
            "(patches, 3 edges, 3) W/m2, of quadratic elements; (0, 3, 3): linear ones; a read-only view")
        .def_property_readonly(
            "eta", [](const py::object& self) { return view_of(self.cast<const StoredSolution&>().eta, self); },
            "(patches) as in ErrorEstimate; a read-only view")
        .def_property_readonly(
            "edge", [](const py::object& self) { return view_of(self.cast<const StoredSolution&>().edge, self); },
            "(patches) as in ErrorEstimate; a read-only view");
    module.def("encode_solution", &encoded, py::arg("scene"), py::arg("mesh"), py::arg("B"), py::arg("vertex_B"),
               py::arg("error"), py::arg("middle_B") = py::none(),
               "The bytes of a solution.glb, as `patchlight solve` writes it.");
    module.def(
        "read_solution",
        [](const std::filesystem::path& file) { return long_call([&](LongCall&) { return read_solution(file); }); },
        py::arg("file"), "Reads a solution.glb back, equal to the bit. Raises SceneError.");
}

}  // namespace

void bind_stored(py::module_& module)
{
    bind_solution(module);
    py::class_<OpenedRun>(module, "Run", "The folder of a run of `patchlight solve`.")
        .def_property_readonly("folder", [](const OpenedRun& run) { return run.folder; })
        .def_property_readonly(
            "record",
            [](const OpenedRun& run) { return py::module_::import("json").attr("loads")(json_of(run.record).dump()); },
            "run.json as a new dict")
        .def_property_readonly(
            "cycles",
            [](const OpenedRun& run) {
                std::vector<int> numbers;
                for (const CycleRecord& cycle : run.record.cycles) numbers.push_back(cycle.cycle);
                return numbers;
            },
            "the numbers of its cycles")
        .def("solution", &solution_in, py::arg("cycle") = py::none(), "The StoredSolution of a cycle, or of the last.");
    module.def(
        "open_run", [](const std::filesystem::path& folder) { return open_run(folder); }, py::arg("folder"),
        "Raises RunError when it isn't the folder of a run, SceneError when its run.json is broken.");
}

}  // namespace patchlight
