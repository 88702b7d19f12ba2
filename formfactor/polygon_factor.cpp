#include "formfactor/polygon_factor.h"

#include "formfactor/convex_polygon.h"
#include "formfactor/edge_pair.h"
#include "formfactor/lambert.h"
#include "meshing/positive_part.h"

#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace patchlight {

namespace {

constexpr double shape_tolerance = 1e-6;
/// In radii: beyond it five nodes leave less than the contours' cancellation.
constexpr double far_apart = 15;

using Points = std::vector<Vec3>;

double largest_coordinate(std::span<const Vec3> polygon, const Vec3& origin)
{
    double largest = 0;
    for (const Vec3& p : polygon)
        for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(p[axis] - origin[axis]));
    return largest;
}

[[noreturn]] void refuse(const char* which, const char* why)
{
    throw std::invalid_argument(std::string("polygon_factor: the ") + which + " polygon " + why);
}

void require_convex(const Points& polygon, const Vec3& normal, const char* which)
{
    const double size = largest_coordinate(polygon, polygon[0]), slack = shape_tolerance * size;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        if (std::abs(glm::dot(polygon[i] - polygon[0], normal)) > slack) refuse(which, "is not planar");
        const Vec3 along = polygon[(i + 1) % polygon.size()] - polygon[i];
        const double length = glm::length(along);
        // The direction of a tiny edge is rounding; its neighbours tell.
        if (length < 1e-3 * slack) continue;
        const Vec3 inward = glm::cross(normal, along);
        for (const Vec3& p : polygon)
            if (glm::dot(p - polygon[i], inward) < -slack * length) refuse(which, "is not convex");
    }
}

/// A polygon about a common origin in a common unit.
struct Side {
    Points points;
    Vec3 normal;

    Side(std::span<const Vec3> polygon, const Vec3& origin, double unit, const Vec3& known_normal)
        : points(moved(polygon, origin, unit)), normal(known_normal)
    {}

    /// Checks the shape.
    Side(std::span<const Vec3> polygon, const Vec3& origin, double unit, const char* which)
        : points(moved(polygon, origin, unit))
    {
        const Vec3 area = area_vector(points);
        const double size = largest_coordinate(points, points[0]), length = glm::length(area);
        if (!(length > 5e-15 * size * size)) refuse(which, "has no area");
        normal = area / length;
        require_convex(points, normal, which);
    }

    static Points moved(std::span<const Vec3> polygon, const Vec3& origin, double unit)
    {
        Points points;
        points.reserve(polygon.size() + 1);
        for (const Vec3& p : polygon) points.push_back((p - origin) / unit);
        return points;
    }
};

/// What lies in front of the plane; vertices nearer than `snap` count as in it. Empty when no vertex is in front.
Points in_front(const Side& side, const Side& plane, double snap)
{
    const auto height = [&](const Vec3& p) {
        const double h = glm::dot(p - plane.points[0], plane.normal);
        return std::abs(h) <= snap ? 0.0 : h;
    };
    Points front;
    front.reserve(side.points.size() + 2);
    bool any = false;
    for (std::size_t i = 0; i < side.points.size(); ++i) {
        const Vec3& a = side.points[i];
        const Vec3& b = side.points[(i + 1) % side.points.size()];
        const double ha = height(a), hb = height(b);
        if (ha >= 0) front.push_back(a);
        if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) front.push_back(a + (ha / (ha - hb)) * (b - a));
        any = any || ha > 0;
    }
    if (!any) front.clear();
    return front;
}

std::vector<Edge> edges_of(const Points& polygon)
{
    std::vector<Edge> edges;
    edges.reserve(polygon.size());
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 along = polygon[(i + 1) % polygon.size()] - polygon[i];
        const double length = glm::length(along);
        if (length > 0) edges.push_back({polygon[i], along / length, length});
    }
    return edges;
}

double perimeter(const std::vector<Edge>& edges)
{
    double sum = 0;
    for (const Edge& e : edges) sum += e.length;
    return sum;
}

double by_contours(const Points& first, const Points& second, double allowed)
{
    const std::vector<Edge> outer = edges_of(first), inner = edges_of(second);
    // Each pair of edges weighs with the product of its lengths.
    const double tolerance = std::max(1e-16, 2 * std::numbers::pi * allowed / (perimeter(outer) * perimeter(inner)));
    double sum = 0;
    for (const Edge& a : outer)
        for (const Edge& b : inner) sum += edge_pair_integral(a, b, tolerance);
    return sum / (2 * std::numbers::pi);
}

struct Ball {
    Vec3 centre{0.0};
    double radius = 0;

    explicit Ball(const Points& points)
    {
        for (const Vec3& p : points) centre += p / static_cast<double>(points.size());
        for (const Vec3& p : points) radius = std::max(radius, glm::length(p - centre));
    }
};

struct Node {
    Vec3 place;
    double weight;
};

/// A 5 × 5 Gauss rule on each triangle of the fan.
std::vector<Node> area_nodes(const Points& polygon)
{
    using Rule = boost::math::quadrature::gauss<double, 5>;
    std::vector<std::pair<double, double>> line;  // on [0, 1]
    for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
        const double x = Rule::abscissa()[i], w = 0.5 * Rule::weights()[i];
        line.emplace_back(0.5 + 0.5 * x, w);
        if (x != 0) line.emplace_back(0.5 - 0.5 * x, w);
    }
    std::vector<Node> nodes;
    nodes.reserve(25 * (polygon.size() - 2));
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        const Vec3 a = polygon[i] - polygon[0], b = polygon[i + 1] - polygon[0];
        const double twice_area = glm::length(glm::cross(a, b));
        for (const auto& [u, wu] : line)
            for (const auto& [v, wv] : line)
                nodes.push_back({polygon[0] + u * (a + v * (b - a)), wu * wv * u * twice_area});
    }
    return nodes;
}

