#include "solver/link_check.h"

#include "formfactor/work_monitor.h"
#include "solver/random_ray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace patchlight {

namespace {

/// Many: noise of the product falls with it, while of more patches only its root.
constexpr std::uint32_t rays_in_half = 256;

/// Patches drawn in proportion to their weight, stratified: each as often as its share of the whole says, to 1.
std::vector<PatchId> drawn_patches(const PatchField<double>& weight, double whole, std::size_t n, RandomNumbers random)
{
    std::vector<PatchId> patches;
    double upto = 0;
    std::size_t i = 0, last = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const double target = (static_cast<double>(k) + random.uniform()) * whole / static_cast<double>(n);
        for (; i < weight.size() && upto <= target; ++i) {
            upto += weight[PatchId(i)];
            if (weight[PatchId(i)] > 0) last = i;
        }
        patches.push_back(PatchId(last));
    }
    return patches;
}

/// For for_each_row.
struct Scratch {
    RayBatch batch;
    HitBatch hits;
    std::vector<PatchId> patches;
    std::size_t traced = 0;
};

/// Of X over rays that leave a patch.
Rgb mean_arriving(const Exchange& exchange, PatchId patch, const Radiosity& X, RandomNumbers random, Scratch& scratch)
{
    scratch.batch.resize(rays_in_half);
    for (std::size_t k = 0; k < rays_in_half; ++k) set_random_ray(exchange, patch, random, k, scratch.batch);
    exchange.caster.closest(scratch.batch, scratch.hits);
    scratch.patches.resize(rays_in_half);
    exchange.locator.locate(scratch.hits.surface, scratch.hits.x, scratch.hits.y, HitBatch::black_back,
                            scratch.patches);
    scratch.traced += rays_in_half;
    Rgb sum(0.0);
    for (const PatchId hit : scratch.patches)
        if (hit.valid()) sum += X[hit];
    return sum / static_cast<double>(rays_in_half);
}

double sum_of(const Rgb& x)
{
    return x.r + x.g + x.b;
}

}  // namespace

double LinkCheck::at_least() const
{
    return std::sqrt(std::max(0.0, error * error - 2 * uncertainty));
}

LinkCheck check_links(const Exchange& exchange, const PatchField<Rgb>& rho, const Radiosity& X, const Radiosity& H,
                      std::size_t rays, std::uint64_t seed, const WorkMonitor& monitor)
{
    PatchField<double> weight(X.size());
    double whole = 0, carried = 0, brought = 0;
    for (std::size_t i = 0; i < X.size(); ++i) {
        const PatchId p(i);
        const double area = exchange.mesh.area(p);
        weight[p] = area * glm::dot(rho[p], rho[p]);
        whole += weight[p];
        const Rgb reflected = rho[p] * H[p];
        carried += area * glm::dot(reflected, reflected);
        brought += area * sum_of(reflected);
    }
    if (!(carried > 0)) return {};
    const std::vector<PatchId> patches =
        drawn_patches(weight, whole, std::max<std::size_t>(rays / (2 * rays_in_half), 2), RandomNumbers(seed, rays));
    std::vector<double> product(patches.size()), over(patches.size());
    for_each_row<Scratch>(patches.size(), monitor, [&](std::size_t k, Scratch& scratch) {
        const PatchId p = patches[k];
        const double share = exchange.mesh.area(p) / weight[p];
        std::array<Rgb, 2> wrong{};
        for (std::uint32_t half = 0; half < 2; ++half)
            wrong[half] =
                rho[p] * (H[p] - mean_arriving(exchange, p, X, RandomNumbers(seed + 1, 2 * k + half), scratch));
        product[k] = share * glm::dot(wrong[0], wrong[1]);
        over[k] = share * sum_of(wrong[0] + wrong[1]) / 2;
    });
    double mean = 0, bias = 0, variance = 0;
    const auto n = static_cast<double>(patches.size());
    for (std::size_t k = 0; k < patches.size(); ++k) {
        mean += product[k] / n;
        bias += over[k] / n;
    }
    for (const double x : product) variance += (x - mean) * (x - mean) / (n * (n - 1));
    return {std::sqrt(std::max(0.0, mean * whole / carried)), std::sqrt(variance) * whole / carried,
            brought > 0 ? bias * whole / brought : 0};
}

}  // namespace patchlight
