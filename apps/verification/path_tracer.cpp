#include "apps/verification/path_tracer.h"

#include "formfactor/scrambled_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace patchlight {

namespace {

using std::numbers::pi;

double sum_of(const Rgb& x)
{
    return x.r + x.g + x.b;
}

double greatest(const Rgb& x)
{
    return std::max({x.r, x.g, x.b});
}

/// Whether emitters cover so much of the scene that paths meet them anyway.
bool emits_all_over(const Scene& scene)
{
    double emitting = 0, all = 0;
    for (const Surface& surface : scene.surfaces) {
        all += surface.area;
        if (scene.materials[surface.material.value].emits()) emitting += surface.area;
    }
    return emitting >= 0.5 * all;
}

/// Cosine-weighted about the frame's normal.
Vec3 direction_about(const PlaneFrame& frame, const std::array<double, 2>& numbers)
{
    const double r = std::sqrt(numbers[0]), phi = 2 * pi * numbers[1];
    return r * std::cos(phi) * frame.u + r * std::sin(phi) * frame.v + std::sqrt(1 - numbers[0]) * frame.n;
}

/// The balance heuristic's share of a way of length² r2 that can be found by a cosine-weighted direction or by drawing
/// its end with `density` per m²: g / (density + g), g = cos cos / (π r²). The cosines are times r.
double share_of_chance(double density, double cosine_from, double cosine_to, double r2)
{
    const double cosines = cosine_from * cosine_to;
    return cosines > 0 ? cosines / (cosines + density * pi * r2 * r2) : 0;
}

constexpr std::uint64_t for_directions = 0, for_lights = 1, for_path = 2;

}  // namespace

PathTracer::PathTracer(const Scene& scene, const RayCaster& caster, std::uint64_t seed,
                       std::optional<FindEmitters> emitters)
    : scene_(scene), caster_(caster),
      emitters_(scene, [&](SurfaceId s) { return sum_of(scene.material_of(s).emission); }), seed_(seed),
      how_(emitters.value_or(emits_all_over(scene) ? FindEmitters::by_chance : FindEmitters::drawn))
{}

void PathTracer::add_paths(const DrawnPoint& from, std::uint64_t stream, std::uint32_t first, std::uint32_t count,
                           Rgb& sum, Scratch& scratch) const
{
    if (!(emitters_.total() > 0)) return;
    begin(from, stream, first, count, scratch);
    while (!scratch.paths.empty()) {
        if (how_ == FindEmitters::drawn) draw_emitters(sum, scratch);
        follow(sum, scratch);
    }
}

void PathTracer::begin(const DrawnPoint& from, std::uint64_t stream, std::uint32_t first, std::uint32_t count,
                       Scratch& scratch) const
{
    const ScrambledPoints directions(seed_, 3 * stream + for_directions), lights(seed_, 3 * stream + for_lights);
    const std::uint64_t own = RandomNumbers(seed_, 3 * stream + for_path).bits();
    const Rgb rho = scene_.material_of(from.surface).reflectance;
    scratch.paths.clear();
    for (std::uint32_t i = first; i < first + count; ++i)
        scratch.paths.push_back({from.position, from.surface, rho, lights(i), directions(i), RandomNumbers(own, i)});
}

void PathTracer::draw_emitters(Rgb& sum, Scratch& s) const
{
    s.rays.resize(s.paths.size());
    s.arriving.clear();
    for (const Path& path : s.paths) {
        const DrawnPoint light = emitters_.at(path.light_numbers[0], path.light_numbers[1]);
        const Vec3 &n = scene_.surface(path.surface).frame.n, &n_light = scene_.surface(light.surface).frame.n;
        const Vec3 way = light.position - path.position;
        const double r2 = glm::dot(way, way);
        const double share =
            share_of_chance(emitters_.density(light.surface), glm::dot(n, way), -glm::dot(n_light, way), r2);
        if (share <= 0 || glm::dot(n, way) <= 0) continue;  // one faces away, or each faces away from the other
        const Vec3 origin = caster_.leave(path.position, n), end = caster_.leave(light.position, n_light);
        s.rays.set(s.arriving.size(), origin, end - origin, 1.0F);
        // (E/π) cos cos / r² over the density, times (1 − share of chance): E times the share of chance.
        s.arriving.push_back(path.carried * scene_.material_of(light.surface).emission * share);
    }
    s.rays.resize(s.arriving.size());
    caster_.occluded(s.rays, s.blocked);
    s.traced += s.arriving.size();
    for (std::size_t i = 0; i < s.arriving.size(); ++i)
        if (s.blocked[i] == 0) sum += s.arriving[i];
}

void PathTracer::follow(Rgb& sum, Scratch& s) const
{
    s.rays.resize(s.paths.size());
    s.directions.resize(s.paths.size());
    for (std::size_t i = 0; i < s.paths.size(); ++i) {
        const PlaneFrame& frame = scene_.surface(s.paths[i].surface).frame;
        s.directions[i] = direction_about(frame, s.paths[i].direction_numbers);
        s.rays.set(i, caster_.leave(s.paths[i].position, frame.n), s.directions[i],
                   std::numeric_limits<float>::infinity());
    }
    caster_.closest(s.rays, s.hits);
    s.traced += s.paths.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < s.paths.size(); ++i) {
        if (s.hits.surface[i] >= HitBatch::black_back) continue;
        Path path = s.paths[i];
        const SurfaceId surface(s.hits.surface[i]);
        const PlaneFrame& frame = scene_.surface(surface).frame;
        const Vec3 position = frame.lift({s.hits.x[i], s.hits.y[i]});
        const Material& material = scene_.material_of(surface);
        if (material.emits()) {
            const Vec3 way = position - path.position;
            const double here = glm::dot(scene_.surface(path.surface).frame.n, way), there = -glm::dot(frame.n, way);
            const double share = how_ == FindEmitters::by_chance
                                     ? 1
                                     : share_of_chance(emitters_.density(surface), here, there, glm::dot(way, way));
            sum += path.carried * material.emission * share;
        }
        if (reflect(path, surface, position)) s.paths[kept++] = path;
    }
    s.paths.erase(s.paths.begin() + static_cast<std::ptrdiff_t>(kept), s.paths.end());
}

/// Goes on from a hit with a chance of the brightest band's ratio, so that what paths carry stays as it began.
bool PathTracer::reflect(Path& path, SurfaceId surface, const Vec3& position) const
{
    const Rgb carried = path.carried * scene_.material_of(surface).reflectance;
    const double survival = std::min(1.0, greatest(carried) / greatest(path.carried));
    if (path.random.uniform() >= survival) return false;
    path.carried = carried / survival;
    path.position = position;
    path.surface = surface;
    for (double& x : path.light_numbers) x = path.random.uniform();
    for (double& x : path.direction_numbers) x = path.random.uniform();
    return true;
}

}  // namespace patchlight
