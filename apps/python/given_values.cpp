#include "apps/python/given_values.h"

#include "apps/run/memory_limit.h"
#include "formfactor/form_factor_matrix.h"

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace patchlight {

namespace {

bool finite(const Vec2& q)
{
    return std::isfinite(q.x) && std::isfinite(q.y);
}

void check_surface(const Scene& scene, SurfaceId surface, const char* what)
{
    if (surface.value >= scene.surfaces.size())
        throw std::invalid_argument(
            fmt::format("{} names surface {}; the scene has {}", what, surface.value, scene.surfaces.size()));
}

}  // namespace

void check_lines(const Scene& scene, std::span<const SurfaceLine> lines)
{
    for (const SurfaceLine& line : lines) {
        check_surface(scene, line.surface, "a line");
        if (!finite(line.start) || !finite(line.end)) throw std::invalid_argument("a line's end is not finite");
    }
}

void check_plan(const Scene& scene, const PatchMesh& mesh, const RefinementPlan& plan)
{
    check_mesh(scene, mesh);
    check_lines(scene, plan.lines);
    std::vector<bool> planned(mesh.patch_count(), false);
    for (const auto& [patch, edge] : plan.bisections) {
        if (patch.value >= mesh.patch_count())
            throw std::invalid_argument(
                fmt::format("the plan names patch {}; the mesh has {}", patch.value, mesh.patch_count()));
        if (edge > 2) throw std::invalid_argument(fmt::format("the plan names edge {} of a patch", edge));
        if (planned[patch.value])
            throw std::invalid_argument(fmt::format("the plan names patch {} twice", patch.value));
        planned[patch.value] = true;
    }
}

void check_options(const Scene& scene, const AdaptiveOptions& options)
{
    if (options.gather.rays > 0 && options.gather.rays < 16)
        throw std::invalid_argument("gather.rays is neither 0 nor 16 or more");
    if (options.form_factors.method == FormFactorMethod::hemicube && options.form_factors.resolution % 2 != 0)
        throw std::invalid_argument("form_factors.resolution is not even");
    if (options.mesh && options.refine != Refine::none)
        throw std::invalid_argument("a given mesh is solved on as it is: refine must be \"none\"");
    for (const SurfacePoint& point : options.looked_at) check_surface(scene, point.surface, "looked_at");
}

void check_mesh(const Scene& scene, const PatchMesh& mesh)
{
    if (mesh.surface_count() != scene.surfaces.size())
        throw std::invalid_argument(fmt::format("a mesh of {} surfaces does not belong to a scene of {}",
                                                mesh.surface_count(), scene.surfaces.size()));
}

void check_estimate(const PatchMesh& mesh, const ErrorEstimate& error)
{
    if (error.eta.size() != mesh.patch_count() || error.edge.size() != mesh.patch_count())
        throw std::invalid_argument(fmt::format("an estimate of {} patches does not belong to a mesh of {}",
                                                error.eta.size(), mesh.patch_count()));
}

void check_system(const Exchange& exchange, const RadiositySystem& system)
{
    if (system.area.size() != exchange.mesh.patch_count() || system.direct.empty() != (exchange.direct == nullptr))
        throw std::invalid_argument("the system is not that of this exchange");
}

void check_memory(const Exchange& exchange, const AdaptiveOptions& options)
{
    if (options.final.solver == Solver::hierarchical) return;
    constexpr double gib = 1024.0 * 1024 * 1024;
    const double needed = matrix_bytes(options.form_factors.method, exchange.mesh.patch_count(), options.form_factors);
    const double limit = default_memory();
    if (needed <= limit) return;
    const std::string text = fmt::format("the rows of {} patches need {:.1f} GiB, limit {:.1f} GiB; use solver "
                                         "\"hierarchical\"",
                                         exchange.mesh.patch_count(), needed / gib, limit / gib);
    PyErr_SetString(PyExc_MemoryError, text.c_str());
    throw pybind11::error_already_set();
}

}  // namespace patchlight
