#pragma once

#include "meshing/arrange_plane.h"
#include "meshing/plane_groups.h"
#include "meshing/polygon_soup.h"
#include "meshing/space_regions.h"

#include <array>
#include <cstdint>
#include <vector>

namespace patchlight {

/// The surfaces of one plane: triangles of equal material (and object, when objects don't join) on one side that hang
/// together by edges and face the same space: a floor that two sealed rooms share is two surfaces. What is narrower
/// than the snapping distance, in the mean, is no surface: its triangles are black there.
struct PlaneSurfaces {
    std::vector<Surface> surfaces;         ///< loops index the soup's vertices
    std::vector<SceneTriangle> triangles;  ///< of the arrangement; front and back index `surfaces`
};

/// `regions` are those of all planes' triangles, of which this plane's begin with `first`.
PlaneSurfaces join_surfaces(const PlaneGroup& group, const PlaneArrangement& arrangement, const PolygonSoup& soup,
                            SpaceRegions& regions, std::uint32_t first, bool join_objects);

}  // namespace patchlight
