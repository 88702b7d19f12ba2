#include "formfactor/hemicube.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace patchlight {

namespace {

constexpr std::uint32_t back_bit = 0x80000000U;
constexpr std::uint32_t nothing = 0xffffffffU;

/// Pixels whose centres lie in [x, …) start here, and those in […, x) end here.
std::size_t first_centre(double x, std::size_t count)
{
    return static_cast<std::size_t>(static_cast<std::int64_t>(std::clamp(x + 0.5, 0.0, static_cast<double>(count))));
}

/// Column by column in double: a plane's depth in a pixel then depends on the plane alone, so that triangles of one
/// plane tie however they are cut. Without branches: the compiler vectorises it.
void paint_span(double base, double step, float low, float high, std::uint32_t key, int first, int last,
                float* __restrict depths, std::uint32_t* __restrict keys)
{
    for (int i = first; i < last; ++i) {
        const float depth = std::min(std::max(static_cast<float>(base + step * i), low), high);
        const bool wins = (depth > depths[i]) | ((depth == depths[i]) & (key < keys[i]));
        depths[i] = wins ? depth : depths[i];
        keys[i] = wins ? key : keys[i];
    }
}

}  // namespace

/// Which of the coordinates (x, y, z) about the turned frame are a, b and w.
struct Hemicube::Face {
    glm::length_t a, b, w;
    double sign;       ///< of w
    double below;      ///< b/w starts at −below: 1 on the top, 0 on a side
    std::size_t row0;  ///< of all rows, in halves of the resolution
};

const std::array<Hemicube::Face, 5>& Hemicube::faces()
{
    static constexpr std::array<Face, 5> all{
        {{0, 1, 2, 1, 1, 0}, {1, 2, 0, 1, 0, 2}, {1, 2, 0, -1, 0, 3}, {0, 2, 1, 1, 0, 4}, {0, 2, 1, -1, 0, 5}}};
    return all;
}

double HemicubeSums::total() const
{
    return std::accumulate(factors.begin(), factors.end(), 0.0) + escaped + backs;
}

Hemicube::Hemicube(int resolution)
{
    if (resolution < 4 || resolution > 4096 || resolution % 2 != 0)
        throw std::invalid_argument("a hemicube's resolution must be even, 4 … 4096");
    resolution_ = static_cast<std::size_t>(resolution);
    keys_.assign(pixels(), nothing);
    depths_.assign(pixels(), 0.0F);
    left_.resize(resolution_);
    right_.resize(resolution_);
    for (std::size_t row = 0; row < 3 * resolution_ / 2; ++row) {
        row_factors_.push_back(0);
        for (std::size_t column = 0; column < resolution_; ++column)
            row_factors_.push_back(row_factors_.back() + factor(row * resolution_ + column));
    }
}

void Hemicube::render(std::span<const HemicubeTriangle> triangles, const PlaneFrame& frame, double turn)
{
    const double near = 1e-9 * checked_extent(triangles, frame.origin);
    u_ = std::cos(turn) * frame.u + std::sin(turn) * frame.v;
    v_ = std::cos(turn) * frame.v - std::sin(turn) * frame.u;
    n_ = frame.n;
    std::ranges::fill(keys_, nothing);
    std::ranges::fill(depths_, 0.0F);
    for (const HemicubeTriangle& triangle : triangles) {
        std::array<Vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 p = triangle.corners[k] - frame.origin;
            corners[k] = {glm::dot(p, u_), glm::dot(p, v_), glm::dot(p, n_)};
        }
        if (corners[0].z > 0 || corners[1].z > 0 || corners[2].z > 0) project(corners, triangle.item, near);
    }
}

/// The farthest corner's distance from the origin (the sum of coordinates); notes how many items there may be.
double Hemicube::checked_extent(std::span<const HemicubeTriangle> triangles, const Vec3& origin)
{
    double extent = 0;
    std::uint32_t highest = 0;
    for (const HemicubeTriangle& triangle : triangles) {
        highest = std::max(highest, triangle.item);
        for (const Vec3& corner : triangle.corners) {
            const Vec3 p = corner - origin;
            const double size = std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
            if (!(size < std::numeric_limits<double>::infinity()))
                throw std::invalid_argument("a hemicube's triangles must be finite");
            extent = std::max(extent, size);
        }
    }
    if (highest > max_item) throw std::invalid_argument("a hemicube's items must be below 2147483646");
    items_ = triangles.empty() ? 0 : std::size_t{highest} + 1;
    return extent;
}

