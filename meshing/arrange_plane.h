#pragma once

#include "meshing/edge_chains.h"
#include "meshing/plane_groups.h"
#include "meshing/polygon_soup.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace patchlight {

/// A triangle of a plane's arrangement, counter-clockwise seen from the group's normal.
struct PlaneTriangle {
    static constexpr std::uint32_t black = 0xffffffffU;

    std::array<std::uint32_t, 3> vertices{};
    std::uint32_t front = black;  ///< the face that shows on the normal's side
    std::uint32_t back = black;   ///< the face that shows on the other side
};

/// The pieces into which the edges of a group's faces, and all that touches its plane, cut it.
struct PlaneArrangement {
    std::vector<PlaneTriangle> triangles;                           ///< those that some face covers, sorted by vertices
    std::vector<std::pair<std::uint32_t, std::uint32_t>> overlaps;  ///< pairs of faces on the same side of one triangle
    std::vector<std::uint32_t> self_crossing;  ///< faces that wind round some point the wrong way, or twice
};

/// Arranges a group's faces: a constrained Delaunay triangulation of all split edges; each triangle shows, on
/// either side, the face with the smallest rank of those that wind round it. May append vertices to the soup
/// where edges cross within the snapping distance of one another.
PlaneArrangement arrange_plane(const PlaneGroup& group, const EdgeChains& chains,
                               const std::vector<std::uint32_t>& rank, PolygonSoup& soup);

/// Who wins where faces of the same side overlap: emitters, then the smaller face, then the earlier in the soup.
std::vector<std::uint32_t> rank_faces(const PolygonSoup& soup);

}  // namespace patchlight
