#include "apps/imaging/picture.h"
#include "apps/imaging/view_rays.h"

#include <cmath>
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

std::vector<View> candidates(const Scene& scene)
{
    const Box box = bounds(scene);
    const Vec3 center = box.center(), half = box.half();
    std::vector<View> views;
    for (int corner = 0; corner < 4; ++corner) {
        // Not into the corner itself, and rather at the height of somebody who stands.
        const Vec3 side{corner & 1 ? 0.86 : -0.86, 0.3, corner & 2 ? 0.86 : -0.86};
        views.push_back(looking(center + side * half, center - Vec3{0.3, 0.15, 0.3} * side * half, 65));
    }
    if (scene.closed) {
        return views;
    }
    const double away = 0.5 * scene.diameter / std::tan(20.0 * 3.14159265358979 / 180);
    for (const Vec3& side : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0},
                             Vec3{1, .7, 1}, Vec3{-1, .7, 1}, Vec3{1, .7, -1}, Vec3{-1, .7, -1}}) {
        views.push_back(looking(center + away * glm::normalize(side), center, 40));
    }
    return views;
}

/// Share of the picture that shows fronts, more when they are many.
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
    return share * (1.0 + std::log(1.0 + static_cast<double>(seen.size())));
}

}  // namespace

View default_view(const Scene& scene, const RayCaster& caster)
{
    View best;
    double best_score = -1;
    for (const View& view : candidates(scene)) {
        const double s = score(caster, view);
        if (s > best_score * 1.0001) {
            best = view;
            best_score = s;
        }
    }
    return best;
}

}  // namespace patchlight
