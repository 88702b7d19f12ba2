#include "formfactor/hemisphere.h"

#include "formfactor/scrambled_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace patchlight {

namespace {

void add(HemisphereSet& set, double sine, double cosine, double phi, double factor)
{
    set.x.push_back(static_cast<float>(sine * std::cos(phi)));
    set.y.push_back(static_cast<float>(sine * std::sin(phi)));
    set.z.push_back(static_cast<float>(cosine));
    set.factor.push_back(static_cast<float>(factor));
    set.sum += factor;
}

/// Origins: the R2 sequence, shifted at random, folded into the triangle, dealt to the directions at random.
void add_origins(HemisphereSet& set, RandomNumbers& random)
{
    constexpr double g = 1.32471795724474602596;  // plastic number [Roberts18]
    const std::size_t n = set.size();
    const double shift0 = random.uniform(), shift1 = random.uniform();
    std::vector<std::uint32_t> deal(n);
    std::iota(deal.begin(), deal.end(), 0U);
    for (std::size_t i = n; i > 1; --i) std::swap(deal[i - 1], deal[random.below(static_cast<std::uint32_t>(i))]);
    set.b0.resize(n);
    set.b1.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        double whole = 0;
        double u = std::modf(shift0 + static_cast<double>(i) / g, &whole);
        double v = std::modf(shift1 + static_cast<double>(i) / (g * g), &whole);
        // Low-distortion map of the square to the triangle [Heitz19].
        if (v > u) {
            u *= 0.5;
            v -= u;
        } else {
            v *= 0.5;
            u -= v;
        }
        set.b0[deal[i]] = static_cast<float>(u);
        set.b1[deal[i]] = static_cast<float>(v);
    }
}

HemisphereSet stratified(int rays, RandomNumbers& random)
{
    const int rings = std::max(2, 2 * static_cast<int>(std::lround(std::sqrt(rays / 6.0) / 2)));
    const int sectors = 4 * ((rays + 4 * rings - 1) / (4 * rings));
    const ScrambledPoints net(random.bits(), random.bits());
    std::vector<std::array<double, 2>> points;
    for (int i = 0; i < rings * sectors; ++i) points.push_back(net(static_cast<std::uint32_t>(i)));
    // In tiles of 2 rings × 4 sectors' size: packets of similar rays.
    const auto tile = [&](const std::array<double, 2>& p) {
        return std::pair(std::floor(p[0] * rings / 2), std::floor(p[1] * sectors / 4));
    };
    std::ranges::stable_sort(points, [&](const auto& a, const auto& b) { return tile(a) < tile(b); });
    HemisphereSet set;
    for (const auto& [u, v] : points)
        add(set, std::sqrt(u), std::sqrt(1 - u), 2 * std::numbers::pi * v, 1.0 / (rings * sectors));
    return set;
}

}  // namespace

HemisphereSet regular_grid(int k, bool exact_rings)
{
    if (k < 8 || k % 4 != 0) throw std::invalid_argument("a regular hemisphere grid needs k ≥ 8, a multiple of 4");
    const double step = 2 * std::numbers::pi / k;
    HemisphereSet set;
    for (int m = exact_rings ? 0 : 1; m < k / 4; ++m) {
        const double theta = exact_rings ? (m + 0.5) * step : m * step;
        const double low = std::sin(m * step), high = std::sin((m + 1) * step);
        const double factor = exact_rings ? (high * high - low * low) / k
                                          : 2 * std::numbers::pi / (static_cast<double>(k) * k) * std::sin(2 * theta);
        for (int l = 0; l < k; ++l) add(set, std::sin(theta), std::cos(theta), l * step, factor);
    }
    return set;
}

std::vector<HemisphereSet> hemisphere_sets(const FormFactorOptions& options, int count)
{
    std::vector<HemisphereSet> sets;
    for (int i = 0; i < count; ++i) {
        RandomNumbers random(options.seed, static_cast<std::uint64_t>(i));
        if (options.directions == HemisphereDirections::stratified) {
            sets.push_back(stratified(options.rays, random));
        } else {
            const int k = std::max(8, 4 * static_cast<int>(std::lround(std::sqrt(options.rays / 4.0))));
            sets.push_back(regular_grid(k, options.directions == HemisphereDirections::regular_grid));
        }
        add_origins(sets.back(), random);
    }
    return sets;
}

void aim(const HemisphereSet& set, const PlaneFrame& frame, double turn, RayBatch& rays)
{
    const Vec3 u = std::cos(turn) * frame.u + std::sin(turn) * frame.v, v = glm::cross(frame.n, u);
    const auto f = [](double x) { return static_cast<float>(x); };
    const float ux = f(u.x), uy = f(u.y), uz = f(u.z), vx = f(v.x), vy = f(v.y), vz = f(v.z);
    const float nx = f(frame.n.x), ny = f(frame.n.y), nz = f(frame.n.z);
    rays.resize(set.size());
    for (std::size_t i = 0; i < set.size(); ++i) {
        const float x = set.x[i], y = set.y[i], z = set.z[i];
        rays.dx[i] = x * ux + y * vx + z * nx;
        rays.dy[i] = x * uy + y * vy + z * ny;
        rays.dz[i] = x * uz + y * vz + z * nz;
        rays.reach[i] = std::numeric_limits<float>::infinity();
    }
}

PickedSet pick_set(std::size_t sets, std::uint64_t seed, std::uint64_t key)
{
    RandomNumbers random(seed, ~key);
    const std::size_t index = random.below(static_cast<std::uint32_t>(sets));
    return {index, 2 * std::numbers::pi * random.uniform()};
}

void aim_from(const Vec3& start, const HemisphereSet& set, const PlaneFrame& frame, double turn, RayBatch& rays)
{
    aim(set, frame, turn, rays);
    std::fill_n(rays.ox.begin(), set.size(), static_cast<float>(start.x));
    std::fill_n(rays.oy.begin(), set.size(), static_cast<float>(start.y));
    std::fill_n(rays.oz.begin(), set.size(), static_cast<float>(start.z));
}

}  // namespace patchlight
