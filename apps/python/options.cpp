#include "apps/python/bindings.h"
#include "apps/python/option_class.h"
#include "meshing/read_scene.h"

#include <limits>

namespace py = pybind11;

namespace patchlight {

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();
constexpr double most_int = std::numeric_limits<int>::max();
constexpr double most_elements = 1e9;

void bind_reading_and_meshing(py::module_& module)
{
    OptionClass<SceneOptions>(module, "SceneOptions", "How a scene's file is understood.")
        .number("unit", &SceneOptions::unit, {0, endless, true}, "metres per unit of the file")
        .number("max_reflectance", &SceneOptions::max_reflectance, {0, 1, true}, "used where a file says exactly 1")
        .number("snap", &SceneOptions::snap, {0, 1}, "welding, coplanarity and contact tolerance, times the diameter")
        .value("all_two_sided", &SceneOptions::all_two_sided, "every material has two sides")
        .value("two_sided", &SceneOptions::two_sided, "names of the materials with two sides; assign a whole list")
        .value("emitters", &SceneOptions::emitters,
               "exitance (W/m2, three bands) given to materials by name; assign a whole dict")
        .value("require_emitter", &SceneOptions::require_emitter, "a scene without light is an error")
        .value("join_objects", &SceneOptions::join_objects, "coplanar faces of one material join across objects, too");
    OptionClass<MeshingOptions>(module, "MeshingOptions", "How surfaces are cut into patches.")
        .number("max_edge", &MeshingOptions::max_edge, {0, endless},
                "longest edge of the uniform mesh, m; 0: a twelfth of the scene's diameter")
        .number("min_angle", &MeshingOptions::min_angle, {0, 20.7}, "degrees, 0 to 20.7")
        .number("max_elements", &MeshingOptions::max_elements, {0, most_elements}, "budget of triangles; 0: none");
}

void bind_factors_and_solving(py::module_& module)
{
    using F = FormFactorOptions;
    OptionClass<F>(module, "FormFactorOptions", "How form factors are found.")
        .word("method", &F::method, form_factor_names, "hemicube, hemisphere, quadrature or exact")
        .word("directions", &F::directions, direction_names, "stratified, regular-grid or lecture-grid")
        .number("rays", &F::rays, {16, 65536}, "per patch, 16 to 65536")
        .number("shadow_rays", &F::shadow_rays, {4, 4096}, "per patch, 4 to 4096")
        .number("small_source", &F::small_source, {0, 1},
                "sources with a smaller factor are seen by Lambert's formula; 0: none are")
        .number("resolution", &F::resolution, {4, 4096}, "hemicube: pixels along an edge, even, 4 to 4096")
        .number("tolerance", &F::tolerance, {0, 1},
                "quadrature: relative, of a row; exact: of a pair's larger factor; 0: the method's own")
        .value("seed", &F::seed, "of all random numbers");
    using S = SolveOptions;
    OptionClass<S>(module, "SolveOptions", "The linear solve.")
        .word("solver", &S::solver, solver_names,
              "progressive, jacobi, gauss-seidel, conjugate-gradient, bicgstab or hierarchical")
        .number("tolerance", &S::tolerance, {0, endless, true},
                "on the bound sum A|B - B~| / sum A B of the worst band")
        .number("max_sweeps", &S::max_sweeps, {1, most_int}, "sweeps or iterations")
        .word("order", &S::order, order_names, "what is shot first: unshot-power or unshot-radiosity")
        .value("ambient", &S::ambient, "shooting: spread the unshot light over the result")
        .value("overshoot", &S::overshoot, "shooting: with what the ambient light will still bring");
    using G = GatherOptions;
    OptionClass<G>(module, "GatherOptions", "How light is gathered at points.")
        .number("rays", &G::rays, {0, 65536},
                "over the hemisphere; 0: as many as the error asks for, on a uniform mesh 512")
        .number("shadow_rays", &G::shadow_rays, {16, 65536}, "per point, 16 to 65536")
        .number("small_source", &G::small_source, {0, 1}, "as in FormFactorOptions")
        .number("crease_angle", &G::crease_angle, {0, 180},
                "degrees below which facets of one material share irradiance at common vertices")
        .value("seed", &G::seed, "of all random numbers");
}

void bind_error_and_lines(py::module_& module)
{
    using E = EstimateOptions;
    OptionClass<E>(module, "EstimateOptions", "How a mesh's error is estimated.")
        .word("indicator", &E::indicator, indicator_names, "residual or vertex-difference")
        .number("rays", &E::rays, {16, 65536}, "at each point, where the estimate gathers light itself");
    using M = MarkOptions;
    OptionClass<M>(module, "MarkOptions", "Which patches are split.")
        .word("marking", &M::marking, marking_names, "doerfler or fixed-fraction")
        .number("share", &M::share, {0, 1, true}, "of sum eta^2 (doerfler) or of the patches (fixed-fraction)")
        .number("least", &M::least, {0, 1}, "of the patches are split in any case")
        .number("smallest", &M::smallest, {0, 1}, "edges below this times the diameter are left alone")
        .number("local", &M::local, {0, 1}, "of what counts as error, the part relative to the patch's own light");
    using L = LineOptions;
    OptionClass<L>(module, "LineOptions", "Which lines where light breaks off become edges.")
        .number("least_saving", &L::least_saving, {0, endless}, "elements that a line must save")
        .number("secondary_share", &L::secondary_share, {0, 1},
                "of the light reflected first whose surfaces are sources of lines, too")
        .number("most_secondary", &L::most_secondary, {0, most_elements}, "of these surfaces");
}

}  // namespace

void bind_options(py::module_& module)
{
    bind_reading_and_meshing(module);
    bind_factors_and_solving(module);
    bind_error_and_lines(module);
}

void bind_adaptive_options(py::module_& module)
{
    OptionClass<SurfacePoint> point(module, "SurfacePoint", "A place on a surface.");
    point.value("position", &SurfacePoint::position, "in front of the surface, recentred metres: where rays start")
        .value("limit", &SurfacePoint::limit, "the place itself, recentred metres");
    point.property(
        "surface", [](const SurfacePoint& self) { return self.surface.value; },
        [](SurfacePoint& self, std::uint32_t s) { self.surface = SurfaceId(s); }, "number of the surface");
    using A = AdaptiveOptions;
    OptionClass<A>(module, "AdaptiveOptions", "Everything solve_adaptively needs to know.")
        .value("meshing", &A::meshing, "MeshingOptions of the first, uniform mesh")
        .value("form_factors", &A::form_factors, "FormFactorOptions")
        .value("final", &A::final, "SolveOptions of the patches of the uniform mesh")
        .value("gather", &A::gather, "GatherOptions")
        .value("estimate", &A::estimate, "EstimateOptions")
        .value("mark", &A::mark, "MarkOptions")
        .value("lines", &A::lines, "LineOptions")
        .word("refine", &A::refine, refine_names, "none, intensity, discontinuity or both")
        .word("elements", &A::elements, element_names, "of the last mesh's solution: linear or quadratic")
        .word("direct", &A::direct, direct_names, "exact or sampled")
        .number("iterations", &A::iterations, {1, most_int}, "refinements at most")
        .number("target_error", &A::target_error, {0, 1},
                "stop when the estimated relative error is below; 0: go on to the budget")
        .number("max_elements", &A::max_elements, {1, most_elements}, "budget of patches")
        .value("mesh", &A::mesh, "MeshArrays solved on instead of the uniform mesh, with refine='none'; None: no such")
        .value("looked_at", &A::looked_at, "SurfacePoints that refinement is for; assign a whole list. Empty: all");
}

}  // namespace patchlight
