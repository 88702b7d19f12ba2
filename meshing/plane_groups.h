#pragma once

#include "meshing/edge_chains.h"
#include "meshing/polygon_soup.h"

#include <cstdint>
#include <vector>

namespace patchlight {

/// Faces of one plane that may touch one another, whichever way they face.
struct PlaneGroup {
    PlaneFrame frame;                  ///< n is the front of the largest face
    std::vector<std::uint32_t> faces;  ///< ascending
    /// Pieces of other faces' edges that lie in the plane or of lines in which faces cross it, and vertices that touch
    /// it: where something stands on it or passes through.
    std::vector<EdgeChains::Edge> contact_edges;
    std::vector<std::uint32_t> contact_vertices;
};

/// Groups faces whose corners all lie within the snapping distance of the plane of their group's largest face,
/// and that are linked by touching boxes. The largest faces choose first.
std::vector<PlaneGroup> make_plane_groups(const PolygonSoup& soup, const EdgeChains& chains);

}  // namespace patchlight
