#pragma once

#include "meshing/polygon_soup.h"

#include <cstddef>

namespace patchlight {

/// How many pairs of faces pierce each other: an edge of one passes through the other's inside, further than
/// the snapping distance from its border. Piercing faces are left as they are; rays see them rightly.
std::size_t count_crossing_faces(const PolygonSoup& soup);

}  // namespace patchlight
