#include "apps/patchlight/cost_estimate.h"

#include "apps/patchlight/scene_input.h"
#include "apps/patchlight/usage_error.h"
#include "formfactor/form_factor_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unistd.h>

namespace patchlight {

namespace {

// A triangle of a Delaunay mesh with longest edge L covers about a quarter of L².
constexpr double area_per_squared_edge = 0.25;
// Beside the rows: mesh, fields and their copies.
constexpr double bytes_per_element = 1500;
// Processor seconds, measured on the shipped scenes from 500 to 8,000 elements, where they are right within four times:
// of tracing, and of an element's exact light from one emitting surface. Of many surfaces most are found dark at once.
constexpr double seconds_per_ray = 1e-7;
constexpr double seconds_per_lit_element = 1.5e-4;
constexpr double most_emitters = 100;
// Of an element, with its share of the tree; about 20 links.
constexpr double bytes_of_links = 1500;

double physical_memory()
{
    return static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGE_SIZE));
}

double allowed_memory(double limit)
{
    return limit > 0 ? limit : 0.8 * physical_memory();
}

std::string in_gib(double bytes)
{
    const double gib = bytes / (1024.0 * 1024 * 1024);
    return gib >= 1 ? fmt::format("{:.1f} GiB", gib) : fmt::format("{:.2g} GiB", gib);
}

/// The mesh of so many elements, and the rows of the uniform one: of an automatic one to be refined a quarter at most.
double solve_bytes(double elements, const AdaptiveOptions& options)
{
    const FormFactorMethod method = options.form_factors.method;
    const bool sampled = method == FormFactorMethod::hemisphere || method == FormFactorMethod::hemicube;
    const bool automatic = options.meshing.max_edge <= 0 && options.meshing.max_elements == 0;
    const auto patches = static_cast<std::size_t>(automatic ? std::ceil(elements / 4) : elements);
    if (options.final.solver == Solver::hierarchical)
        return static_cast<double>(patches) * bytes_of_links + mesh_bytes(elements);
    // Rows that aren't reciprocal are made so beside three copies, or transposed for their columns.
    const double copies = !sampled                                             ? 1
                          : options.final.solver == Solver::conjugate_gradient ? 4
                          : options.final.solver == Solver::progressive        ? 2
                                                                               : 1;
    return copies * matrix_bytes(method, patches, options.form_factors) + mesh_bytes(elements);
}

/// Elements that fit, with two digits, below `most`.
double fitting_elements(double limit, double most, const AdaptiveOptions& options)
{
    double fit = 1;
    for (double step = most; step >= 1; step = std::floor(step / 2))
        if (solve_bytes(fit + step, options) <= limit) fit += step;
    const double digit = std::pow(10, std::max(0.0, std::floor(std::log10(fit)) - 1));
    return std::floor(fit / digit) * digit;
}

double elements_of(const Scene& scene, const AdaptiveOptions& options)
{
    const double budget = static_cast<double>(options.max_elements);
    if (options.meshing.max_edge <= 0) {
        return budget;
    }
    const double edge = options.meshing.max_edge;
    const double first = total_area(scene) / (area_per_squared_edge * edge * edge);
    return options.refine == Refine::none || options.refine == Refine::discontinuity ? first : std::max(budget, first);
}

double emitters_of(const Scene& scene)
{
    const auto emits = [&](const Surface& s) { return scene.materials[s.material.value].emission != Rgb(0.0); };
    return std::min(most_emitters, static_cast<double>(std::ranges::count_if(scene.surfaces, emits)));
}

}  // namespace

CostEstimate estimate_cost(const Scene& scene, const AdaptiveOptions& options)
{
    const double elements = elements_of(scene, options);
    CostEstimate cost;
    cost.elements = static_cast<std::size_t>(std::min(elements, 1e18));
    // Rays are traced for the patches of the uniform mesh, and from the nodes where indirect light is gathered: about
    // as many as elements.
    const double vertex_rays = options.gather.rays > 0 ? options.gather.rays : GatherOptions{}.rays;
    cost.rays = 0.25 * elements * (options.form_factors.rays + 4 * vertex_rays);
    cost.bytes = solve_bytes(static_cast<double>(cost.elements), options);
    cost.cpu_seconds = seconds_per_ray * cost.rays + seconds_per_lit_element * elements * emitters_of(scene);
    return cost;
}

void check_memory(const Scene& scene, const AdaptiveOptions& options, double limit)
{
    const CostEstimate cost = estimate_cost(scene, options);
    const double fitting = fitting_elements(allowed_memory(limit), static_cast<double>(cost.elements), options);
    const bool dense = options.form_factors.method == FormFactorMethod::exact ||
                       options.form_factors.method == FormFactorMethod::quadrature;
    require_memory(
        cost.bytes, limit,
        fmt::format("about {:.0f} elements fit: ask for fewer by --max-elements or a longer --max-edge{}", fitting,
                    dense ? ", or take --form-factors hemisphere, whose rows don't grow with the elements, or --solver "
                            "hierarchical"
                          : ", or for fewer --rays"));
}

double uniform_elements(const Scene& scene, const MeshingOptions& meshing)
{
    const double budget = static_cast<double>(meshing.max_elements);
    if (meshing.max_edge <= 0) {
        return budget;
    }
    const double count = total_area(scene) / (area_per_squared_edge * meshing.max_edge * meshing.max_edge);
    return meshing.max_elements > 0 ? std::min(count, budget) : count;
}

double mesh_bytes(double elements)
{
    return elements * bytes_per_element;
}

void require_memory(double needed, double limit, const std::string& instead)
{
    const double allowed = allowed_memory(limit);
    if (needed > allowed) {
        throw LimitError(fmt::format("needs {}, limit {} ({}); {}", in_gib(needed), in_gib(allowed),
                                     limit > 0 ? "--memory" : "80 % of the memory", instead));
    }
}

}  // namespace patchlight
