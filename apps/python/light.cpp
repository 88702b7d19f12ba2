#include "apps/python/arrays.h"
#include "apps/python/bindings.h"
#include "apps/python/given_values.h"
#include "apps/python/held_exchange.h"
#include "apps/python/long_call.h"
#include "apps/run/run_options.h"

#include <pybind11/stl.h>

#include <memory>

namespace py = pybind11;

namespace patchlight {

namespace {

void bind_emitted(py::module_& module)
{
    py::class_<Emitted>(module, "Emitted", "The emitters' light, and where it breaks off.")
        .def_property_readonly(
            "exact", [](const Emitted& e) { return e.direct() != nullptr; }, "found exactly, or else by rays")
        .def_property_readonly(
            "lines",
            [](const Emitted& e) {
                std::vector<SurfaceLine> lines;
                for (const Discontinuity& d : e.lines) lines.push_back(d.line);
                return lines;
            },
            "all lines that were found, as a new list of SurfaceLines");
    module.def(
        "emitted_light",
        [](const Scene& scene, const AdaptiveOptions& options) {
            check_options(scene, options);
            return long_call([&](LongCall& call) {
                Stages stages({}, call.stop());
                return emitted_light(scene, options, stages);
            });
        },
        py::arg("scene"), py::arg("options"), "The emitters' light and its lines, as far as options ask for them.");
    py::class_<HeldExchange>(module, "Exchange", "What light is exchanged over: a scene, its visibility, and a mesh.")
        .def(py::init([](const Scene& scene, const RayCaster& caster, const PatchMesh& mesh, const Emitted& emitted) {
                 check_mesh(scene, mesh);
                 return std::make_unique<HeldExchange>(scene, caster, mesh, emitted);
             }),
             py::arg("scene"), py::arg("caster"), py::arg("mesh"), py::arg("emitted"), py::keep_alive<1, 2>(),
             py::keep_alive<1, 3>(), py::keep_alive<1, 4>(), py::keep_alive<1, 5>());
}

void bind_system(py::module_& module)
{
    py::class_<FormFactorMatrix>(
        module, "FormFactors", "Rows of F, compressed: (factors, columns, row_start) is what scipy's csr_array takes.")
        .def_property_readonly("row_start",
                               [](const py::object& self) {
                                   const auto& starts = self.cast<const FormFactorMatrix&>().row_start;
                                   return view_of(std::span<const std::size_t>(starts), self);
                               })
        .def_property_readonly("columns",
                               [](const py::object& self) {
                                   const auto& columns = self.cast<const FormFactorMatrix&>().columns;
                                   return view_of(std::span<const std::uint32_t>(columns), self);
                               })
        .def_property_readonly("factors", [](const py::object& self) {
            const auto& factors = self.cast<const FormFactorMatrix&>().factors;
            return view_of(std::span<const double>(factors), self);
        });
    py::class_<HeldSystem>(module, "RadiositySystem", "(I - diag(rho) F) B = E on a mesh's patches.")
        .def_property_readonly(
            "area", [](const py::object& self) { return view_of(self.cast<HeldSystem&>().system.area, self); },
            "(patches) m2; a read-only view")
        .def_property_readonly(
            "rho", [](const py::object& self) { return view_of(self.cast<HeldSystem&>().system.rho, self); },
            "(patches, 3) reflectance; a read-only view")
        .def_property_readonly(
            "direct", [](const py::object& self) { return view_of(self.cast<HeldSystem&>().system.direct, self); },
            "(patches, 3) the emitters' light, W/m2, exactly; empty: F brings it; a read-only view")
        .def_property_readonly(
            "F", [](const HeldSystem& s) -> const FormFactorMatrix& { return s.system.F; },
            py::return_value_policy::reference_internal, "the FormFactors; empty for the hierarchical solver");
    module.def(
        "emittance",
        [](const Scene& scene, const PatchMesh& mesh) {
            check_mesh(scene, mesh);
            return array_of(emittance(scene, mesh));
        },
        py::arg("scene"), py::arg("mesh"), "(patches, 3) E, W/m2.");
    module.def(
        "assemble",
        [](const HeldExchange& exchange, const AdaptiveOptions& options) {
            check_options(exchange.exchange.scene, options);
            check_memory(exchange.exchange, options);
            return long_call([&](LongCall& call) {
                Stages stages({}, call.stop());
                return std::make_unique<HeldSystem>(assemble_patches(exchange.exchange, options, stages));
            });
        },
        py::arg("exchange"), py::arg("options"),
        "The equations of the exchange's patches, as options.final.solver wants them.");
}

void bind_reports(py::module_& module)
{
    py::class_<SolveReport>(module, "SolveReport", "How a linear solve went.")
        .def_property_readonly("solver", [](const SolveReport& r) { return name_of(solver_names(), r.solver); })
        .def_readonly("iterations", &SolveReport::iterations, "sweeps, iterations or shots")
        .def_readonly("residual", &SolveReport::residual, "what the tolerance is compared with, at the end")
        .def_readonly("unshot", &SolveReport::unshot, "share of the emitted power not yet shot")
        .def_readonly("converged", &SolveReport::converged)
        .def_readonly("links", &SolveReport::links, "hierarchical: that carry light")
        .def_readonly("history", &SolveReport::history, "residuals on the way");
    py::class_<EnergyBalance>(module, "EnergyBalance", "Where the light went, W, three bands together.")
        .def_readonly("emitted", &EnergyBalance::emitted)
        .def_readonly("absorbed", &EnergyBalance::absorbed)
        .def_readonly("escaped", &EnergyBalance::escaped)
        .def_readonly("relative_residual", &EnergyBalance::relative_residual,
                      "(emitted - absorbed - escaped) / emitted");
    py::class_<PatchSolution>(module, "PatchSolution", "The patches of one mesh, solved.")
        .def_property_readonly(
            "B", [](const py::object& self) { return view_of(self.cast<const PatchSolution&>().B, self); },
            "(patches, 3) W/m2; a read-only view")
        .def_readonly("report", &PatchSolution::report)
        .def_readonly("energy", &PatchSolution::energy)
        .def_readonly("rays", &PatchSolution::rays);
}

std::unique_ptr<HeldLighting> lighting_of(const HeldExchange& coarse, const Emitted& emitted, const HeldSystem& system,
                                          const PatchSolution& patches, const AdaptiveOptions& options)
{
    check_options(coarse.exchange.scene, options);
    check_system(coarse.exchange, system.system);
    if (patches.B.size() != system.system.area.size())
        throw std::invalid_argument("the solution is not that of this system");
    return long_call([&](LongCall& call) {
        Stages stages({}, call.stop());
        return std::unique_ptr<HeldLighting>(new HeldLighting{
            coarse.exchange.scene, Lighting(coarse.exchange, emitted, system.system, patches, options, stages)});
    });
}

/// H at places of one exchange's mesh's surfaces.
py::array irradiance_at(const HeldLighting& lighting, const HeldExchange& exchange,
                        const std::vector<SurfacePoint>& points, int rays)
{
    lighting.check(exchange.exchange);
    if (rays < 16 || rays > 65536) throw std::invalid_argument("rays is not in [16, 65536]");
    for (const SurfacePoint& point : points)
        if (point.surface.value >= exchange.exchange.scene.surfaces.size())
            throw std::invalid_argument("a point is on no surface of the scene");
    GatheredLight found = long_call([&](LongCall& call) {
        return lighting.lighting.on(exchange.exchange, rays)(points, WorkMonitor{call.stop(), {}});
    });
    return array_of(VertexField<Rgb>(std::move(found.irradiance)));
}

}  // namespace

void bind_light(py::module_& module)
{
    bind_emitted(module);
    bind_system(module);
    bind_reports(module);
    module.def(
        "solve",
        [](const HeldExchange& exchange, HeldSystem& system, const AdaptiveOptions& options) {
            check_options(exchange.exchange.scene, options);
            check_system(exchange.exchange, system.system);
            return long_call([&](LongCall& call) {
                const std::lock_guard lock(system.solving);
                Stages stages({}, call.stop());
                return solve_patches(exchange.exchange, system.system, options, stages);
            });
        },
        py::arg("exchange"), py::arg("system"), py::arg("options"),
        "All bounces of light between the patches, by options.final.");
    py::class_<HeldLighting>(
        module, "Lighting",
        "What lights any mesh of the scene: the emitters, and the indirect light that follows from "
        "the solved patches of the uniform mesh, which making one finds.")
        .def(py::init(&lighting_of), py::arg("exchange"), py::arg("emitted"), py::arg("system"), py::arg("patches"),
             py::arg("options"), py::keep_alive<1, 2>(), py::keep_alive<1, 3>(), py::keep_alive<1, 4>(),
             py::keep_alive<1, 5>())
        .def_property_readonly(
            "rays", [](const HeldLighting& held) { return held.lighting.rays(); }, "traced for it, and for the patches")
        .def(
            "irradiance", &irradiance_at, py::arg("exchange"), py::arg("points"), py::arg("rays") = 512,
            "(points, 3) H, W/m2, at SurfacePoints, 0 where nothing is reflected; rays count with refine='none' only.");
}

}  // namespace patchlight
