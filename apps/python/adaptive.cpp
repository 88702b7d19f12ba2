#include "solver/adaptive.h"

#include "apps/python/arrays.h"
#include "apps/python/bindings.h"
#include "apps/python/given_values.h"
#include "apps/python/long_call.h"
#include "apps/run/run_options.h"

#include <pybind11/stl.h>

namespace py = pybind11;

namespace patchlight {

namespace {

/// A step that may be kept: all of it is its own.
struct KeptStep {
    KeptStep(const Scene& scene, const AdaptiveStep& step)
        : cycle(step.cycle), stage(step.stage), mesh(scene, step.mesh.arrays()), B(step.B), vertex_B(step.vertex_B),
          middle_B(step.middle_B), solved(step.solved), error(step.error), energy(step.energy), splits(step.splits),
          rays(step.rays)
    {}

    int cycle;
    Stage stage;
    PatchMesh mesh;
    Radiosity B;
    VertexRadiosity vertex_B;
    MidpointRadiosity middle_B;
    SolveReport solved;
    ErrorEstimate error;
    EnergyBalance energy;
    std::size_t splits, rays;
};

/// What a step and a solution have in common.
template <class Holder>
py::class_<Holder> bind_solved(py::module_& module, const char* name, const char* doc)
{
    py::class_<Holder> python(module, name, doc);
    python.def_readonly("mesh", &Holder::mesh)
        .def_property_readonly(
            "B", [](const py::object& self) { return view_of(self.cast<const Holder&>().B, self); },
            "(patches, 3) W/m2; a read-only view")
        .def_property_readonly(
            "vertex_B", [](const py::object& self) { return view_of(self.cast<const Holder&>().vertex_B, self); },
            "(vertices, 3) W/m2; a read-only view")
        .def_property_readonly(
            "middle_B", [](const py::object& self) { return view_of(self.cast<const Holder&>().middle_B, self); },
            "(patches, 3 edges, 3) W/m2, of quadratic elements; (0, 3, 3): linear ones; a read-only view")
        .def_readonly("error", &Holder::error)
        .def_readonly("energy", &Holder::energy)
        .def_readonly("report", &Holder::solved);
    return python;
}

AdaptiveSolution solve_from_python(const Scene& scene, const AdaptiveOptions& options, const py::object& on_step)
{
    check_options(scene, options);
    return long_call([&](LongCall& call) {
        AdaptiveObservers observers;
        observers.stop = call.stop();
        if (!on_step.is_none())
            observers.on_step = [&](const AdaptiveStep& step) {
                auto kept = std::make_unique<KeptStep>(scene, step);
                call.in_caller([&] { on_step(py::cast(std::move(kept))); });
            };
        return solve_adaptively(scene, options, observers);
    });
}

}  // namespace

void bind_adaptive(py::module_& module)
{
    bind_solved<KeptStep>(module, "AdaptiveStep", "One cycle of solve_adaptively; may be kept.")
        .def_readonly("cycle", &KeptStep::cycle)
        .def_property_readonly(
            "stage", [](const KeptStep& s) { return name_of(stage_names(), s.stage); },
            "uniform, rough, adaptive or final")
        .def_readonly("splits", &KeptStep::splits, "edges that are halved next, and lines that are inserted")
        .def_readonly("rays", &KeptStep::rays, "traced in this cycle");
    bind_solved<AdaptiveSolution>(module, "AdaptiveSolution", "What solve_adaptively ends with.")
        .def_readonly("converged", &AdaptiveSolution::converged,
                      "the linear solve met its tolerance, and target_error, if asked for, was met");
    module.def("solve_adaptively", &solve_from_python, py::arg("scene"),
               py::arg_v("options", AdaptiveOptions(), "AdaptiveOptions()"), py::arg("on_step") = py::none(),
               "The whole loop. on_step(AdaptiveStep) is called after each cycle, on the calling thread; what it "
               "raises ends the loop and is raised here.");
}

}  // namespace patchlight
