#include "apps/imaging/picture.h"
#include "apps/imaging/view_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

namespace patchlight {

namespace {

struct Box {
    Vec3 low{1e300};
    Vec3 high{-1e300};

    Vec3 center() const { return 0.5 * (low + high); }
    Vec3 half() const { return 0.5 * (high - low); }
};

Box bounds(const Scene& scene)
{
    Box box;
    for (const Vec3& p : scene.vertices) {
        box.low = glm::min(box.low, p);
        box.high = glm::max(box.high, p);
    }
    return box;
}

View looking(const Vec3& from, const Vec3& to, double fov)
{
    View view;
    view.name = "default";
    view.from = from;
    view.forward = glm::normalize(to - from);
    view.up = std::abs(view.forward.y) > 0.99 ? Vec3{0, 0, -1} : Vec3{0, 1, 0};
    view.vertical_fov = fov;
    return view;
}

/// Before the middles of the largest triangles' fronts, a tenth of the way to what they see, looking past the
/// scene's middle: always inside a closed scene, however it is turned.
std::vector<View> before_surfaces(const Scene& scene, const RayCaster& caster)
{
    std::vector<const SceneTriangle*> largest;
    for (const SceneTriangle& t : scene.triangles) {
        if (t.front.valid()) {
            largest.push_back(&t);
        }
    }
    const auto corner = [&](const SceneTriangle& t, int k) { return scene.vertices[t.vertices[k]]; };
    const auto size = [&](const SceneTriangle* t) {
        return glm::length(glm::cross(corner(*t, 1) - corner(*t, 0), corner(*t, 2) - corner(*t, 0)));
    };
    std::stable_sort(largest.begin(), largest.end(), [&](const auto* a, const auto* b) { return size(a) > size(b); });
    largest.resize(std::min<std::size_t>(largest.size(), 16));
    RayBatch rays;
    HitBatch hits;
    std::vector<View> views;
    for (const SceneTriangle* t : largest) {
        const Vec3 middle = (corner(*t, 0) + corner(*t, 1) + corner(*t, 2)) / 3.0;
        const Vec3& n = scene.surface(t->front).frame.n;
        rays.resize(1);
        rays.set(0, caster.leave(middle, n), n, std::numeric_limits<float>::infinity());
        caster.closest(rays, hits);
        if (hits.surface[0] >= HitBatch::black_back) {
            continue;
        }
        const Vec2 q{static_cast<double>(hits.x[0]), static_cast<double>(hits.y[0])};
        const Vec3 across = scene.surface(SurfaceId(hits.surface[0])).frame.lift(q) - middle;
        const Vec3 from = middle + 0.1 * across;
        const Vec3 to = bounds(scene).center() + 0.25 * across;
        if (glm::length(to - from) > 1e-3 * scene.diameter) {
            views.push_back(looking(from, to, 65));
        }
    }
    return views;
}

std::vector<View> candidates(const Scene& scene, const RayCaster& caster)
{
    const Box box = bounds(scene);
    const Vec3 center = box.center(), half = box.half();
    std::vector<View> views = before_surfaces(scene, caster);
    for (int corner = 0; corner < 4; ++corner) {
        // Not into the corner itself, and rather at the height of somebody who stands.
        const Vec3 side{corner & 1 ? 0.86 : -0.86, 0.3, corner & 2 ? 0.86 : -0.86};
        views.push_back(looking(center + side * half, center - Vec3{0.3, 0.15, 0.3} * side * half, 65));
    }
    if (scene.closed) {
        return views;
    }
    const double away = 0.5 * scene.diameter / std::tan(20.0 * 3.14159265358979 / 180);
    for (const Vec3& side : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0},
                             Vec3{0, -1, 0}, Vec3{1, .7, 1}, Vec3{-1, .7, 1}, Vec3{1, .7, -1}, Vec3{-1, .7, -1}}) {
        views.push_back(looking(center + away * glm::normalize(side), center, 40));
    }
    return views;
}

/// The share of the picture that shows fronts counts twice, then how many there are.
double score(const RayCaster& caster, const View& view)
{
    const ViewHits hits = trace_view(caster, view, 48, 48, 1);
    std::set<std::uint32_t> seen;
    std::size_t fronts = 0;
    for (std::uint32_t surface : hits.surface) {
        if (surface < HitBatch::black_back) {
            seen.insert(surface);
            ++fronts;
        }
    }
    const double share = static_cast<double>(fronts) / static_cast<double>(hits.surface.size());
    return share * share * (1.0 + std::log(1.0 + static_cast<double>(seen.size())));
}

}  // namespace

View default_view(const Scene& scene, const RayCaster& caster)
{
    View best;
    double best_score = -1;
    for (const View& view : candidates(scene, caster)) {
        const double s = score(caster, view);
        if (s > best_score * 1.0001) {
            best = view;
            best_score = s;
        }
    }
    return best;
}

}  // namespace patchlight
