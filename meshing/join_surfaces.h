#pragma once

#include "meshing/arrange_plane.h"
#include "meshing/plane_groups.h"
#include "meshing/polygon_soup.h"

#include <array>
#include <cstdint>
#include <vector>

namespace patchlight {

/// The surfaces of one plane: triangles of equal material (and object, when objects don't join) on one side that hang
/// together by edges.
struct PlaneSurfaces {
    std::vector<Surface> surfaces;         ///< loops index the soup's vertices
    std::vector<SceneTriangle> triangles;  ///< of the arrangement; front and back index `surfaces`
};

PlaneSurfaces join_surfaces(const PlaneGroup& group, const PlaneArrangement& arrangement, const PolygonSoup& soup,
                            bool join_objects);

}  // namespace patchlight
