#include "solver/estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace patchlight {

namespace {

double square(const Rgb& x)
{
    return glm::dot(x, x);
}

/// Corners, middles of edges, then centroids.
struct ExtraPoints : ElementPoints {
    std::uint32_t first_centroid = 0;
};

ExtraPoints extra_points(const Exchange& exchange)
{
    const PatchMesh& mesh = exchange.mesh;
    ExtraPoints extra{element_points(exchange)};
    extra.first_centroid = static_cast<std::uint32_t>(extra.points.size());
    for (const PatchId p : mesh.patches())
        extra.points.push_back({mesh.centroid(p), mesh.surface(p), mesh.centroid(p)});
    return extra;
}

/// The edge with the highest score; where scores are equal to a thousandth, or all 0, the longest: what the middles
/// can't tell, as on a patch whose middle alone is wrong, must not make needles.
std::uint8_t best_edge(const PatchMesh& mesh, PatchId p, std::array<double, 3> scores)
{
    const auto c = mesh.corners(p);
    const double longest = mesh.longest_edge(p), most = *std::ranges::max_element(scores);
    for (std::size_t k = 0; k < 3; ++k)
        scores[k] += (most > 0 ? 1e-3 * most : 1.0) *
                     glm::distance(mesh.position(c[k]), mesh.position(c[(k + 1) % 3])) / longest;
    return static_cast<std::uint8_t>(std::ranges::max_element(scores) - scores.begin());
}

void residual(const Exchange& exchange, const ExtraPoints& extra, const std::vector<Rgb>& H, ErrorEstimate& error)
{
    for (const PatchId p : exchange.mesh.patches()) {
        const Rgb rho = exchange.scene.material_of(exchange.mesh.surface(p)).reflectance;
        const auto c = exchange.mesh.corners(p);
        std::array<double, 3> at_middle{};
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            at_middle[k] =
                square(rho * (H[extra.midpoint_of[p.value][k]] - 0.5 * (H[c[k].value] + H[c[(k + 1) % 3].value])));
            sum += 2.0 / 15 * at_middle[k];
            at_middle[k] = std::sqrt(at_middle[k]);
        }
        sum +=
            9.0 / 20 *
            square(rho * (H[extra.first_centroid + p.value] - (H[c[0].value] + H[c[1].value] + H[c[2].value]) / 3.0));
        error.eta[p] = std::sqrt(exchange.mesh.area(p) * sum);
        error.edge[p] = best_edge(exchange.mesh, p, at_middle);
    }
}

void vertex_difference(const Exchange& exchange, const VertexRadiosity& B, ErrorEstimate& error)
{
    for (const PatchId p : exchange.mesh.patches()) {
        if (!exchange.scene.material_of(exchange.mesh.surface(p)).reflects()) continue;
        const auto c = exchange.mesh.corners(p);
        const Rgb low = glm::min(B[c[0]], glm::min(B[c[1]], B[c[2]]));
        const Rgb high = glm::max(B[c[0]], glm::max(B[c[1]], B[c[2]]));
        std::array<double, 3> along{};
        for (std::size_t k = 0; k < 3; ++k) along[k] = std::sqrt(square(B[c[k]] - B[c[(k + 1) % 3]]));
        error.eta[p] = std::sqrt(exchange.mesh.area(p) * square(high - low));
        error.edge[p] = best_edge(exchange.mesh, p, along);
    }
}

}  // namespace

double reflected_norm(const Scene& scene, const PatchMesh& mesh, const VertexRadiosity& B)
{
    double sum = 0;
    for (const PatchId p : mesh.patches()) {
        const Material& material = scene.material_of(mesh.surface(p));
        if (!material.reflects()) continue;
        const auto c = mesh.corners(p);
        const Rgb x = B[c[0]] - material.emission, y = B[c[1]] - material.emission, z = B[c[2]] - material.emission;
        sum += mesh.area(p) / 12 * (square(x) + square(y) + square(z) + square(x + y + z));
    }
    return std::sqrt(sum);
}

Evaluation evaluate(const Exchange& exchange, const Radiosity& B, const EstimateOptions& options,
                    const GatherOptions& gather, const WorkMonitor& monitor)
{
    GatherOptions sampling = gather;
    sampling.rays = options.rays;
    const bool by_residual = options.indicator == Indicator::residual;
    ExtraPoints extra;
    if (by_residual)
        extra = extra_points(exchange);
    else
        extra.points = vertex_points(exchange);
    GatheredLight light = gather_irradiance(exchange, B, extra.points, sampling, monitor);
    share_irradiance(exchange, gather.crease_angle, light.irradiance);

    Evaluation evaluation;
    evaluation.rays = light.rays;
    evaluation.vertex_B = linear_radiosity(exchange, light.irradiance);
    ErrorEstimate& error = evaluation.error;
    error.eta = PatchField<double>(exchange.mesh.patch_count(), 0.0);
    error.edge = PatchField<std::uint8_t>(exchange.mesh.patch_count(), 0);
    if (by_residual)
        residual(exchange, extra, light.irradiance, error);
    else
        vertex_difference(exchange, evaluation.vertex_B, error);
    double sum = 0;
    for (const double eta : error.eta.values()) sum += eta * eta;
    error.total = std::sqrt(sum);
    const double norm = reflected_norm(exchange.scene, exchange.mesh, evaluation.vertex_B);
    error.relative = error.total == 0 ? 0 : error.total / norm;
    return evaluation;
}

RefinementPlan mark(const Scene& scene, const PatchMesh& mesh, const ErrorEstimate& error, const MarkOptions& options)
{
    std::vector<std::uint32_t> order;
    double all = 0;
    for (const PatchId p : mesh.patches()) {
        if (!(error.eta[p] > 0)) continue;
        all += error.eta[p] * error.eta[p];
        const auto c = mesh.corners(p);
        const std::size_t k = error.edge[p];
        if (glm::distance(mesh.position(c[k]), mesh.position(c[(k + 1) % 3])) > options.smallest * scene.diameter)
            order.push_back(p.value);
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double x = error.eta[PatchId(a)], y = error.eta[PatchId(b)];
        return x != y ? x > y : a < b;
    });
    RefinementPlan plan;
    double held = 0;
    for (const std::uint32_t i : order) {
        const double split = static_cast<double>(plan.bisections.size()) / static_cast<double>(mesh.patch_count());
        const bool enough = options.marking == Marking::doerfler ? held >= options.share * all && split >= options.least
                                                                 : split >= options.share;
        if (enough) break;
        const PatchId p(i);
        plan.bisections.push_back({p, error.edge[p]});
        held += error.eta[p] * error.eta[p];
    }
    return plan;
}

}  // namespace patchlight
