#include "formfactor/blockers.h"

#include <boost/geometry/core/cs.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>

#include <algorithm>
#include <utility>

namespace patchlight {

namespace {

namespace geometry = boost::geometry;
using Point = geometry::model::point<double, 3, geometry::cs::cartesian>;
using Box = geometry::model::box<Point>;
using Entry = std::pair<Box, std::uint32_t>;

constexpr double relative_snap = 1e-8;

struct Bounds {
    Vec3 low{1e300}, high{-1e300};

    void add(std::span<const Vec3> points)
    {
        for (const Vec3& p : points) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    Box box(double margin) const
    {
        return {{low.x - margin, low.y - margin, low.z - margin}, {high.x + margin, high.y + margin, high.z + margin}};
    }
};

/// Independent of where the loop starts and which way it runs.
std::vector<Vec3> sorted_corners(const Blocker& blocker)
{
    std::vector<Vec3> corners(blocker.corners.begin(), blocker.corners.end());
    std::ranges::sort(corners, [](const Vec3& p, const Vec3& q) { return precedes(p, q); });
    return corners;
}

std::vector<Blocker> blockers_of(const Scene& scene)
{
    std::vector<std::pair<std::vector<Vec3>, Blocker>> all;
    for (const Facet& facet : facets_of(scene)) {
        Blocker blocker{Polygon(facet.corners.begin(), facet.corners.end()), facet.normal,
                        glm::dot(facet.normal, facet.corners[0]), 0};
        std::vector<Vec3> key = sorted_corners(blocker);
        all.emplace_back(std::move(key), std::move(blocker));
    }
    std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return precedes(a.first, b.first); });
    std::vector<Blocker> result;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (i == 0 || all[i].first != all[i - 1].first) result.push_back(std::move(all[i].second));
    return result;
}

/// What of a blocker lies in front of both planes; nothing when it keeps no area there.
bool clipped(const Blocker& blocker, const Vec3& normal_a, double offset_a, const Vec3& normal_b, double offset_b,
             double snap, Blocker& result)
{
    Polygon half;
    keep_front(blocker.corners, normal_a, offset_a, snap, half);
    if (half.size() < 3) return false;
    keep_front(half, normal_b, offset_b, snap, result.corners);
    result.normal = blocker.normal;
    result.offset = blocker.offset;
    result.index = blocker.index;
    return result.corners.size() >= 3;
}

bool any_in_front(std::span<const Vec3> polygon, const Vec3& normal, double offset, double snap)
{
    return std::ranges::any_of(polygon, [&](const Vec3& p) { return glm::dot(normal, p) - offset > snap; });
}

}  // namespace

struct Blockers::Tree {
    geometry::index::rtree<Entry, geometry::index::rstar<16>> boxes;
};

Blockers::Blockers(const Scene& scene) : Blockers(blockers_of(scene), scene.diameter) {}

Blockers::Blockers(std::vector<Blocker> blockers, double size)
    : blockers_(std::move(blockers)), tree_(std::make_unique<Tree>()), snap_(relative_snap * size)
{
    std::vector<Entry> entries;
    for (std::uint32_t k = 0; k < blockers_.size(); ++k) {
        blockers_[k].index = k;
        Bounds bounds;
        bounds.add(blockers_[k].corners);
        entries.emplace_back(bounds.box(0), k);
    }
    tree_->boxes = decltype(tree_->boxes)(entries);  // packed: the same for the same blockers
}

Blockers::Blockers(Blockers&&) noexcept = default;
Blockers& Blockers::operator=(Blockers&&) noexcept = default;
Blockers::~Blockers() = default;

Visibility Blockers::between(std::span<const Vec3> a, const Vec3& normal_a, std::span<const Vec3> b,
                             const Vec3& normal_b, std::vector<Blocker>& found) const
{
    return among_few(a, normal_a, b, normal_b, blockers_.size(), found);
}

Visibility Blockers::among_few(std::span<const Vec3> a, const Vec3& normal_a, std::span<const Vec3> b,
                               const Vec3& normal_b, std::size_t most, std::vector<Blocker>& found) const
{
    found.clear();
    const double offset_a = glm::dot(normal_a, a[0]), offset_b = glm::dot(normal_b, b[0]);
    if (!any_in_front(a, normal_b, offset_b, snap_) || !any_in_front(b, normal_a, offset_a, snap_))
        return Visibility::hidden;
    Polygon front_a, front_b;
    keep_front(a, normal_b, offset_b, snap_, front_a);
    keep_front(b, normal_a, offset_a, snap_, front_b);
    const Shaft shaft{front_a, front_b};
    Bounds bounds;
    bounds.add(shaft.a);
    bounds.add(shaft.b);
    std::vector<Entry> near;
    const auto meets = geometry::index::intersects(bounds.box(snap_));
    for (auto it = tree_->boxes.qbegin(meets); it != tree_->boxes.qend(); ++it) {
        if (near.size() == most) return Visibility::partial;
        near.push_back(*it);
    }
    std::ranges::sort(near, {}, &Entry::second);
    Blocker rest;
    for (const Entry& entry : near) {
        const Blocker& blocker = blockers_[entry.second];
        if (!clipped(blocker, normal_a, offset_a, normal_b, offset_b, snap_, rest)) continue;
        const Visibility past = visibility_past(shaft, rest.view(), snap_);
        if (past == Visibility::visible) continue;
        found.push_back(rest);
        if (past == Visibility::hidden) return past;
    }
    return found.empty() ? Visibility::visible : Visibility::partial;
}

Visibility sift(const Shaft& shaft, std::span<const Blocker> candidates, double snap, std::vector<std::uint32_t>& found)
{
    found.clear();
    for (std::uint32_t k = 0; k < candidates.size(); ++k) {
        const Visibility past = visibility_past(shaft, candidates[k].view(), snap);
        if (past == Visibility::visible) continue;
        found.push_back(k);
        if (past == Visibility::hidden) return past;
    }
    return found.empty() ? Visibility::visible : Visibility::partial;
}

}  // namespace patchlight
