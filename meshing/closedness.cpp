#include "meshing/closedness.h"

#include <algorithm>
#include <utility>

namespace patchlight {

SpaceRegions regions_of(const std::vector<PlaneArrangement>& planes, const PolygonSoup& soup)
{
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const PlaneArrangement& plane : planes) {
        for (const PlaneTriangle& t : plane.triangles) triangles.push_back(t.vertices);
    }
    return {soup.vertices, std::move(triangles), soup.diameter};
}

bool is_closed(const std::vector<PlaneArrangement>& planes, const PolygonSoup& soup, SpaceRegions& regions)
{
    const auto emits = [&](std::uint32_t face) {
        return face != PlaneTriangle::black && soup.materials[soup.faces[face].material.value].emits();
    };
    const bool lit = std::any_of(planes.begin(), planes.end(), [&](const PlaneArrangement& plane) {
        return std::any_of(plane.triangles.begin(), plane.triangles.end(),
                           [&](const PlaneTriangle& t) { return emits(t.front) || emits(t.back); });
    });
    std::uint32_t index = 0;
    for (const PlaneArrangement& plane : planes) {
        for (const PlaneTriangle& t : plane.triangles) {
            for (const bool front : {true, false}) {
                const std::uint32_t face = front ? t.front : t.back;
                if (lit ? !emits(face) : face == PlaneTriangle::black) continue;
                if (!regions.closing_shell(regions.shell(index, front))) return false;
            }
            ++index;
        }
    }
    return true;
}

}  // namespace patchlight
