#pragma once

#include "meshing/arrange_plane.h"
#include "meshing/polygon_soup.h"
#include "meshing/space_regions.h"

#include <vector>

namespace patchlight {

/// Makes covered triangle sides black: those from which every ray meets nothing but backs, such as the floor inside
/// a standing solid. That is so where their region of space is closed and its sides that aren't black all lie in one
/// plane and face the same way; any other thing that floats in it, as a lamp would, uncovers them. So a solid in a
/// room's corner, whose floor and walls see one another inside it, covers nothing. Returns the area, m².
/// `regions` are those of the planes' triangles.
double blacken_covered_parts(std::vector<PlaneArrangement>& planes, const PolygonSoup& soup, SpaceRegions& regions);

}  // namespace patchlight
