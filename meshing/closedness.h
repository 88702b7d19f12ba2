#pragma once

#include "meshing/arrange_plane.h"
#include "meshing/polygon_soup.h"
#include "meshing/space_regions.h"

#include <vector>

namespace patchlight {

/// The regions of all planes' triangles, these in the planes' order. The soup must outlive them.
SpaceRegions regions_of(const std::vector<PlaneArrangement>& planes, const PolygonSoup& soup);

/// Whether no light can escape: every region of space that an emitter shines into is enclosed (without emitters:
/// that any front faces). A block's bottom that presses on the floor faces out of the room, but no light gets there.
/// Faces that cross divide each other, so a sunk block encloses as a standing one does. With very many free pieces
/// (see SpaceRegions) the answer is no.
bool is_closed(const std::vector<PlaneArrangement>& planes, const PolygonSoup& soup, SpaceRegions& regions);

}  // namespace patchlight
