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

/// Corners, middles of edges, then centroids, if any.
struct ExtraPoints : ElementPoints {
    std::uint32_t first_centroid = 0;
};

ExtraPoints extra_points(const Exchange& exchange, Indicator indicator)
{
    if (indicator == Indicator::vertex_difference) return {{vertex_points(exchange), {}}, 0};
    const PatchMesh& mesh = exchange.mesh;
    ExtraPoints extra{element_points(exchange)};
    extra.first_centroid = static_cast<std::uint32_t>(extra.points.size());
    if (indicator == Indicator::residual)
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

/// How far the values at a patch's middles (0 … 2) and centroid (3) are from what its corners' say, as light reflected.
std::array<Rgb, 4> differences(const Exchange& exchange, PatchId p, const ExtraPoints& extra, const std::vector<Rgb>& H)
{
    const Rgb rho = exchange.scene.material_of(exchange.mesh.surface(p)).reflectance;
    const auto c = exchange.mesh.corners(p);
    std::array<Rgb, 4> d{};
    for (std::size_t k = 0; k < 3; ++k)
        d[k] = rho * (H[extra.midpoint_of[p.value][k]] - 0.5 * (H[c[k].value] + H[c[(k + 1) % 3].value]));
    if (const std::size_t centroid = extra.first_centroid + p.value; centroid < H.size())
        d[3] = rho * (H[centroid] - (H[c[0].value] + H[c[1].value] + H[c[2].value]) / 3.0);
    return d;
}

/// ∫ of the product of two functions over a patch of area 1: by the rule of degree 3, or, of middles alone, with
/// ∫(4 w_i w_j)(4 w_k w_l) = 8/45 for the same edge, 4/45 for another.
double product(const std::array<Rgb, 4>& a, const std::array<Rgb, 4>& b, Indicator indicator)
{
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += glm::dot(a[k], b[k]);
    if (indicator == Indicator::residual) return 2.0 / 15 * sum + 9.0 / 20 * glm::dot(a[3], b[3]);
    return 4.0 / 45 * (sum + glm::dot(a[0] + a[1] + a[2], b[0] + b[1] + b[2]));
}

/// Σ η², which may be less than what the patches say: theirs are cut at 0, the sum is not.
double residual(const Exchange& exchange, const ExtraPoints& extra, const GatheredLight& light, Indicator indicator,
                ErrorEstimate& error)
{
    double all = 0;
    for (const PatchId p : exchange.mesh.patches()) {
        const auto one = differences(exchange, p, extra, light.irradiance);
        const auto other = light.again.empty() ? one : differences(exchange, p, extra, light.again);
        const double square = exchange.mesh.area(p) * product(one, other, indicator);
        std::array<double, 3> at_middle{};
        for (std::size_t k = 0; k < 3; ++k) at_middle[k] = std::sqrt(std::max(0.0, glm::dot(one[k], other[k])));
        all += square;
        error.eta[p] = std::sqrt(std::max(0.0, square));
        error.edge[p] = best_edge(exchange.mesh, p, at_middle);
    }
    return std::max(0.0, all);
}

double vertex_difference(const Exchange& exchange, const VertexRadiosity& B, ErrorEstimate& error)
{
    double all = 0;
    for (const PatchId p : exchange.mesh.patches()) {
        if (!exchange.scene.material_of(exchange.mesh.surface(p)).reflects()) continue;
        const auto c = exchange.mesh.corners(p);
        const Rgb low = glm::min(B[c[0]], glm::min(B[c[1]], B[c[2]]));
        const Rgb high = glm::max(B[c[0]], glm::max(B[c[1]], B[c[2]]));
        std::array<double, 3> along{};
        for (std::size_t k = 0; k < 3; ++k) along[k] = std::sqrt(square(B[c[k]] - B[c[(k + 1) % 3]]));
        error.eta[p] = std::sqrt(exchange.mesh.area(p) * square(high - low));
        error.edge[p] = best_edge(exchange.mesh, p, along);
        all += error.eta[p] * error.eta[p];
    }
    return all;
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

Evaluation evaluate(const Exchange& exchange, const LightAtPoints& light, Indicator indicator, double crease_angle,
                    double indirect, const WorkMonitor& monitor)
{
    const ExtraPoints extra = extra_points(exchange, indicator);
    GatheredLight arriving = light(extra.points, monitor);
    share_irradiance(exchange, crease_angle, arriving.irradiance);
    if (!arriving.again.empty()) share_irradiance(exchange, crease_angle, arriving.again);

    Evaluation evaluation;
    evaluation.rays = arriving.rays;
    evaluation.vertex_B = linear_radiosity(exchange, arriving.irradiance);
    ErrorEstimate& error = evaluation.error;
    error.eta = PatchField<double>(exchange.mesh.patch_count(), 0.0);
    error.edge = PatchField<std::uint8_t>(exchange.mesh.patch_count(), 0);
    const double squares = indicator == Indicator::vertex_difference
                               ? vertex_difference(exchange, evaluation.vertex_B, error)
                               : residual(exchange, extra, arriving, indicator, error);
    error.total = std::sqrt(squares + indirect * indirect);
    const double norm = reflected_norm(exchange.scene, exchange.mesh, evaluation.vertex_B);
    error.relative = error.total == 0 ? 0 : error.total / norm;
    return evaluation;
}

namespace {

/// η² of each patch as far as it counts: see mark().
std::vector<double> weighted_squares(const Scene& scene, const PatchMesh& mesh, const Radiosity& B,
                                     const ErrorEstimate& error, double local)
{
    std::vector<double> reflected(mesh.patch_count(), 0.0), result(mesh.patch_count(), 0.0);
    double sum = 0, area = 0;
    for (const PatchId p : mesh.patches()) {
        const Material& material = scene.material_of(mesh.surface(p));
        if (!material.reflects()) continue;
        reflected[p.value] = square(B[p] - material.emission);
        sum += mesh.area(p) * reflected[p.value];
        area += mesh.area(p);
    }
    const double mean = area > 0 ? sum / area : 0, least = 0.03 * 0.03 * mean;
    for (const PatchId p : mesh.patches()) {
        const double own = mean > 0 ? mean / (reflected[p.value] + least) : 1;
        result[p.value] = error.eta[p] * error.eta[p] * (1 - local + local * own);
    }
    return result;
}

}  // namespace

RefinementPlan mark(const Scene& scene, const PatchMesh& mesh, const Radiosity& B, const ErrorEstimate& error,
                    const MarkOptions& options)
{
    const std::vector<double> squares = weighted_squares(scene, mesh, B, error, options.local);
    std::vector<std::uint32_t> order;
    double all = 0;
    for (const PatchId p : mesh.patches()) {
        if (!(squares[p.value] > 0)) continue;
        all += squares[p.value];
        const auto c = mesh.corners(p);
        const std::size_t k = error.edge[p];
        if (glm::distance(mesh.position(c[k]), mesh.position(c[(k + 1) % 3])) > options.smallest * scene.diameter)
            order.push_back(p.value);
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return squares[a] != squares[b] ? squares[a] > squares[b] : a < b;
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
        held += squares[i];
    }
    return plan;
}

}  // namespace patchlight
