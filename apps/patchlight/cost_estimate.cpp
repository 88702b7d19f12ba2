#include "apps/patchlight/cost_estimate.h"

#include "apps/patchlight/scene_input.h"
#include "apps/patchlight/usage_error.h"
#include "apps/run/memory_limit.h"
#include "formfactor/random_numbers.h"
#include "formfactor/ray_caster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace patchlight {

namespace {

// A triangle of a Delaunay mesh with longest edge L covers about a quarter of L².
constexpr double area_per_squared_edge = 0.25;
// Before anything is read; of a surface, its blockers and lines; and beside the rows: mesh, fields and their copies.
constexpr double program_bytes = 1.7e7;
constexpr double bytes_per_surface = 2e4;
constexpr double bytes_per_element = 1500;
// Processor seconds, measured on the shipped scenes from 500 to 8,000 elements, where they are right within four times:
// of tracing, and of an element's exact light from one emitting surface. Of many surfaces most are found dark at once.
constexpr double seconds_per_ray = 1e-7;
constexpr double seconds_per_lit_element = 1.5e-4;
constexpr double most_emitters = 100;
// Of an element, with its share of the tree; about 20 links.
constexpr double bytes_of_links = 1500;

double allowed_memory(double limit)
{
    return limit > 0 ? limit : default_memory();
}

std::string in_gib(double bytes)
{
    const double gib = bytes / (1024.0 * 1024 * 1024);
    return gib >= 1 ? fmt::format("{:.1f} GiB", gib) : fmt::format("{:.3g} GiB", gib);
}

/// How much of all surface sees how much: the share of pairs of points that see each other, by 4,096 of them. The same
/// on every machine but for the ray caster's last bit.
double seen_share(const Scene& scene)
{
    constexpr std::size_t pairs = 4096;
    struct Front {
        const SceneTriangle* triangle;
        SurfaceId surface;
    };
    std::vector<Front> fronts;
    std::vector<double> area_upto;
    double area = 0;
    for (const SceneTriangle& t : scene.triangles)
        for (const SurfaceId s : {t.front, t.back}) {
            if (!s.valid()) continue;
            const Vec3 &a = scene.vertices[t.vertices[0]], &b = scene.vertices[t.vertices[1]],
                       &c = scene.vertices[t.vertices[2]];
            fronts.push_back({&t, s});
            area_upto.push_back(area += 0.5 * glm::length(glm::cross(b - a, c - a)));
        }
    if (fronts.empty()) return 0;
    const RayCaster caster(scene);
    RandomNumbers random(1, pairs);
    const auto drawn = [&] {
        const auto at = std::ranges::upper_bound(area_upto, random.uniform() * area);
        const auto k = std::min(static_cast<std::size_t>(at - area_upto.begin()), fronts.size() - 1);
        const double r = std::sqrt(random.uniform()), q = random.uniform();
        const auto& v = fronts[k].triangle->vertices;
        const Vec3& n = scene.surface(fronts[k].surface).frame.n;
        return std::pair(caster.leave((1 - r) * scene.vertices[v[0]] + r * (1 - q) * scene.vertices[v[1]] +
                                          r * q * scene.vertices[v[2]],
                                      n),
                         n);
    };
    RayBatch batch;
    batch.resize(pairs);
    std::size_t facing = 0;
    for (std::size_t i = 0; i < pairs; ++i) {
        const auto [p, n] = drawn();
        const auto [q, m] = drawn();
        // Points of one plane are both in front of it by as much.
        if (glm::dot(n, q - p) > 1e-9 * scene.diameter && glm::dot(m, p - q) > 1e-9 * scene.diameter)
            batch.set(facing++, p, q - p, 1);
    }
    batch.resize(facing);
    std::vector<std::uint8_t> blocked;
    caster.occluded(batch, blocked);
    return static_cast<double>(facing - static_cast<std::size_t>(std::ranges::count(blocked, 1))) / pairs;
}

/// What a scene's sizes say, once found.
struct SceneSizes {
    double surfaces = 0;
    double seen = 0;     ///< seen_share()
    double hitting = 1;  ///< of rays, those that meet something: in open scenes most
};

SceneSizes sizes_of(const Scene& scene)
{
    return {static_cast<double>(scene.surfaces.size()), seen_share(scene), scene.closed ? 1 : 0.7};
}

/// The rows of a matrix, at their largest, while it is made.
double row_bytes(double n, const FormFactorOptions& options, const SceneSizes& sizes)
{
    // Measured; patches that rays meet share them unevenly.
    constexpr double entry = 20, exact_entry = 21, quadrature_entry = 38, evenness = 0.39;
    const double seen = std::max(1.0, sizes.seen * n);
    switch (options.method) {
    case FormFactorMethod::hemisphere: {
        const double even = std::max(1.0, evenness * seen);
        return n * entry * even * -std::expm1(-options.rays * sizes.hitting / even);
    }
    case FormFactorMethod::hemicube:
        return n * entry * seen;
    case FormFactorMethod::quadrature:
        return n * quadrature_entry * seen;
    default:
        return n * exact_entry * seen;
    }
}

/// Hits that are kept for a second sweep over the indirect light. How many rays that takes only the light tells, unless
/// --vertex-rays does: as many as in the Cornell box and the gallery, where lamps are small; in plain rooms it is less.
double hit_bytes(double elements, const AdaptiveOptions& options)
{
    constexpr double most = 0x1p31, hit = 8;
    if (options.refine == Refine::none) return 0;
    const double rays = options.gather.rays > 0 ? options.gather.rays : 2590 * std::pow(elements / 8000, 0.95);
    return std::min(most, elements * rays * hit);
}

/// The program, the mesh of so many elements, the rows of the uniform one (of an automatic one to be refined a quarter
/// at most), and kept hits.
double solve_bytes(double elements, const AdaptiveOptions& options, const SceneSizes& sizes)
{
    const double held =
        program_bytes + bytes_per_surface * sizes.surfaces + mesh_bytes(elements) + hit_bytes(elements, options);
    const FormFactorMethod method = options.form_factors.method;
    const bool sampled = method == FormFactorMethod::hemisphere || method == FormFactorMethod::hemicube;
    const bool automatic = options.meshing.max_edge <= 0 && options.meshing.max_elements == 0;
    const double patches = automatic ? std::ceil(elements / 4) : elements;
    if (options.final.solver == Solver::hierarchical) return held + patches * bytes_of_links;
    // Rows that aren't reciprocal are made so beside three copies, or transposed for their columns.
    const double copies = !sampled                                             ? 1
                          : options.final.solver == Solver::conjugate_gradient ? 4
                          : options.final.solver == Solver::progressive        ? 2
                                                                               : 1;
    return held + copies * row_bytes(patches, options.form_factors, sizes);
}

/// Elements that fit, with two digits, below `most`.
double fitting_elements(double limit, double most, const AdaptiveOptions& options, const SceneSizes& sizes)
{
    double fit = 1;
    for (double step = most; step >= 1; step = std::floor(step / 2))
        if (solve_bytes(fit + step, options, sizes) <= limit) fit += step;
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

CostEstimate cost_of(const Scene& scene, const AdaptiveOptions& options, const SceneSizes& sizes)
{
    const double elements = elements_of(scene, options);
    CostEstimate cost;
    cost.elements = static_cast<std::size_t>(std::min(elements, 1e18));
    // Rays are traced for the patches of the uniform mesh, and from the nodes where indirect light is gathered: about
    // as many as elements.
    const double vertex_rays = options.gather.rays > 0 ? options.gather.rays : GatherOptions{}.rays;
    cost.rays = 0.25 * elements * (options.form_factors.rays + 4 * vertex_rays);
    // Saturated: more is refused anyway, and infinity times nothing would be allowed.
    cost.bytes = solve_bytes(std::min(elements, 1e18), options, sizes);
    cost.cpu_seconds = seconds_per_ray * cost.rays + seconds_per_lit_element * elements * emitters_of(scene);
    return cost;
}

}  // namespace

CostEstimate estimate_cost(const Scene& scene, const AdaptiveOptions& options)
{
    return cost_of(scene, options, sizes_of(scene));
}

CostEstimate check_memory(const Scene& scene, const AdaptiveOptions& options, double limit)
{
    const SceneSizes sizes = sizes_of(scene);
    const CostEstimate cost = cost_of(scene, options, sizes);
    const double fitting = fitting_elements(allowed_memory(limit), static_cast<double>(cost.elements), options, sizes);
    const bool dense = options.form_factors.method == FormFactorMethod::exact ||
                       options.form_factors.method == FormFactorMethod::quadrature;
    require_memory(
        cost.bytes, limit,
        fmt::format("about {:.0f} elements fit: ask for fewer by --max-elements or a longer --max-edge{}", fitting,
                    dense ? ", or take --form-factors hemisphere, whose rows don't grow with the elements, or --solver "
                            "hierarchical"
                          : ", or for fewer --rays"));
    return cost;
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
    if (!(needed <= allowed)) {
        throw LimitError(fmt::format("needs {}, limit {} ({}); {}", in_gib(needed), in_gib(allowed),
                                     limit > 0 ? "--memory" : "what is there; --memory", instead));
    }
}

}  // namespace patchlight