void Hemicube::project(const std::array<Vec3, 3>& corners, std::uint32_t item, double near)
{
    // From the same corner whatever the order: a triangle and its reverse have one plane to the bit.
    std::size_t k = 0;
    for (const std::size_t j : {std::size_t{1}, std::size_t{2}})
        if (std::tie(corners[j].x, corners[j].y, corners[j].z) < std::tie(corners[k].x, corners[k].y, corners[k].z))
            k = j;
    const Vec3 normal = glm::cross(corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
    const double distance = glm::dot(normal, corners[k]);
    if (distance == 0) return;
    const std::uint32_t key = distance < 0 ? item : item | back_bit;
    const Vec3 plane = normal / distance;
    for (const Face& face : faces()) {
        Polygon polygon;
        polygon.count = 3;
        for (std::size_t j = 0; j < 3; ++j)
            polygon.corners[j] = {corners[j][face.a], corners[j][face.b], face.sign * corners[j][face.w]};
        if (clip(face, near, polygon))
            rasterise(face, polygon, {plane[face.a], plane[face.b], face.sign * plane[face.w]}, key);
    }
}

/// Leaves what a face sees of a polygon; false if that is nothing.
bool Hemicube::clip(const Face& face, double near, Polygon& polygon)
{
    const std::array<Corner, 5> planes{{{-1, 0, 1}, {1, 0, 1}, {0, -1, 1}, {0, 1, face.below}, {0, 0, 1}}};
    unsigned outside_all = 31, outside_any = 0;
    for (std::size_t j = 0; j < polygon.count; ++j) {
        const Corner& p = polygon.corners[j];
        const unsigned outside = (p.w < p.a ? 1U : 0U) | (p.w < -p.a ? 2U : 0U) | (p.w < p.b ? 4U : 0U) |
                                 (p.b + face.below * p.w < 0 ? 8U : 0U) | (p.w < near ? 16U : 0U);
        outside_all &= outside;
        outside_any |= outside;
    }
    if (outside_all != 0) return false;
    for (std::size_t k = 0; k < planes.size() && polygon.count >= 3; ++k)
        if ((outside_any >> k & 1U) != 0) cut(planes[k], k == 4 ? near : 0, polygon);
    return polygon.count >= 3;
}

/// Keeps the part of a polygon in front of one plane [SutherlandHodgman74].
void Hemicube::cut(const Corner& plane, double offset, Polygon& polygon)
{
    const auto height = [&](const Corner& p) { return plane.a * p.a + plane.b * p.b + plane.w * p.w - offset; };
    Polygon kept;
    Corner last = polygon.corners[polygon.count - 1];
    double last_height = height(last);
    for (std::size_t j = 0; j < polygon.count; ++j) {
        const Corner p = polygon.corners[j];
        const double h = height(p);
        if ((h < 0) != (last_height < 0) && kept.count < kept.corners.size()) {
            // Always from the inside out: both triangles at an edge get the same point, and leave no crack.
            const Corner &in = h < 0 ? last : p, &out = h < 0 ? p : last;
            const double in_height = std::max(h, last_height), t = in_height / (in_height - std::min(h, last_height));
            kept.corners[kept.count++] = {in.a + t * (out.a - in.a), in.b + t * (out.b - in.b),
                                          in.w + t * (out.w - in.w)};
        }
        // Full only if rounding folds a sliver.
        if (h >= 0 && kept.count < kept.corners.size()) kept.corners[kept.count++] = p;
        last = p;
        last_height = h;
    }
    polygon = kept;
}

/// Where an edge crosses the rows' middles, always computed from its lower end: neighbours agree to the bit.
void Hemicube::trace_edge(const Vec2& p, const Vec2& q, std::size_t rows)
{
    const bool upwards = p.y < q.y || (p.y == q.y && p.x < q.x);
    const Vec2 &low = upwards ? p : q, &high = upwards ? q : p;
    const std::size_t first = first_centre(low.y, rows), last = first_centre(high.y, rows);
    if (first >= last) return;
    const double slope = (high.x - low.x) / (high.y - low.y);
    for (std::size_t row = first; row < last; ++row) {
        const double x = low.x + (static_cast<double>(row) + 0.5 - low.y) * slope;
        left_[row] = std::min(left_[row], x);
        right_[row] = std::max(right_[row], x);
    }
}

/// The rows that a polygon on a face covers, its left_ and right_ in each, and the bounds of its depth.
Hemicube::Outline Hemicube::trace(const Face& face, const Polygon& polygon)
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double half = 0.5 * static_cast<double>(resolution_);
    const std::size_t rows = face.below > 0 ? resolution_ : resolution_ / 2;
    std::array<Vec2, 9> points;
    Outline outline{.least = infinity, .most = 0};
    double bottom = infinity, top = 0;
    for (std::size_t j = 0; j < polygon.count; ++j) {
        const Corner& p = polygon.corners[j];
        const double inverse = 1 / p.w;
        points[j] = {(p.a * inverse + 1) * half, (p.b * inverse + face.below) * half};
        outline.least = std::min(outline.least, inverse);
        outline.most = std::max(outline.most, inverse);
        bottom = std::min(bottom, points[j].y);
        top = std::max(top, points[j].y);
    }
    outline.first = first_centre(bottom, rows);
    outline.last = first_centre(top, rows);
    for (std::size_t row = outline.first; row < outline.last; ++row) {
        left_[row] = infinity;
        right_[row] = 0;
    }
    if (outline.first < outline.last)
        for (std::size_t j = 0; j < polygon.count; ++j) trace_edge(points[j], points[(j + 1) % polygon.count], rows);
    return outline;
}

