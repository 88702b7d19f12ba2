#include "meshing/crossing_faces.h"

#include "meshing/box_pairs.h"
#include "meshing/plane_frame.h"

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

/// Whether the loop winds round q, and keeps further than `margin` from it.
bool well_inside(const Vec2& q, const std::vector<Vec2>& loop, double margin)
{
    int winding = 0;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec2 &a = loop[k], &b = loop[(k + 1) % loop.size()];
        const Vec2 d = b - a;
        const double t = std::clamp(glm::dot(q - a, d) / glm::dot(d, d), 0.0, 1.0);
        if (glm::distance(q, a + t * d) <= margin) return false;
        if (a.y <= q.y && b.y > q.y && cross2(a, b, q) > 0) ++winding;
        if (a.y > q.y && b.y <= q.y && cross2(a, b, q) < 0) --winding;
    }
    return winding != 0;
}

bool pierces(const SoupFace& needle, const SoupFace& sheet, const PolygonSoup& soup)
{
    const Vec3& origin = soup.vertices[sheet.loop[0]];
    std::vector<double> heights;
    bool above = false, below = false;
    for (const std::uint32_t v : needle.loop) {
        heights.push_back(glm::dot(soup.vertices[v] - origin, sheet.normal));
        above = above || heights.back() > soup.snap;
        below = below || heights.back() < -soup.snap;
    }
    if (!above || !below) return false;
    const PlaneFrame frame = frame_with_normal(origin, sheet.normal, soup.vertices[sheet.loop[1]] - origin);
    std::vector<Vec2> loop;
    for (const std::uint32_t v : sheet.loop) loop.push_back(frame.to_plane(soup.vertices[v]));
    for (std::size_t k = 0; k < heights.size(); ++k) {
        const std::size_t next = (k + 1) % heights.size();
        if (!(std::min(heights[k], heights[next]) < -soup.snap && std::max(heights[k], heights[next]) > soup.snap))
            continue;
        const Vec3 &a = soup.vertices[needle.loop[k]], &b = soup.vertices[needle.loop[next]];
        const Vec3 point = a + heights[k] / (heights[k] - heights[next]) * (b - a);
        if (well_inside(frame.to_plane(point), loop, soup.snap)) return true;
    }
    return false;
}

}  // namespace

std::size_t count_crossing_faces(const PolygonSoup& soup)
{
    std::vector<Box3> boxes;
    for (const SoupFace& face : soup.faces) boxes.push_back(Box3::around(face.loop, soup.vertices, 0));
    std::size_t count = 0;
    touching_pairs(boxes, [&](std::uint32_t i, std::uint32_t k) {
        const SoupFace &a = soup.faces[i], &b = soup.faces[k];
        if (pierces(a, b, soup) || pierces(b, a, soup)) ++count;
        return false;
    });
    return count;
}

}  // namespace patchlight
