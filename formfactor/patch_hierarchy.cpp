#include "formfactor/patch_hierarchy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace patchlight {

namespace {

using Node = PatchHierarchy::Node;

/// Normals differ by less: parallel.
constexpr double parallel = 1e-9;
/// A cluster whose normals have more than this between them, in any coordinate, is split by direction.
constexpr double same_direction = 0.4;

struct Range {
    Vec3 low{1e300}, high{-1e300};

    void add(const Vec3& p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    Vec3 extent() const { return high - low; }
};

int longest(const Vec3& extent)
{
    if (extent.x >= extent.y && extent.x >= extent.z) return 0;
    return extent.y >= extent.z ? 1 : 2;
}

double greatest(const Vec3& v)
{
    return std::max({v.x, v.y, v.z});
}

class Builder {
public:
    Builder(const Scene& scene, const PatchMesh& mesh) : scene_(scene), mesh_(mesh) {}

    PatchHierarchy build(std::span<const std::uint8_t> lit)
    {
        std::vector<Item> items;
        for (std::size_t s = 0; s < scene_.surfaces.size(); ++s)
            if (mesh_.patches_of(SurfaceId(s)).size() > 0) items.push_back(item(SurfaceId(s)));
        tree_.nodes.reserve(2 * mesh_.patch_count());
        tree_.order.reserve(mesh_.patch_count());
        tree_.area_upto.reserve(mesh_.patch_count() + 1);
        tree_.area_upto.push_back(0);
        const auto dark = std::stable_partition(
            items.begin(), items.end(), [&](const Item& i) { return lit.empty() || lit[i.surface.value] != 0; });
        const auto first = static_cast<std::size_t>(dark - items.begin());
        if (first > 0 && first < items.size())
            add_parent(items, first);
        else if (!items.empty())
            add_surfaces(items);
        return std::move(tree_);
    }

private:
    struct Item {
        Vec3 middle{0.0}, normal{0.0};
        double width = 0;
        SurfaceId surface;
    };
    struct Place {
        Vec2 middle{0.0};
        PatchId patch;
    };

    Item item(SurfaceId s) const
    {
        Range box;
        for (const VertexId v : mesh_.vertices_of(s)) box.add(mesh_.position(v));
        return {0.5 * (box.low + box.high), scene_.surface(s).frame.n, greatest(box.extent()), s};
    }

    std::int32_t add(const Node& node)
    {
        tree_.nodes.push_back(node);
        return static_cast<std::int32_t>(tree_.nodes.size()) - 1;
    }

    std::int32_t add_surfaces(std::span<Item> items)
    {
        if (items.size() == 1) {
            std::vector<Place> places;
            for (const PatchId p : mesh_.patches_of(items[0].surface)) {
                const auto c = mesh_.corners(p);
                places.push_back(
                    {(mesh_.plane_position(c[0]) + mesh_.plane_position(c[1]) + mesh_.plane_position(c[2])) / 3.0, p});
            }
            return add_patches(places);
        }
        return add_parent(items, split(items));
    }

    std::int32_t add_parent(std::span<Item> items, std::size_t cut)
    {
        Node node;
        node.left = add_surfaces(items.first(cut));
        node.right = add_surfaces(items.subspan(cut));
        join(node);
        return add(node);
    }

    /// Puts the items in two groups; returns how many are in the first.
    static std::size_t split(std::span<Item> items)
    {
        Range normals, places;
        double widest = 0;
        for (const Item& i : items) {
            normals.add(i.normal);
            places.add(i.middle);
            widest = std::max(widest, i.width);
        }
        const auto parted = [&](const auto& first) {
            return static_cast<std::size_t>(std::stable_partition(items.begin(), items.end(), first) - items.begin());
        };
        if (const int k = longest(normals.extent()); normals.extent()[k] > same_direction) {
            const double middle = 0.5 * (normals.low[k] + normals.high[k]);
            return parted([&](const Item& i) { return i.normal[k] < middle; });
        }
        if (widest > 0.5 * greatest(places.extent()))
            if (const std::size_t cut = parted([&](const Item& i) { return i.width > 0.5 * widest; });
                cut < items.size())
                return cut;
        const int k = longest(places.extent());
        const std::size_t half = items.size() / 2;
        std::ranges::nth_element(items, items.begin() + static_cast<std::ptrdiff_t>(half), {},
                                 [&](const Item& i) { return std::pair(i.middle[k], i.surface); });
        return half;
    }

    std::int32_t add_patches(std::span<Place> places)
    {
        if (places.size() == 1) return add(leaf(places[0].patch));
        Vec2 low(1e300), high(-1e300);
        for (const Place& p : places) {
            low = glm::min(low, p.middle);
            high = glm::max(high, p.middle);
        }
        const int k = high.x - low.x >= high.y - low.y ? 0 : 1;
        const std::size_t half = places.size() / 2;
        std::ranges::nth_element(places, places.begin() + static_cast<std::ptrdiff_t>(half), {},
                                 [&](const Place& p) { return std::pair(p.middle[k], p.patch); });
        Node node;
        node.left = add_patches(places.first(half));
        node.right = add_patches(places.subspan(half));
        join(node);
        return add(node);
    }