/// ∫∫ cos θ1 cos θ2 / (π r²) dA1 dA2.
double by_areas(const Points& first, const Vec3& n1, const Points& second, const Vec3& n2)
{
    const std::vector<Node> from = area_nodes(first), to = area_nodes(second);
    double sum = 0;
    for (const Node& a : from) {
        double seen = 0;
        for (const Node& b : to) {
            const Vec3 r = b.place - a.place;
            const double rr = glm::dot(r, r);
            seen -= b.weight * glm::dot(n1, r) * glm::dot(n2, r) / (rr * rr);
        }
        sum += a.weight * seen;
    }
    return sum / std::numbers::pi;
}

double distance_to_edges(const Vec3& p, const Points& polygon)
{
    double least = std::numeric_limits<double>::infinity();
    for (const Edge& e : edges_of(polygon)) {
        const double foot = std::clamp(glm::dot(p - e.start, e.direction), 0.0, e.length);
        least = std::min(least, glm::length(p - e.start - foot * e.direction));
    }
    return least;
}

/// Lambert's factor varies so little over a small polygon, away from the edges of the other, that five nodes do;
/// around the small contour the same would cancel.
bool is_small_beside(const Ball& small, double other_radius, const Points& other)
{
    return far_apart * small.radius < other_radius && far_apart * small.radius < distance_to_edges(small.centre, other);
}

double by_lambert(const Points& small, const Vec3& normal, const Points& other)
{
    double sum = 0;
    for (const Node& node : area_nodes(small)) sum += node.weight * lambert_factor(node.place, normal, other);
    return sum;
}

void require_vertices(std::span<const Vec3> polygon, const char* which)
{
    if (polygon.size() < 3) refuse(which, "has fewer than 3 vertices");
    if (!std::isfinite(largest_coordinate(polygon, Vec3(0.0)))) refuse(which, "has a vertex that is not finite");
    for (const Vec3& p : polygon)
        if (std::isnan(p.x + p.y + p.z)) refuse(which, "has a vertex that is not finite");
}

/// In units of `unit`².
double scaled_exchange(const Side& first, const Side& second, double snap, double tolerance)
{
    const Points p = in_front(first, second, snap), q = in_front(second, first, snap);
    if (p.empty() || q.empty()) return 0;
    const Ball ball_p(p), ball_q(q);
    if (glm::length(ball_p.centre - ball_q.centre) > far_apart * (ball_p.radius + ball_q.radius))
        return by_areas(p, first.normal, q, second.normal);
    if (is_small_beside(ball_p, ball_q.radius, q)) return by_lambert(p, first.normal, q);
    if (is_small_beside(ball_q, ball_p.radius, p)) return by_lambert(q, second.normal, p);
    const double smaller = std::min(glm::length(area_vector(first.points)), glm::length(area_vector(second.points)));
    const double sum = by_contours(p, q, tolerance * smaller);
    // What rounding leaves of nothing; anything worse shows.
    return sum < 0 && sum > -1e-14 ? 0 : sum;
}

/// The unit in which both fit, and what rounding leaves of heights in it: a vertex of a shared edge lies in the
/// other's plane but for the rounding of its coordinates.
struct Place {
    double unit = 0, snap = 0;

    Place(std::span<const Vec3> low, std::span<const Vec3> high)
    {
        unit = std::max(largest_coordinate(low, low[0]), largest_coordinate(high, low[0]));
        const double reach = std::max(largest_coordinate(low, Vec3(0.0)), largest_coordinate(high, Vec3(0.0)));
        snap = 1e-13 + 4 * std::numeric_limits<double>::epsilon() * reach / unit;
    }
};

}  // namespace

double polygon_exchange(std::span<const Vec3> first, std::span<const Vec3> second, double tolerance)
{
    if (!(tolerance >= 1e-15 && tolerance <= 1e-2))
        throw std::invalid_argument("polygon_factor: the tolerance must lie in 1e-15 … 1e-2");
    require_vertices(first, "first");
    require_vertices(second, "second");
    const bool kept = !precedes(second, first);
    const std::span<const Vec3> low = kept ? first : second, high = kept ? second : first;
    const Place place(low, high);
    if (!(place.unit > 0)) refuse("first", "has no area");
    const Side a(low, low[0], place.unit, kept ? "first" : "second"),
        b(high, low[0], place.unit, kept ? "second" : "first");
    return scaled_exchange(a, b, place.snap, tolerance) * place.unit * place.unit;
}

double fragment_exchange(std::span<const Vec3> first, const Vec3& normal_first, std::span<const Vec3> second,
                         const Vec3& normal_second, double tolerance)
{
    if (precedes(second, first)) return fragment_exchange(second, normal_second, first, normal_first, tolerance);
    const Place place(first, second);
    if (!(place.unit > 0)) return 0;
    const Side a(first, first[0], place.unit, normal_first), b(second, first[0], place.unit, normal_second);
    return positive_part(scaled_exchange(a, b, place.snap, tolerance)) * place.unit * place.unit;
}

double polygon_factor(std::span<const Vec3> from, std::span<const Vec3> to, double tolerance)
{
    const double exchange = polygon_exchange(from, to, tolerance);
    return exchange / glm::length(area_vector(from));
}

}  // namespace patchlight
