#include "formfactor/unoccluded_exchange.h"

#include "formfactor/lambert.h"
#include "formfactor/polygon_factor.h"
#include "formfactor/triangle_rules.h"
#include "meshing/positive_part.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patchlight {

namespace {

/// One node against the same node of every triangle of a block. Without branches: the compiler vectorises it; AVX2 and
/// plain code round alike (no contraction), so that the bytes don't depend on the machine.
__attribute__((target_clones("avx2", "default"))) void add_node(const Vec3& p, const Vec3& n, const Vec3& m, double w,
                                                                std::size_t count, const double* __restrict x,
                                                                const double* __restrict y, const double* __restrict z,
                                                                double* __restrict out)
{
    const double px = p.x, py = p.y, pz = p.z, nx = n.x, ny = n.y, nz = n.z, mx = m.x, my = m.y, mz = m.z;
    for (std::size_t j = 0; j < count; ++j) {
        const double rx = x[j] - px, ry = y[j] - py, rz = z[j] - pz;
        const double rr = rx * rx + ry * ry + rz * rz;
        const double cosines = (nx * rx + ny * ry + nz * rz) * (mx * rx + my * ry + mz * rz);
        out[j] -= w * cosines / (rr * rr);
    }
}

struct Ball {
    Vec3 centre{0.0};
    double radius = 0;

    explicit Ball(std::span<const Vec3> points)
    {
        for (const Vec3& p : points) centre += p / static_cast<double>(points.size());
        for (const Vec3& p : points) radius = std::max(radius, glm::length(p - centre));
    }
};

struct Node {
    Vec3 place;
    double weight;  ///< times area
};

std::vector<Node> nodes_on(std::span<const Vec3> polygon, int degree)
{
    std::vector<Node> nodes;
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        const Vec3 a = polygon[i - 1] - polygon[0], b = polygon[i] - polygon[0];
        const double area = 0.5 * glm::length(glm::cross(a, b));
        for (const TriangleNode& node : triangle_rule(degree))
            nodes.push_back({polygon[0] + node.b1 * a + node.b2 * b, area * node.weight});
    }
    return nodes;
}

bool is_sliver(std::span<const Vec3> polygon, double radius)
{
    return glm::length(area_vector(polygon)) < 5e-8 * radius * radius;
}

double by_lambert(std::span<const Vec3> sliver, const Vec3& normal, std::span<const Vec3> other)
{
    double sum = 0;
    for (const Node& node : nodes_on(sliver, 5)) sum += node.weight * lambert_factor(node.place, normal, other);
    return sum;
}

}  // namespace

NodeBlock node_block(std::span<const std::array<Vec3, 3>> triangles, const Vec3& normal, int degree)
{
    NodeBlock block;
    block.normal = normal;
    block.count = triangles.size();
    for (const TriangleNode& node : triangle_rule(degree)) {
        block.weight.push_back(node.weight);
        for (const auto& t : triangles) {
            const Vec3 p = t[0] + node.b1 * (t[1] - t[0]) + node.b2 * (t[2] - t[0]);
            block.x.push_back(p.x);
            block.y.push_back(p.y);
            block.z.push_back(p.z);
        }
    }
    return block;
}

void mean_kernel(const NodeBlock& from, const NodeBlock& to, std::span<double> out)
{
    std::ranges::fill(out, 0.0);
    for (std::size_t k = 0; k < from.weight.size(); ++k) {
        const Vec3 p(from.x[k], from.y[k], from.z[k]);
        for (std::size_t l = 0; l < to.weight.size(); ++l) {
            const std::size_t at = l * to.count;
            add_node(p, from.normal, to.normal, from.weight[k] * to.weight[l] / std::numbers::pi, to.count,
                     to.x.data() + at, to.y.data() + at, to.z.data() + at, out.data());
        }
    }
}

double unoccluded_exchange(std::span<const Vec3> first, const Vec3& normal_first, std::span<const Vec3> second,
                           const Vec3& normal_second)
{
    const Ball a(first), b(second);
    const double apart = glm::length(a.centre - b.centre), radii = a.radius + b.radius;
    if (apart < 1.3 * radii) {
        // Around what clipping left as a sliver the contours would cancel; its area makes nodes exact enough.
        if (is_sliver(first, a.radius)) return by_lambert(first, normal_first, second);
        if (is_sliver(second, b.radius)) return by_lambert(second, normal_second, first);
        return fragment_exchange(first, normal_first, second, normal_second, 1e-9);
    }
    const int degree = apart < 2.7 * radii ? 8 : 5;
    const std::vector<Node> from = nodes_on(first, degree), to = nodes_on(second, degree);
    double sum = 0;
    for (const Node& p : from) {
        double seen = 0;
        for (const Node& q : to) {
            const Vec3 r = q.place - p.place;
            const double rr = glm::dot(r, r);
            seen -= q.weight * glm::dot(normal_first, r) * glm::dot(normal_second, r) / (rr * rr);
        }
        sum += p.weight * seen;
    }
    return positive_part(sum / std::numbers::pi);
}

}  // namespace patchlight
