#include "meshing/crossing_faces.h"

#include "meshing/box_pairs.h"
#include "meshing/plane_frame.h"
#include "meshing/vertex_grid.h"

#include <algorithm>
#include <cmath>
#include <tuple>

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

bool well_inside(const Vec3& p, const SoupFace& face, const PolygonSoup& soup)
{
    const Vec3& origin = soup.vertices[face.loop[0]];
    const PlaneFrame frame = frame_with_normal(origin, face.normal, soup.vertices[face.loop[1]] - origin);
    std::vector<Vec2> loop;
    for (const std::uint32_t v : face.loop) loop.push_back(frame.to_plane(soup.vertices[v]));
    return well_inside(frame.to_plane(p), loop, soup.snap);
}

/// Of a face's corners over a plane; within the snapping distance they are in it.
std::vector<double> heights_over(const SoupFace& sheet, const SoupFace& needle, const PolygonSoup& soup)
{
    std::vector<double> heights;
    for (const std::uint32_t v : needle.loop) {
        const double height = glm::dot(soup.vertices[v] - soup.vertices[sheet.loop[0]], sheet.normal);
        heights.push_back(std::abs(height) <= soup.snap ? 0 : height);
    }
    return heights;
}

bool on_both_sides(const std::vector<double>& heights)
{
    const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
    return *low < 0 && *high > 0;
}

/// Where the border of a face meets the plane of another.
struct Meeting {
    double along;  ///< the planes' common line
    bool corner;
    Vec3 point;
    auto key() const { return std::tuple(along, !corner, point.x, point.y, point.z); }
};

void add_meetings(const SoupFace& needle, const std::vector<double>& heights, const SoupFace& sheet,
                  const PolygonSoup& soup, const Vec3& direction, std::vector<Meeting>& meetings)
{
    const Vec3& origin = soup.vertices[sheet.loop[0]];
    for (std::size_t k = 0; k < heights.size(); ++k) {
        const std::size_t next = (k + 1) % heights.size();
        const Vec3& corner = soup.vertices[needle.loop[k]];
        if (heights[k] == 0) meetings.push_back({glm::dot(corner, direction), true, corner});
        if (!(heights[k] * heights[next] < 0)) continue;
        // Whichever way a loop runs along the edge, the point is the same to the bit.
        const bool ascending = needle.loop[k] < needle.loop[next];
        const std::size_t low = ascending ? k : next, high = ascending ? next : k;
        const Vec3 &a = soup.vertices[needle.loop[low]], &b = soup.vertices[needle.loop[high]];
        Vec3 point = a + heights[low] / (heights[low] - heights[high]) * (b - a);
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(sheet.normal[axis]) == 1) point[axis] = origin[axis];
        }
        meetings.push_back({glm::dot(point, direction), false, point});
    }
}

struct Found {
    Vec3 start, end;
    std::array<std::uint32_t, 2> faces;
};

void find_segments(std::uint32_t first, std::uint32_t second, const PolygonSoup& soup, std::vector<Found>& found)
{
    const SoupFace &a = soup.faces[first], &b = soup.faces[second];
    const std::vector<double> a_heights = heights_over(b, a, soup);
    if (!on_both_sides(a_heights)) return;
    const std::vector<double> b_heights = heights_over(a, b, soup);
    if (!on_both_sides(b_heights)) return;
    const Vec3 across = glm::cross(a.normal, b.normal);
    if (!(glm::length(across) > 1e-12)) return;
    std::vector<Meeting> meetings;
    add_meetings(a, a_heights, b, soup, glm::normalize(across), meetings);
    add_meetings(b, b_heights, a, soup, glm::normalize(across), meetings);
    std::sort(meetings.begin(), meetings.end(), [](const Meeting& m, const Meeting& n) { return m.key() < n.key(); });
    for (std::size_t k = 0; k + 1 < meetings.size(); ++k) {
        const Vec3 &p = meetings[k].point, &q = meetings[k + 1].point;
        if (meetings[k + 1].along - meetings[k].along <= soup.snap) continue;
        const Vec3 middle = 0.5 * (p + q);
        if (well_inside(middle, a, soup) && well_inside(middle, b, soup)) found.push_back({p, q, {first, second}});
    }
}

}  // namespace

std::vector<CrossingSegment> crossing_segments(PolygonSoup& soup, SceneReport& report)
{
    std::vector<Box3> boxes;
    for (const SoupFace& face : soup.faces) boxes.push_back(Box3::around(face.loop, soup.vertices, 0));
    std::vector<Found> found;
    const auto crossing = touching_pairs(boxes, [&](std::uint32_t i, std::uint32_t k) {
        const std::size_t before = found.size();
        find_segments(i, k, soup, found);
        return found.size() > before;
    });
    report.crossing_faces = crossing.size();
    std::vector<Vec3> points;
    for (const Found& f : found) points.insert(points.end(), {f.start, f.end});
    const std::vector<std::uint32_t> welded = weld_points(points, soup.snap, soup.vertices);
    std::vector<CrossingSegment> segments;
    for (std::size_t k = 0; k < found.size(); ++k) {
        const std::uint32_t start = welded[2 * k], end = welded[2 * k + 1];
        if (start != end) segments.push_back({std::minmax(start, end), found[k].faces});
    }
    std::sort(segments.begin(), segments.end(), [](const CrossingSegment& a, const CrossingSegment& b) {
        return std::tie(a.ends, a.faces) < std::tie(b.ends, b.faces);
    });
    return segments;
}

}  // namespace patchlight