void Hemicube::rasterise(const Face& face, const Polygon& polygon, const Depth& depth, std::uint32_t key)
{
    const Outline outline = trace(face, polygon);
    // Backs count as slightly farther, so that rounding can't let them hide the front on their other side.
    const double bias = (key & back_bit) != 0 ? 1 - 0x1p-22 : 1.0;
    const float low = static_cast<float>(bias * outline.least), high = static_cast<float>(bias * outline.most);
    const double size = 2.0 / static_cast<double>(resolution_), step = bias * depth.a * size;
    for (std::size_t row = outline.first; row < outline.last; ++row) {
        const std::size_t begin = first_centre(left_[row], resolution_), end = first_centre(right_[row], resolution_);
        const double sy = (static_cast<double>(row) + 0.5) * size - face.below;
        const double base = bias * (depth.a * (0.5 * size - 1) + depth.b * sy + depth.w);
        const std::size_t start = (face.row0 * (resolution_ / 2) + row) * resolution_;
        paint_span(base, step, low, high, key, static_cast<int>(begin), static_cast<int>(end), depths_.data() + start,
                   keys_.data() + start);
    }
}

void Hemicube::sum(HemicubeSums& sums)
{
    sums.items.clear();
    sums.factors.clear();
    sums.escaped = sums.backs = 0;
    if (weights_.size() < items_) weights_.resize(items_, 0.0);
    for (std::size_t row = 0; row < 3 * resolution_; ++row) {
        const std::size_t like = row < resolution_ ? row : resolution_ + row % (resolution_ / 2);
        const double* before = row_factors_.data() + like * (resolution_ + 1);
        const std::uint32_t* keys = keys_.data() + row * resolution_;
        for (std::size_t first = 0, last = 0; first < resolution_; first = last) {
            const std::uint32_t key = keys[first];
            while (last < resolution_ && keys[last] == key) ++last;
            add_run(key, before[last] - before[first], sums);
        }
    }
    for (const std::uint32_t item : sums.items) sums.factors.push_back(std::exchange(weights_[item], 0.0));
}

void Hemicube::add_run(std::uint32_t key, double factor, HemicubeSums& sums)
{
    if (key == nothing) {
        sums.escaped += factor;
    } else if ((key & back_bit) != 0) {
        sums.backs += factor;
    } else {
        if (weights_[key] == 0) sums.items.push_back(key);
        weights_[key] += factor;
    }
}

std::uint32_t Hemicube::item(std::size_t pixel) const
{
    const std::uint32_t key = keys_[pixel];
    if (key == nothing) return escaped;
    return (key & back_bit) != 0 ? black_back : key;
}

const Hemicube::Face& Hemicube::face_of(std::size_t pixel) const
{
    const std::size_t halves = pixel / (resolution_ * (resolution_ / 2));
    return faces()[halves < 2 ? 0 : halves - 1];
}

/// The pixel's centre in the coordinates of its face, at w = 1.
Vec2 Hemicube::centre(std::size_t pixel, const Face& face) const
{
    const double size = 2.0 / static_cast<double>(resolution_);
    const std::size_t row = pixel / resolution_ - face.row0 * (resolution_ / 2);
    return {(static_cast<double>(pixel % resolution_) + 0.5) * size - 1,
            (static_cast<double>(row) + 0.5) * size - face.below};
}

double Hemicube::factor(std::size_t pixel) const
{
    const Face& face = face_of(pixel);
    const Vec2 p = centre(pixel, face);
    const double r2 = p.x * p.x + p.y * p.y + 1, size = 2.0 / static_cast<double>(resolution_);
    return (face.w == 2 ? 1 : p.y) * size * size / (std::numbers::pi * r2 * r2);
}

Vec3 Hemicube::direction(std::size_t pixel) const
{
    const Face& face = face_of(pixel);
    const Vec2 p = centre(pixel, face);
    Vec3 d;
    d[face.a] = p.x;
    d[face.b] = p.y;
    d[face.w] = face.sign;
    return d.x * u_ + d.y * v_ + d.z * n_;
}

}  // namespace patchlight