    Node leaf(PatchId patch)
    {
        Node node;
        node.surface = mesh_.surface(patch);
        node.axis = scene_.surface(node.surface).frame.n;
        Range box;
        Vec2 low(1e300), high(-1e300);
        node.least = 1e300;
        node.most = -1e300;
        for (const VertexId v : mesh_.corners(patch)) {
            box.add(mesh_.position(v));
            low = glm::min(low, mesh_.plane_position(v));
            high = glm::max(high, mesh_.plane_position(v));
            node.least = std::min(node.least, glm::dot(node.axis, mesh_.position(v)));
            node.most = std::max(node.most, glm::dot(node.axis, mesh_.position(v)));
        }
        node.low = box.low;
        node.high = box.high;
        node.corner = low;
        node.size = high - low;
        node.area = mesh_.area(patch);
        node.first = static_cast<std::uint32_t>(tree_.order.size());
        node.last = node.first + 1;
        tree_.order.push_back(patch);
        tree_.area_upto.push_back(tree_.area_upto.back() + node.area);
        return node;
    }

    /// All but the children, from these.
    void join(Node& node) const
    {
        const Node &a = tree_.nodes[static_cast<std::size_t>(node.left)],
                   &b = tree_.nodes[static_cast<std::size_t>(node.right)];
        node.low = glm::min(a.low, b.low);
        node.high = glm::max(a.high, b.high);
        node.area = a.area + b.area;
        node.first = a.first;
        node.last = b.last;
        const Vec3 sum = a.area * a.axis + b.area * b.axis;
        const double length = glm::length(sum);
        node.axis = length > parallel * node.area ? sum / length : a.axis;
        node.spread = std::max(glm::length(node.axis - a.axis) + a.spread, glm::length(node.axis - b.axis) + b.spread);
        node.least = node.most = glm::dot(node.axis, node.low);
        if (node.spread < parallel) {
            node.axis = a.axis;
            node.spread = 0;
            node.least = std::min(a.least, b.least);
            node.most = std::max(a.most, b.most);
        } else {
            node.least = node.most = 0;
            for (int k = 0; k < 3; ++k) {
                const double u = node.axis[k] * node.low[k], v = node.axis[k] * node.high[k];
                node.least += std::min(u, v);
                node.most += std::max(u, v);
            }
        }
        if (a.surface == b.surface && a.surface.valid()) {
            node.surface = a.surface;
            node.corner = glm::min(a.corner, b.corner);
            node.size = glm::max(a.corner + a.size, b.corner + b.size) - node.corner;
        }
    }

    const Scene& scene_;
    const PatchMesh& mesh_;
    PatchHierarchy tree_;
};

/// The farthest that anything of q lies in front of a plane with normal `axis` through the origin.
double reach(const Node& q, const Vec3& axis)
{
    if (q.spread == 0) {
        if (glm::length(q.axis - axis) < parallel) return q.most;
        if (glm::length(q.axis + axis) < parallel) return -q.least;
    }
    double most = 0;
    for (int k = 0; k < 3; ++k) most += std::max(axis[k] * q.low[k], axis[k] * q.high[k]);
    return most;
}

struct Distance {
    double least = 0, most = 0;
};

Distance distance(const Node& p, const Node& q)
{
    double least = 0, most = 0;
    for (int k = 0; k < 3; ++k) {
        const double gap = std::max({0.0, p.low[k] - q.high[k], q.low[k] - p.high[k]});
        const double span = std::max(q.high[k] - p.low[k], p.high[k] - q.low[k]);
        least += gap * gap;
        most += span * span;
    }
    return {std::sqrt(least), std::sqrt(most)};
}

/// dot(n, y − x) is nowhere more, for x in p with normal n, y in q.
double greatest_height(const Node& p, const Node& q, double farthest)
{
    return reach(q, p.axis) - p.least + p.spread * farthest;
}

}  // namespace

PatchHierarchy patch_hierarchy(const Scene& scene, const PatchMesh& mesh, std::span<const std::uint8_t> lit)
{
    return Builder(scene, mesh).build(lit);
}

void node_hull(const Scene& scene, const PatchMesh& mesh, const PatchHierarchy& tree, std::uint32_t node,
               std::vector<Vec3>& corners)
{
    const Node& n = tree.nodes[node];
    corners.clear();
    if (n.is_leaf()) {
        for (const VertexId v : mesh.corners(tree.order[n.first])) corners.push_back(mesh.position(v));
        return;
    }
    const PlaneFrame& frame = scene.surface(n.surface).frame;
    for (const Vec2& q : {n.corner, n.corner + Vec2(n.size.x, 0), n.corner + n.size, n.corner + Vec2(0, n.size.y)})
        corners.push_back(frame.lift(q));
}

bool may_face(const Node& p, const Node& q, double snap)
{
    if (p.surface.valid() && p.surface == q.surface) return false;
    const double farthest = distance(p, q).most;
    return greatest_height(p, q, farthest) > snap && greatest_height(q, p, farthest) > snap;
}

double greatest_kernel(const Node& p, const Node& q)
{
    const double closed = 1 / std::max(p.area, q.area);
    const Distance d = distance(p, q);
    if (!(d.least > 0)) return closed;
    const double cos_p = std::min(1.0, greatest_height(p, q, d.most) / d.least);
    const double cos_q = std::min(1.0, greatest_height(q, p, d.most) / d.least);
    if (!(cos_p > 0 && cos_q > 0)) return 0;
    return std::min(closed, cos_p * cos_q / (std::numbers::pi * d.least * d.least));
}

}  // namespace patchlight
