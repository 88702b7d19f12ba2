#include "tests/verification/path_traced_reference_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace patchlight::reference {

namespace {

using std::numbers::pi;

/// SplitMix64: a stream for every key, no state shared between points.
class Random {
public:
    Random(std::uint64_t seed, std::uint64_t index, std::uint64_t replicate)
        : state_(mix(mix(mix(seed) + index) + replicate))
    {}
    double operator()() { return static_cast<double>(mix(state_ += 0x9e3779b97f4a7c15U) >> 11) * 0x1p-53; }

private:
    static std::uint64_t mix(std::uint64_t z)
    {
        z += 0x9e3779b97f4a7c15U;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31);
    }
    std::uint64_t state_;
};

struct Tracer {
    const ReferenceScene& scene;
    const PathOptions& options;
    std::vector<std::size_t> emitters;

    Tracer(const ReferenceScene& s, const PathOptions& o) : scene(s), options(o)
    {
        for (std::size_t i = 0; i < scene.polygons().size(); ++i)
            if (scene.polygons()[i].emits()) emitters.push_back(i);
    }

    /// A point of an emitter's bounding rectangle as seen from (p, n).
    struct Sight {
        double cosines_over_r2 = 0;  ///< cos · cos / r²; 0 when it isn't seen, or isn't in the polygon
        double per_solid_angle = 0;  ///< density over solid angle of points that are uniform in the rectangle
        double cosine = 0;           ///< at p
    };
    Sight sight(const Polygon& emitter, const Vec3& p, const Vec3& n, double a, double b) const
    {
        const Vec2 q = emitter.low + Vec2{a, b} * (emitter.high - emitter.low);
        const Vec3 at = emitter.at(q);
        const double r = glm::length(at - p);
        const Vec3 way = (at - p) / r;
        const double here = glm::dot(n, way);
        const double there = -glm::dot(emitter.n, way);
        if (here <= 0 || there <= 0 || !emitter.contains(q) || !scene.sees(p, at)) return {};
        return {here * there / (r * r), r * r / (there * rectangle(emitter)), here};
    }

    static double rectangle(const Polygon& emitter)
    {
        const Vec2 extent = emitter.high - emitter.low;
        return extent.x * extent.y;
    }

    Rgb direct_stratified(const Vec3& p, const Vec3& n, Random& random) const
    {
        Rgb sum{0.0};
        const int strata = options.light_strata;
        for (const std::size_t e : emitters)
            for (int i = 0; i < strata; ++i)
                for (int j = 0; j < strata; ++j) {
                    const double a = (i + random()) / strata;
                    const double b = (j + random()) / strata;
                    const Polygon& emitter = scene.polygons()[e];
                    sum += sight(emitter, p, n, a, b).cosines_over_r2 * rectangle(emitter) * emitter.radiance;
                }
        return sum / static_cast<double>(strata * strata);
    }

    /// One point of each emitter. Weighed against the chance that the path's next ray would hit the same point
    /// [VeachGuibas95, balance heuristic]: beside an emitter's edge 1/r² alone has no finite variance.
    Rgb direct_once(const Vec3& p, const Vec3& n, Random& random) const
    {
        Rgb sum{0.0};
        for (const std::size_t e : emitters) {
            const Polygon& emitter = scene.polygons()[e];
            const double a = random();
            const double b = random();
            const Sight seen = sight(emitter, p, n, a, b);
            if (seen.cosines_over_r2 <= 0) continue;
            const double weight = seen.per_solid_angle / (seen.per_solid_angle + seen.cosine / pi);
            sum += weight * seen.cosines_over_r2 * rectangle(emitter) * emitter.radiance;
        }
        return sum;
    }

    /// The weight of emission that a ray from a surface hits by chance, beside direct_once().
    static double weight_of_chance(const Polygon& emitter, double r, double cosine_here, double cosine_there)
    {
        const double drawn = r * r / (cosine_there * rectangle(emitter));
        return (cosine_here / pi) / (cosine_here / pi + drawn);
    }

    /// Cosine-weighted direction about n from two numbers of [0, 1).
    static Vec3 direction_about(const Vec3& n, double a, double b)
    {
        const Vec3 helper = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        const Vec3 u = glm::normalize(glm::cross(helper, n));
        const Vec3 v = glm::cross(n, u);
        const double r = std::sqrt(a);
        const double phi = 2 * pi * b;
        return glm::normalize(r * std::cos(phi) * u + r * std::sin(phi) * v + std::sqrt(1 - a) * n);
    }

