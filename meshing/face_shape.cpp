#include "meshing/face_shape.h"

#include "meshing/plane_frame.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace patchlight {

namespace {

/// The loop turned so that it starts at `start`.
std::vector<std::uint32_t> turned(const std::vector<std::uint32_t>& loop, std::size_t start)
{
    std::vector<std::uint32_t> result(loop.begin() + static_cast<std::ptrdiff_t>(start), loop.end());
    result.insert(result.end(), loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(start));
    return result;
}

std::uint32_t farthest_from(const Vec3& p, const std::vector<std::uint32_t>& loop, const std::vector<Vec3>& vertices)
{
    return *std::max_element(loop.begin(), loop.end(), [&](std::uint32_t a, std::uint32_t b) {
        return glm::distance(vertices[a], p) < glm::distance(vertices[b], p);
    });
}

/// Newell's sum, about a corner so that far-away polygons lose no digits: twice the area times the normal.
Vec3 area_vector(const std::vector<std::uint32_t>& loop, const std::vector<Vec3>& vertices)
{
    Vec3 sum{0.0};
    const Vec3& origin = vertices[loop[0]];
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
        sum += glm::cross(vertices[loop[k]] - origin, vertices[loop[k + 1]] - origin);
    }
    return sum;
}

using Corners = std::vector<std::uint32_t>;
using Triangle = std::array<std::uint32_t, 3>;

/// Whether corner k of `rest` (indices into `at`) can be cut off.
bool is_ear(const Corners& rest, std::size_t k, const std::vector<Vec2>& at)
{
    const std::size_t n = rest.size();
    const std::uint32_t a = rest[(k + n - 1) % n], b = rest[k], c = rest[(k + 1) % n];
    if (cross2(at[a], at[b], at[c]) <= 0) return false;
    return std::none_of(rest.begin(), rest.end(), [&](std::uint32_t p) {
        if (p == a || p == b || p == c) return false;
        return cross2(at[a], at[b], at[p]) >= 0 && cross2(at[b], at[c], at[p]) >= 0 && cross2(at[c], at[a], at[p]) >= 0;
    });
}

std::vector<Triangle> cut_quadrilateral(const std::vector<Vec2>& at)
{
    const auto fits = [&](const Triangle& t) { return cross2(at[t[0]], at[t[1]], at[t[2]]) > 0; };
    const std::vector<Triangle> one{{0, 1, 2}, {0, 2, 3}}, other{{0, 1, 3}, {1, 2, 3}};
    const bool one_fits = fits(one[0]) && fits(one[1]), other_fits = fits(other[0]) && fits(other[1]);
    if (one_fits != other_fits) return one_fits ? one : other;
    return glm::distance(at[0], at[2]) <= glm::distance(at[1], at[3]) ? one : other;
}

std::vector<Triangle> cut_ears(const std::vector<Vec2>& at)
{
    std::vector<Triangle> triangles;
    Corners rest(at.size());
    std::iota(rest.begin(), rest.end(), 0U);
    while (rest.size() > 3) {
        std::size_t ear = 1;  // where there is none, the polygon crosses itself: any corner will do
        for (std::size_t k = 0; k < rest.size(); ++k) {
            if (is_ear(rest, k, at)) {
                ear = k;
                break;
            }
        }
        const std::size_t n = rest.size();
        triangles.push_back({rest[(ear + n - 1) % n], rest[ear], rest[(ear + 1) % n]});
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back({rest[0], rest[1], rest[2]});
    return triangles;
}

}  // namespace

std::vector<std::uint32_t> canonical_loop(std::vector<std::uint32_t> loop)
{
    std::vector<std::uint32_t> clean;
    for (const std::uint32_t v : loop) {
        if (!clean.empty() && clean.back() == v) continue;
        if (clean.size() > 1 && clean[clean.size() - 2] == v) {
            clean.pop_back();
            continue;
        }
        clean.push_back(v);
    }
    const auto trims = [&] {
        const std::size_t n = clean.size();
        return n > 1 && (clean.front() == clean.back() || (n > 2 && clean[1] == clean.back()) ||
                         (n > 2 && clean[n - 2] == clean.front()));
    };
    while (trims()) {
        const bool spike_at_front = clean.front() != clean.back() && clean[1] == clean.back();
        if (spike_at_front) {
            clean.erase(clean.begin());
        } else {
            clean.pop_back();
        }
    }
    if (clean.empty()) return clean;
    const std::uint32_t smallest = *std::min_element(clean.begin(), clean.end());
    std::vector<std::uint32_t> best;
    for (std::size_t k = 0; k < clean.size(); ++k) {
        if (clean[k] != smallest) continue;
        std::vector<std::uint32_t> candidate = turned(clean, k);
        if (best.empty() || candidate < best) best = std::move(candidate);
    }
    return best;
}

FaceShape shape_of(const std::vector<std::uint32_t>& loop, const std::vector<Vec3>& vertices)
{
    FaceShape shape;
    if (loop.size() < 3) return shape;
    const Vec3& a = vertices[farthest_from(vertices[loop[0]], loop, vertices)];
    const Vec3& b = vertices[farthest_from(a, loop, vertices)];
    shape.length = glm::distance(a, b);
    if (!(shape.length > 0)) return shape;
    const Vec3 along = (b - a) / shape.length;
    Vec3 across{0.0};
    for (const std::uint32_t v : loop) {
        const Vec3 off = vertices[v] - a - glm::dot(vertices[v] - a, along) * along;
        if (glm::length(off) > glm::length(across)) across = off;
    }
    shape.width = glm::length(across);
    if (!(shape.width > 0)) return shape;
    Vec3 twice_area = area_vector(loop, vertices);
    shape.area = 0.5 * glm::length(twice_area);
    // A bow tie's halves cancel: its plane comes from its extents, its front from the half at its first corner.
    if (shape.area < 1e-6 * shape.length * shape.width) {
        const Vec3& v0 = vertices[loop[0]];
        const Vec3 corner = glm::cross(vertices[loop[1]] - v0, vertices[loop.back()] - v0);
        twice_area = glm::cross(along, across);
        if (glm::dot(twice_area, corner) < 0) twice_area = -twice_area;
    }
    shape.normal = cleaned_normal(glm::normalize(twice_area));
    double low = 0, high = 0;
    for (const std::uint32_t v : loop) {
        const double height = glm::dot(vertices[v] - vertices[loop[0]], shape.normal);
        low = std::min(low, height);
        high = std::max(high, height);
    }
    shape.out_of_plane = 0.5 * (high - low);
    return shape;
}

std::vector<std::array<std::uint32_t, 3>> cut_into_triangles(const std::vector<std::uint32_t>& loop,
                                                             const std::vector<Vec3>& vertices, const Vec3& normal)
{
    const PlaneFrame frame = frame_with_normal(vertices[loop[0]], normal, vertices[loop[1]] - vertices[loop[0]]);
    std::vector<Vec2> at;
    for (const std::uint32_t v : loop) at.push_back(frame.to_plane(vertices[v]));
    std::vector<Triangle> triangles = loop.size() == 4 ? cut_quadrilateral(at) : cut_ears(at);
    for (Triangle& triangle : triangles) {
        for (std::uint32_t& corner : triangle) corner = loop[corner];
    }
    return triangles;
}

}  // namespace patchlight
