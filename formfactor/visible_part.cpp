#include "formfactor/visible_part.h"

#include "meshing/positive_part.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace patchlight {

namespace {

/// Heights below this part of the sizes that they are products of are rounding.
constexpr double rounding = 4e-15;
/// A smaller part of a polygon isn't seen.
constexpr double least_visible = 1e-12;

/// A size that costs no root.
double size(const Vec3& p)
{
    return std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
}

/// Over the plane through the origin with the normal m, of any length.
double height_over(const Vec3& m, double size_m, const Vec3& p)
{
    const double h = glm::dot(m, p);
    return std::abs(h) <= rounding * size_m * size(p) ? 0.0 : h;
}

/// −2π times the part of Lambert's formula that the piece makes; its corners are relative to the point.
double contour(const Polygon& piece, const Vec3& n)
{
    double sum = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
        const Vec3 &a = piece[i], &b = piece[i + 1 < piece.size() ? i + 1 : 0];
        const Vec3 c = glm::cross(a, b);
        const double length = std::sqrt(glm::dot(c, c));
        if (length > 0) sum += std::atan2(length, glm::dot(a, b)) * glm::dot(n, c) / length;
    }
    return sum;
}

/// The plane of a blocker's cone from x through its edge k, the normal inwards; 0 for an edge seen end on.
Vec3 cone_plane(const Vec3& x, const BlockerView& blocker, double height, std::size_t k)
{
    const Vec3 a = blocker.corners[k] - x, b = blocker.corners[k + 1 < blocker.corners.size() ? k + 1 : 0] - x;
    // Seen from its front a blocker runs counter-clockwise.
    const Vec3 m = height > 0 ? glm::cross(b, a) : glm::cross(a, b);
    return size(m) > 1e-15 * size(a) * size(b) ? m : Vec3(0.0);
}

/// Whether a plane leaves the whole polygon outside or on it.
bool is_outside(const Polygon& polygon, const Vec3& m)
{
    const double size_m = size(m);
    if (size_m == 0) return false;
    for (const Vec3& p : polygon)
        if (height_over(m, size_m, p) > 0) return false;
    return true;
}

void cone_planes(const Vec3& x, const BlockerView& blocker, double height, std::vector<Vec3>& planes)
{
    planes.clear();
    for (std::size_t k = 0; k < blocker.corners.size(); ++k)
        if (const Vec3 m = cone_plane(x, blocker, height, k); m != Vec3(0.0)) planes.push_back(m);
}

/// heights[k·corners + i]: of corner i over plane k. The first plane that has the whole piece outside, else their
/// number.
std::size_t parting_plane(const Polygon& piece, const std::vector<Vec3>& planes, std::vector<double>& heights)
{
    heights.resize(planes.size() * piece.size());
    double* h = heights.data();
    for (std::size_t k = 0; k < planes.size(); ++k) {
        double most = 0;
        const double size_m = size(planes[k]);
        for (const Vec3& p : piece) {
            *h = height_over(planes[k], size_m, p);
            most = std::max(most, *h++);
        }
        if (most <= 0) return k;
    }
    return planes.size();
}

/// Cuts the piece at one plane: what is inside stays, what is outside goes to `visible`.
void split(Polygon& piece, const Vec3& m, std::vector<Polygon>& visible)
{
    Polygon inside, outside;
    const double size_m = size(m);
    Vec3 last = piece.back();
    double last_height = height_over(m, size_m, last);
    for (const Vec3& p : piece) {
        const double h = height_over(m, size_m, p);
        if ((h > 0 && last_height < 0) || (h < 0 && last_height > 0)) {
            const Vec3 crossing = last + (last_height / (last_height - h)) * (p - last);
            inside.push_back(crossing);
            outside.push_back(crossing);
        }
        if (h >= 0) inside.push_back(p);
        if (h <= 0) outside.push_back(p);
        last = p;
        last_height = h;
    }
    if (outside.size() >= 3) visible.emplace_back().swap(outside);
    piece.swap(inside);
}

