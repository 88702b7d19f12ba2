#include "meshing/covered_parts.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace patchlight {

namespace {

/// What shows in a shell.
struct Shown {
    std::uint32_t plane;
    bool front;
    bool one_way = true;  ///< all in one plane, facing the same way
};

/// Of every shell with sides that aren't black.
std::map<std::uint32_t, Shown> shown_in_shells(const std::vector<PlaneArrangement>& planes, SpaceRegions& regions)
{
    std::map<std::uint32_t, Shown> result;
    std::uint32_t index = 0;
    for (std::uint32_t plane = 0; plane < planes.size(); ++plane) {
        for (const PlaneTriangle& t : planes[plane].triangles) {
            for (const bool front : {true, false}) {
                if ((front ? t.front : t.back) == PlaneTriangle::black) continue;
                Shown& shown = result.try_emplace(regions.shell(index, front), Shown{plane, front}).first->second;
                shown.one_way = shown.one_way && shown.plane == plane && shown.front == front;
            }
            ++index;
        }
    }
    return result;
}

bool reaches_over(const Box3& outer, const Box3& inner)
{
    return glm::all(glm::lessThanEqual(outer.low, inner.low)) && glm::all(glm::lessThanEqual(inner.high, outer.high));
}

/// Whether something that isn't black floats, or may float, in the region that the shell closes.
bool holds_free_pieces(std::uint32_t shell, const std::map<std::uint32_t, Shown>& shown, SpaceRegions& regions)
{
    return std::any_of(shown.begin(), shown.end(), [&](const auto& other) {
        if (other.first == shell || !reaches_over(regions.box(shell), regions.box(other.first))) return false;
        return regions.closing_shell(other.first) == shell || regions.gave_up();
    });
}

double area_of(const PlaneTriangle& t, const std::vector<Vec3>& vertices)
{
    const Vec3& a = vertices[t.vertices[0]];
    return 0.5 * glm::length(glm::cross(vertices[t.vertices[1]] - a, vertices[t.vertices[2]] - a));
}

}  // namespace

double blacken_covered_parts(std::vector<PlaneArrangement>& planes, const PolygonSoup& soup, SpaceRegions& regions)
{
    const std::map<std::uint32_t, Shown> shown = shown_in_shells(planes, regions);
    std::map<std::uint32_t, bool> covers;
    for (const auto& [shell, what] : shown) {
        covers[shell] = what.one_way && regions.closes(shell) && !holds_free_pieces(shell, shown, regions);
    }
    double area = 0;
    std::uint32_t index = 0;
    for (PlaneArrangement& plane : planes) {
        for (PlaneTriangle& t : plane.triangles) {
            for (const bool front : {true, false}) {
                std::uint32_t& face = front ? t.front : t.back;
                if (face == PlaneTriangle::black || !covers.at(regions.shell(index, front))) continue;
                face = PlaneTriangle::black;
                area += area_of(t, soup.vertices);
            }
            ++index;
        }
    }
    return area;
}

}  // namespace patchlight
