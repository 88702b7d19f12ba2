#include "solver/importance.h"

#include <cmath>

namespace patchlight {

PatchField<double> seen_shares(std::size_t patches, std::span<const PatchId> seen)
{
    PatchField<double> shares(patches, 0.0);
    double count = 0;
    for (const PatchId p : seen) {
        if (!p.valid()) continue;
        shares[p] += 1;
        count += 1;
    }
    if (count > 0)
        for (double& share : shares.values()) share /= count;
    return shares;
}

Importance importance(const RadiositySystem& system, const LightOperator& F, const PatchField<double>& seen,
                      const SolveOptions& options, const WorkMonitor& monitor)
{
    const std::size_t n = system.area.size();
    Importance result{PatchField<Rgb>(n), {}};
    // Z = ρY is the light of the same system when ρ seen/A is what it emits: Z = ρ seen/A + ρ F Z.
    RadiositySystem dual;
    dual.area = system.area;
    dual.rho = system.rho;
    dual.E = PatchField<Rgb>(n);
    for (std::size_t i = 0; i < n; ++i) {
        const PatchId p(i);
        result.density[p] = Rgb(seen[p] / system.area[p]);
        dual.E[p] = system.rho[p] * result.density[p];
    }
    Radiosity Z = dual.E, arrived(n);
    result.solved = solve_bicgstab(dual, F, Z, options, monitor);
    F(Z, arrived);
    for (std::size_t i = 0; i < n; ++i) result.density[PatchId(i)] += arrived[PatchId(i)];
    return result;
}

PatchField<double> importance_weights(const RadiositySystem& system, const Importance& importance)
{
    PatchField<double> weights(system.area.size(), 1.0);
    double sum = 0, area = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const PatchId p(i);
        const Rgb& Y = importance.density[p];
        sum += system.area[p] * (Y.r + Y.g + Y.b) / 3;
        area += system.area[p];
    }
    if (sum == 0) return weights;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const Rgb& Y = importance.density[PatchId(i)];
        weights[PatchId(i)] = (Y.r + Y.g + Y.b) / 3 * area / sum;
    }
    return weights;
}

ErrorEstimate weighted(const ErrorEstimate& error, const PatchField<double>& weights)
{
    ErrorEstimate result = error;
    for (std::size_t i = 0; i < weights.size(); ++i) result.eta[PatchId(i)] *= std::sqrt(weights[PatchId(i)]);
    return result;
}

PatchField<double> weights_on(const Scene& scene, const PatchMesh& mesh, const PatchLocator& locator,
                              const PatchField<double>& weights)
{
    PatchField<double> result(mesh.patch_count(), 1.0);
    for (const PatchId p : mesh.patches()) {
        const Vec2 q = scene.surface(mesh.surface(p)).frame.to_plane(mesh.centroid(p));
        const PatchId under = locator.locate(mesh.surface(p), static_cast<float>(q.x), static_cast<float>(q.y));
        if (under.valid()) result[p] = weights[under];
    }
    return result;
}

}  // namespace patchlight