/// What of the pieces is outside the cone, into `next`. `edge`: the plane that parts a single piece from the cone.
void take_away(VisibleScratch& scratch, std::uint32_t& edge)
{
    scratch.next.clear();
    for (Polygon& piece : scratch.pieces) {
        const std::size_t parting = parting_plane(piece, scratch.planes, scratch.heights);
        if (parting < scratch.planes.size()) {
            if (scratch.pieces.size() == 1) {
                edge = static_cast<std::uint32_t>(parting);
                return;
            }
            scratch.next.emplace_back().swap(piece);
            continue;
        }
        scratch.cut = true;
        const std::size_t corners = piece.size();
        for (std::size_t k = 0; k < scratch.planes.size() && piece.size() >= 3; ++k) {
            const double* h = scratch.heights.data() + k * corners;
            if (std::all_of(h, h + corners, [](double x) { return x >= 0; })) continue;
            split(piece, scratch.planes[k], scratch.next);
        }
    }
    std::swap(scratch.pieces, scratch.next);
}

/// Whether some plane has the whole polygon outside; tells many pieces at once.
bool is_beside(const Polygon& whole, const std::vector<Vec3>& planes, std::uint32_t& edge)
{
    for (std::uint32_t k = 0; k < planes.size(); ++k)
        if (is_outside(whole, planes[k])) {
            edge = k;
            return true;
        }
    return false;
}

}  // namespace

double visible_factor(const Vec3& x, const Vec3& n, std::span<const Vec3> polygon,
                      std::span<const BlockerView> blockers, VisibleScratch& scratch)
{
    scratch.cut = false;
    scratch.whole.clear();
    for (const Vec3& p : polygon) scratch.whole.push_back(p - x);
    scratch.pieces.assign(1, scratch.whole);
    if (scratch.last_edges.size() < blockers.size()) scratch.last_edges.resize(blockers.size(), 0);
    for (std::size_t k = 0; k < blockers.size(); ++k) {
        const BlockerView& blocker = blockers[k];
        const double height = glm::dot(blocker.normal, x) - blocker.offset;
        if (height == 0) continue;
        std::uint32_t& edge = scratch.last_edges[k];
        if (edge < blocker.corners.size() && is_outside(scratch.whole, cone_plane(x, blocker, height, edge))) continue;
        cone_planes(x, blocker, height, scratch.planes);
        if (scratch.pieces.size() > 1 && is_beside(scratch.whole, scratch.planes, edge)) continue;
        take_away(scratch, edge);
        if (scratch.pieces.empty()) return 0;
    }
    double sum = 0;
    for (const Polygon& piece : scratch.pieces) sum += contour(piece, n);
    // What is left of a polygon that is hidden, where rounding puts two edges of blockers beside each other.
    if (scratch.cut && -sum < least_visible && sum >= least_visible * contour(scratch.whole, n)) return 0;
    return positive_part(-sum / (2 * std::numbers::pi));
}

namespace {

struct Measure {
    double radius = 0;     ///< squared, about the middle of the corners
    double clearance = 0;  ///< squared distance from there to the nearest blocker's rim

    Measure(std::span<const Vec3> polygon, std::span<const BlockerView> blockers)
        : clearance(std::numeric_limits<double>::infinity())
    {
        Vec3 middle(0.0);
        for (const Vec3& p : polygon) middle += p / static_cast<double>(polygon.size());
        for (const Vec3& p : polygon) radius = std::max(radius, glm::dot(p - middle, p - middle));
        for (const BlockerView& blocker : blockers)
            clearance = std::min(clearance, squared_distance_to_rim(middle, blocker.corners));
    }
};

}  // namespace

bool is_second_outer(std::span<const Vec3> first, std::span<const Vec3> second, std::span<const BlockerView> blockers)
{
    constexpr double much = 9;  // of squares
    const Measure a(first, blockers), b(second, blockers);
    if (a.radius > much * b.radius) return true;
    if (b.radius > much * a.radius) return false;
    return a.clearance != b.clearance ? a.clearance < b.clearance : precedes(second, first);
}

}  // namespace patchlight
