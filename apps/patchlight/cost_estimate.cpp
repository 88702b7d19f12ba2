#include "apps/patchlight/cost_estimate.h"

#include "apps/patchlight/scene_input.h"
#include "apps/patchlight/usage_error.h"
#include "formfactor/form_factor_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <unistd.h>

namespace patchlight {

namespace {

// A triangle of a Delaunay mesh with longest edge L covers about a quarter of L².
constexpr double area_per_squared_edge = 0.25;
// Beside the rows: mesh, fields and their copies.
constexpr double bytes_per_element = 1500;
// Of an element, with its share of the tree; about 60 links.
constexpr double bytes_of_links = 3000;

double physical_memory()
{
    return static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGE_SIZE));
}

std::string in_gib(double bytes)
{
    const double gib = bytes / (1024.0 * 1024 * 1024);
    return gib >= 1 ? fmt::format("{:.1f} GiB", gib) : fmt::format("{:.2g} GiB", gib);
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

}  // namespace

CostEstimate estimate_cost(const Scene& scene, const AdaptiveOptions& options)
{
    const double elements = elements_of(scene, options);
    CostEstimate cost;
    cost.elements = static_cast<std::size_t>(std::min(elements, 1e18));
    // Cycles grow geometrically: together about three times the last one; half as many vertices as elements, and three
    // edges for two of them.
    const double middles = options.elements == Elements::quadratic ? 1.5 * elements : 0;
    cost.rays = 3 * elements * (options.form_factors.rays + 0.5 * options.gather.rays) + middles * options.gather.rays;
    const bool links = options.final.solver == Solver::hierarchical && options.refine == Refine::none;
    const double factors = links ? elements * bytes_of_links
                                 : matrix_bytes(options.form_factors.method, cost.elements, options.form_factors);
    cost.bytes = factors + elements * bytes_per_element;
    return cost;
}

void check_memory(const Scene& scene, const AdaptiveOptions& options)
{
    const double needed = estimate_cost(scene, options).bytes;
    require_memory(needed, 0, "ask for fewer elements, longer edges or fewer rays");
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
    const double allowed = limit > 0 ? limit : 0.8 * physical_memory();
    if (needed > allowed) {
        throw LimitError(fmt::format("needs {}, limit {} ({}); {}", in_gib(needed), in_gib(allowed),
                                     limit > 0 ? "--memory" : "80 % of the memory", instead));
    }
}

}  // namespace patchlight
