#include "formfactor/patch_tree.h"

#include <algorithm>
#include <numeric>

namespace patchlight {

namespace {

class Builder {
public:
    Builder(const Scene& scene, const PatchMesh& mesh, std::size_t leaf_size)
        : scene_(scene), mesh_(mesh), leaf_size_(leaf_size)
    {}

    PatchTree build()
    {
        std::vector<SurfaceId> surfaces;
        for (std::size_t s = 0; s < scene_.surfaces.size(); ++s)
            if (mesh_.patches_of(SurfaceId(s)).size() > 0) surfaces.emplace_back(s);
        if (!surfaces.empty()) add_surfaces(surfaces);
        return std::move(tree_);
    }

private:
    std::int32_t add(PatchTree::Node node)
    {
        tree_.nodes.push_back(std::move(node));
        return static_cast<std::int32_t>(tree_.nodes.size()) - 1;
    }

    Vec3 middle(SurfaceId s) const
    {
        Vec3 low(1e300), high(-1e300);
        for (const VertexId v : mesh_.vertices_of(s)) {
            low = glm::min(low, mesh_.position(v));
            high = glm::max(high, mesh_.position(v));
        }
        return 0.5 * (low + high);
    }

    std::int32_t add_surfaces(std::span<SurfaceId> surfaces)
    {
        if (surfaces.size() == 1) {
            std::vector<PatchId> patches;
            for (const PatchId p : mesh_.patches_of(surfaces[0])) patches.push_back(p);
            return add_patches(patches);
        }
        Vec3 low(1e300), high(-1e300);
        for (const SurfaceId s : surfaces) {
            low = glm::min(low, middle(s));
            high = glm::max(high, middle(s));
        }
        const int axis = longest(high - low);
        std::ranges::stable_sort(surfaces, {}, [&](SurfaceId s) { return middle(s)[axis]; });
        const std::size_t half = surfaces.size() / 2;
        PatchTree::Node node;
        node.first = static_cast<std::uint32_t>(tree_.order.size());
        node.left = add_surfaces(surfaces.first(half));
        node.right = add_surfaces(surfaces.subspan(half));
        node.last = static_cast<std::uint32_t>(tree_.order.size());
        node.hull = box_around(node.left, node.right);
        return add(std::move(node));
    }

    std::int32_t add_patches(std::span<PatchId> patches)
    {
        const SurfaceId surface = mesh_.surface(patches[0]);
        PatchTree::Node node;
        node.surface = surface;
        node.first = static_cast<std::uint32_t>(tree_.order.size());
        if (patches.size() <= leaf_size_) {
            tree_.order.insert(tree_.order.end(), patches.begin(), patches.end());
        } else {
            Vec3 low(1e300), high(-1e300);
            for (const PatchId p : patches) {
                low = glm::min(low, mesh_.centroid(p));
                high = glm::max(high, mesh_.centroid(p));
            }
            const int axis = longest(high - low);
            std::ranges::stable_sort(patches, {}, [&](PatchId p) { return mesh_.centroid(p)[axis]; });
            const std::size_t half = patches.size() / 2;
            node.left = add_patches(patches.first(half));
            node.right = add_patches(patches.subspan(half));
        }
        node.last = static_cast<std::uint32_t>(tree_.order.size());
        node.hull = rectangle_around(surface, patches);
        const bool leaf = node.is_leaf();
        const std::int32_t id = add(std::move(node));
        if (leaf) tree_.leaves.push_back(static_cast<std::uint32_t>(id));
        return id;
    }

    static int longest(const Vec3& extent)
    {
        if (extent.x >= extent.y && extent.x >= extent.z) return 0;
        return extent.y >= extent.z ? 1 : 2;
    }

    std::vector<Vec3> rectangle_around(SurfaceId surface, std::span<const PatchId> patches) const
    {
        const PlaneFrame& frame = scene_.surface(surface).frame;
        Vec2 low(1e300), high(-1e300);
        for (const PatchId p : patches)
            for (const VertexId v : mesh_.corners(p)) {
                low = glm::min(low, mesh_.plane_position(v));
                high = glm::max(high, mesh_.plane_position(v));
            }
        return {frame.lift(low), frame.lift({high.x, low.y}), frame.lift(high), frame.lift({low.x, high.y})};
    }

    std::vector<Vec3> box_around(std::int32_t left, std::int32_t right) const
    {
        Vec3 low(1e300), high(-1e300);
        for (const std::int32_t child : {left, right})
            for (const Vec3& p : tree_.nodes[static_cast<std::size_t>(child)].hull) {
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
        std::vector<Vec3> corners;
        for (int k = 0; k < 8; ++k)
            corners.emplace_back((k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y,
                                 (k & 4) != 0 ? high.z : low.z);
        return corners;
    }

    const Scene& scene_;
    const PatchMesh& mesh_;
    std::size_t leaf_size_;
    PatchTree tree_;
};

}  // namespace

PatchTree patch_tree(const Scene& scene, const PatchMesh& mesh, std::size_t leaf_size)
{
    return Builder(scene, mesh, leaf_size).build();
}

}  // namespace patchlight
