#pragma once

#include "meshing/patch_mesh.h"
#include "meshing/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace patchlight {

/// A binary tree over all patches of a mesh, for light between groups instead of patches: its leaves are single
/// patches, above them halves of one surface, above these clusters of surfaces that face about the same way, at the top
/// those that don't. Splits that tell directions apart come first: then one irradiance fits a cluster's patches about
/// as well as a plane's [SmitsArvoGreenberg94]. Surfaces much larger than the others of a cluster leave it first, the
/// rest is halved at the median of the longest axis; a surface's patches likewise in its plane. Flat arrays, children
/// before their parents: a loop upwards over `nodes` pulls, one downwards pushes.
struct PatchHierarchy {
    struct Node {
        Vec3 low{0.0}, high{0.0};            ///< box around it
        Vec3 axis{0.0};                      ///< unit, mean normal by area
        double spread = 0;                   ///< no normal differs from the axis by more than this; 0: all parallel
        double least = 0, most = 0;          ///< no point has dot(axis, p) outside of this
        Vec2 corner{0.0}, size{0.0};         ///< of one surface: a rectangle around it in the surface's frame
        double area = 0;                     ///< m²
        std::uint32_t first = 0, last = 0;   ///< range of `order`
        std::int32_t left = -1, right = -1;  ///< children; −1 in a leaf
        SurfaceId surface;                   ///< invalid where several are in it
        bool is_leaf() const { return left < 0; }
        double diameter() const { return glm::length(high - low); }
    };

    std::vector<PatchId> order;     ///< patches, those of a node together and near ones near
    std::vector<double> area_upto;  ///< m², of the patches before each in `order`, and of all
    std::vector<Node> nodes;        ///< the root is the last; none without patches

    std::uint32_t root() const { return static_cast<std::uint32_t>(nodes.size()) - 1; }
};

/// O(n log n). `lit`, if given, by surface: the others share no node with them but the root, so that what is lit lends
/// them no light of its own.
PatchHierarchy patch_hierarchy(const Scene& scene, const PatchMesh& mesh, std::span<const std::uint8_t> lit = {});

/// The rectangle of a node of one surface; for a leaf its patch.
void node_hull(const Scene& scene, const PatchMesh& mesh, const PatchHierarchy& tree, std::uint32_t node,
               std::vector<Vec3>& corners);

/// Whether light can go between two nodes as far as their planes tell: false only when all of one is behind, or within
/// `snap` (m) of, the planes of all of the other. Symmetric.
bool may_face(const PatchHierarchy::Node& p, const PatchHierarchy::Node& q, double snap);

/// An upper bound of the mean kernel cos cos'/(π r²) between two nodes, 1/m²: by the distance of their boxes, the
/// cosines that their axes allow, and because neither sends out more light than it has. Symmetric.
double greatest_kernel(const PatchHierarchy::Node& p, const PatchHierarchy::Node& q);

}  // namespace patchlight
