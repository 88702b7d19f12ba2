#include "apps/python/arrays.h"
#include "apps/python/bindings.h"
#include "apps/python/given_values.h"
#include "apps/python/held_exchange.h"
#include "apps/python/long_call.h"
#include "solver/mesh_stages.h"

#include <pybind11/stl.h>

#include <cmath>
#include <optional>

namespace py = pybind11;

namespace patchlight {

namespace {

using EdgeArray = py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>;

std::uint8_t longest_edge_of(const PatchMesh& mesh, PatchId p)
{
    const auto c = mesh.corners(p);
    std::uint8_t longest = 0;
    double most = -1;
    for (std::uint8_t k = 0; k < 3; ++k) {
        const double length = glm::distance(mesh.position(c[k]), mesh.position(c[(k + 1U) % 3]));
        if (length > most) {
            most = length;
            longest = k;
        }
    }
    return longest;
}

/// An estimate by an indicator of the user's.
ErrorEstimate estimate_of(const Scene& scene, const PatchMesh& mesh, const DoubleArray& vertex_B,
                          const DoubleArray& eta, const std::optional<EdgeArray>& edge)
{
    check_mesh(scene, mesh);
    const auto n = static_cast<py::ssize_t>(mesh.patch_count());
    if (eta.ndim() != 1 || eta.size() != n) throw py::value_error("eta must have one value for each patch");
    if (edge && (edge->ndim() != 1 || edge->size() != n))
        throw py::value_error("edge must have one value for each patch");
    ErrorEstimate error;
    error.eta = PatchField<double>(std::vector<double>(eta.data(), eta.data() + n));
    error.edge = PatchField<std::uint8_t>(mesh.patch_count());
    double squares = 0;
    for (const PatchId p : mesh.patches()) {
        if (!(error.eta[p] >= 0) || !std::isfinite(error.eta[p]))
            throw py::value_error("eta of patch " + std::to_string(p.value) + " is negative or not finite");
        error.edge[p] = edge ? edge->data()[p.value] : longest_edge_of(mesh, p);
        if (error.edge[p] > 2) throw py::value_error("edge of patch " + std::to_string(p.value) + " is above 2");
        squares += error.eta[p] * error.eta[p];
    }
    const double norm =
        reflected_norm(scene, mesh, field_of<VertexRadiosity>(vertex_B, mesh.vertex_count(), "vertex_B"));
    error.total = std::sqrt(squares);
    error.relative = squares == 0 ? 0 : error.total / norm;
    return error;
}

void bind_estimate(py::module_& module)
{
    py::class_<ErrorEstimate>(module, "ErrorEstimate",
                              "How wrong a mesh's solution is, an estimate. Made from an indicator of one's own: eta; "
                              "edge: the one to halve, from corner k to k + 1, or the longest.")
        .def(py::init(&estimate_of), py::arg("scene"), py::arg("mesh"), py::arg("vertex_B"), py::arg("eta"),
             py::arg("edge") = py::none())
        .def_property_readonly(
            "eta", [](const py::object& self) { return view_of(self.cast<const ErrorEstimate&>().eta, self); },
            "(patches) sqrt of the integral of |B~ - B|^2 over the patch, W/m2 m; a read-only view")
        .def_property_readonly(
            "edge", [](const py::object& self) { return view_of(self.cast<const ErrorEstimate&>().edge, self); },
            "(patches) 0 to 2: the edge that is best halved; a read-only view")
        .def_readonly("total", &ErrorEstimate::total, "W/m2 m, with the indirect light's own error")
        .def_readonly("relative", &ErrorEstimate::relative, "total over the norm of all light reflected")
        .def("__repr__",
             [](const ErrorEstimate& e) { return "<ErrorEstimate: relative " + std::to_string(e.relative) + ">"; });
    py::class_<Evaluation>(module, "Evaluation", "A mesh's error, and the linear light it was found with.")
        .def_readonly("error", &Evaluation::error)
        .def_property_readonly(
            "vertex_B", [](const py::object& self) { return view_of(self.cast<const Evaluation&>().vertex_B, self); },
            "(vertices, 3) W/m2; a read-only view")
        .def_readonly("rays", &Evaluation::rays);
    py::class_<Reconstruction>(module, "Reconstruction", "The light at the nodes of the last mesh.")
        .def_property_readonly(
            "vertex_B", [](const py::object& self) { return view_of(self.cast<const Reconstruction&>().B, self); },
            "(vertices, 3) W/m2; a read-only view")
        .def_property_readonly(
            "middle_B",
            [](const py::object& self) { return view_of(self.cast<const Reconstruction&>().middle_B, self); },
            "(patches, 3 edges, 3) W/m2, of quadratic elements; (0, 3, 3): linear ones; a read-only view")
        .def_readonly("rays", &Reconstruction::rays);
}

RefinementPlan plan_of(const IndexArray& patches, const std::optional<EdgeArray>& edges, std::vector<SurfaceLine> lines)
{
    if (patches.ndim() != 1 || (edges && (edges->ndim() != 1 || edges->size() != patches.size())))
        throw py::value_error("patches and edges must have one dimension and the same length");
    RefinementPlan plan;
    plan.lines = std::move(lines);
    for (py::ssize_t i = 0; i < patches.size(); ++i)
        plan.bisections.push_back({PatchId(patches.data()[i]), edges ? edges->data()[i] : std::uint8_t{0}});
    return plan;
}

void bind_plan(py::module_& module)
{
    py::class_<RefinementPlan>(module, "RefinementPlan",
                               "What to refine: edges[i] of patches[i], from corner k to k + 1, is halved, the most "
                               "wanted first, and lines become edges. Empty (not plan): nothing is left to do.")
        .def(py::init(&plan_of), py::arg("patches"), py::arg("edges") = py::none(),
             py::arg("lines") = std::vector<SurfaceLine>())
        .def_property_readonly(
            "patches",
            [](const RefinementPlan& plan) {
                py::array_t<std::uint32_t> all(static_cast<py::ssize_t>(plan.bisections.size()));
                for (std::size_t i = 0; i < plan.bisections.size(); ++i)
                    all.mutable_data()[i] = plan.bisections[i].patch.value;
                return all;
            },
            "(n) a new array")
        .def_property_readonly(
            "edges",
            [](const RefinementPlan& plan) {
                py::array_t<std::uint8_t> all(static_cast<py::ssize_t>(plan.bisections.size()));
                for (std::size_t i = 0; i < plan.bisections.size(); ++i)
                    all.mutable_data()[i] = plan.bisections[i].edge;
                return all;
            },
            "(n) a new array")
        .def_readwrite("lines", &RefinementPlan::lines, "a new list; assign a whole one")
        .def("__bool__", [](const RefinementPlan& plan) { return !plan.empty(); })
        .def("__repr__", [](const RefinementPlan& plan) {
            return "<RefinementPlan: " + std::to_string(plan.bisections.size()) + " edges, " +
                   std::to_string(plan.lines.size()) + " lines>";
        });
}

RefinementPlan marked(const Scene& scene, const PatchMesh& mesh, const DoubleArray& B, const ErrorEstimate& error,
                      const MarkOptions& options)
{
    check_mesh(scene, mesh);
    check_estimate(mesh, error);
    const auto patch_B = field_of<Radiosity>(B, mesh.patch_count(), "B");
    return long_call([&](LongCall&) { return mark(scene, mesh, patch_B, error, options); });
}

RefinementPlan planned(const HeldExchange& held, const DoubleArray& B, const ErrorEstimate& error,
                       const HeldLighting& lighting, const Emitted& emitted, const AdaptiveOptions& options)
{
    const Exchange& exchange = held.exchange;
    lighting.check(exchange);
    check_estimate(exchange.mesh, error);
    const auto patch_B = field_of<Radiosity>(B, exchange.mesh.patch_count(), "B");
    return long_call([&](LongCall&) {
        return plan_next(exchange.scene, exchange.mesh, patch_B, error, lighting.lighting.counted(exchange.mesh, error),
                         emitted.lines, options);
    });
}

std::vector<SurfaceLine> lines_worthwhile(const HeldExchange& held, const ErrorEstimate& error, const Emitted& emitted,
                                          const AdaptiveOptions& options)
{
    const Exchange& exchange = held.exchange;
    check_estimate(exchange.mesh, error);
    return long_call([&](LongCall&) {
        return worthwhile_lines(exchange.scene, exchange.mesh, error, emitted.lines, options.max_elements,
                                options.target_error, options.lines);
    });
}

void bind_steps(py::module_& module)
{
    module.def("mark", &marked, py::arg("scene"), py::arg("mesh"), py::arg("B"), py::arg("error"),
               py::arg_v("options", MarkOptions(), "MarkOptions()"),
               "The patches to split next, the worst first; B: (patches, 3) W/m2. No lines.");
    module.def("worthwhile_lines", &lines_worthwhile, py::arg("exchange"), py::arg("error"), py::arg("emitted"),
               py::arg("options"), "The lines that aren't in the mesh yet and pay, for RefinementPlan.lines.");
    module.def(
        "plan_next", &planned, py::arg("exchange"), py::arg("B"), py::arg("error"), py::arg("lighting"),
        py::arg("emitted"), py::arg("options"),
        "What solve_adaptively changes next: mark and worthwhile_lines, as far as options.refine asks for them.");
    module.def(
        "finished",
        [](const PatchMesh& mesh, const ErrorEstimate& error, const RefinementPlan& plan, int cycle,
           const AdaptiveOptions& options) { return finished(mesh, error, plan, cycle, options); },
        py::arg("mesh"), py::arg("error"), py::arg("plan"), py::arg("cycle"), py::arg("options"),
        "Whether solve_adaptively ends with this mesh.");
    module.def(
        "refine",
        [](const Scene& scene, const PatchMesh& mesh, const RefinementPlan& plan, const AdaptiveOptions& options) {
            check_plan(scene, mesh, plan);
            return long_call([&](LongCall& call) {
                Stages stages({}, call.stop());
                return next_mesh(scene, mesh, plan, options, stages);
            });
        },
        py::arg("scene"), py::arg("mesh"), py::arg("plan"), py::arg("options"),
        "The mesh that the plan asks for, within options.max_elements.");
}

}  // namespace

void bind_refinement(py::module_& module)
{
    bind_estimate(module);
    bind_plan(module);
    bind_steps(module);
    module.def(
        "estimate",
        [](const HeldExchange& exchange, const HeldLighting& lighting, const AdaptiveOptions& options) {
            lighting.check(exchange.exchange);
            return long_call([&](LongCall& call) {
                Stages stages({}, call.stop());
                return lighting.lighting.evaluated(exchange.exchange, options, stages);
            });
        },
        py::arg("exchange"), py::arg("lighting"), py::arg("options"),
        "The light at the mesh's vertices, and how wrong it is in between.");
    module.def(
        "final_nodes",
        [](const HeldExchange& exchange, const HeldLighting& lighting, const DoubleArray& vertex_B,
           const AdaptiveOptions& options) {
            lighting.check(exchange.exchange);
            check_options(exchange.exchange.scene, options);
            Reconstruction found{
                field_of<VertexRadiosity>(vertex_B, exchange.exchange.mesh.vertex_count(), "vertex_B"), {}, 0};
            return long_call([&](LongCall& call) {
                Stages stages({}, call.stop());
                return lighting.lighting.final_nodes(exchange.exchange, std::move(found), options, stages);
            });
        },
        py::arg("exchange"), py::arg("lighting"), py::arg("vertex_B"), py::arg("options"),
        "The last mesh's light: vertex_B, or found with all rays and at the middles of edges where options ask for "
        "it.");
    module.def(
        "patch_means",
        [](const PatchMesh& mesh, const DoubleArray& vertex_B) {
            return array_of(patch_means(mesh, field_of<VertexRadiosity>(vertex_B, mesh.vertex_count(), "vertex_B")));
        },
        py::arg("mesh"), py::arg("vertex_B"), "(patches, 3) the means of linear light over each patch.");
}

}  // namespace patchlight