    /// What a cosine-weighted ray brings in, as irradiance: π times the radiance that arrives along it. With
    /// `drawn`, without what the emitters send straight to p.
    Rgb along(Vec3 p, Vec3 n, Vec3 direction, Random& random) const
    {
        const bool drawn = options.emitters == FindEmitters::drawn;
        Rgb gathered{0.0};
        Rgb carried{1.0};
        for (bool first = true;; first = false) {
            const auto hit = scene.closest(p, direction);
            if (!hit || !hit->front) return gathered;
            const Polygon& polygon = scene.polygons()[hit->polygon];
            if (polygon.emits() && !(drawn && first)) {
                const double here = glm::dot(n, direction), there = -glm::dot(polygon.n, direction);
                const double weight = drawn ? weight_of_chance(polygon, hit->t, here, there) : 1.0;
                gathered += weight * pi * carried * polygon.radiance;
            }
            carried *= polygon.rho;
            const double survival = std::min(0.95, std::max({carried.r, carried.g, carried.b}));
            if (survival <= 0) return gathered;
            p += hit->t * direction;
            n = polygon.n;
            if (drawn) gathered += carried * direct_once(p, n, random);
            if (random() >= survival) return gathered;
            carried /= survival;
            const double a = random();
            const double b = random();
            direction = direction_about(n, a, b);
        }
    }

    Rgb indirect_stratified(const Vec3& p, const Vec3& n, Random& random) const
    {
        Rgb sum{0.0};
        const int strata = options.direction_strata;
        for (int i = 0; i < strata; ++i)
            for (int j = 0; j < strata; ++j) {
                const double a = (i + random()) / strata;
                const double b = (j + random()) / strata;
                sum += along(p, n, direction_about(n, a, b), random);
            }
        return sum / static_cast<double>(strata * strata);
    }
};

Measured summarise(const std::vector<Rgb>& values)
{
    Measured result;
    const auto n = static_cast<double>(values.size());
    for (const Rgb& value : values) result.mean += value / n;
    Rgb squares{0.0};
    for (const Rgb& value : values) squares += (value - result.mean) * (value - result.mean);
    result.standard_error = glm::sqrt(squares / (n * (n - 1)));
    return result;
}

}  // namespace

Irradiance measure_irradiance(const ReferenceScene& scene, const Vec3& p, const Vec3& n, const PathOptions& options,
                              std::uint64_t index)
{
    const Tracer tracer(scene, options);
    std::vector<Rgb> direct, total;
    for (int replicate = 0; replicate < options.replicates; ++replicate) {
        Random random(options.seed, index, static_cast<std::uint64_t>(replicate));
        const bool drawn = options.emitters == FindEmitters::drawn;
        direct.push_back(drawn ? tracer.direct_stratified(p, n, random) : Rgb{0.0});
        total.push_back(direct.back() + tracer.indirect_stratified(p, n, random));
    }
    return {summarise(direct), summarise(total)};
}

std::vector<SurfacePoint> sample_points(const ReferenceScene& scene, std::size_t count, std::uint64_t seed)
{
    std::vector<double> cumulative;
    double area = 0;
    for (const Polygon& polygon : scene.polygons()) cumulative.push_back(area += polygon.reflects() ? polygon.area : 0);
    std::vector<SurfacePoint> points;
    for (std::size_t k = 0; k < count; ++k) {
        Random random(seed, k, ~std::uint64_t{0});
        const double wanted = area * (static_cast<double>(k) + random()) / static_cast<double>(count);
        const auto found = std::upper_bound(cumulative.begin(), cumulative.end() - 1, wanted);
        const auto i = static_cast<std::size_t>(found - cumulative.begin());
        const Polygon& polygon = scene.polygons()[i];
        Vec2 q;
        do {
            const double a = random();
            const double b = random();
            q = polygon.low + Vec2{a, b} * (polygon.high - polygon.low);
        } while (!polygon.contains(q) || polygon.distance_to_border(q) < 1e-6 * scene.diameter());
        points.push_back({i, polygon.at(q)});
    }
    return points;
}

}  // namespace patchlight::reference
