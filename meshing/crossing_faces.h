#pragma once

#include "meshing/polygon_soup.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace patchlight {

/// A piece of the line in which two faces pass through each other.
struct CrossingSegment {
    std::pair<std::uint32_t, std::uint32_t> ends;  ///< of the soup's vertices, ascending
    std::array<std::uint32_t, 2> faces{};
};

/// The segments that lie inside both faces of a pair, further than the snapping distance from their borders, sorted.
/// Both faces must have corners on either side of the other's plane, so touching isn't crossing. Ends are where an
/// edge of one face meets the other's plane: welded with the vertices and one another, else appended to
/// soup.vertices; coordinates that the plane or the edge hold fixed are theirs. Counts the pairs in the report.
std::vector<CrossingSegment> crossing_segments(PolygonSoup& soup, SceneReport& report);

}  // namespace patchlight
