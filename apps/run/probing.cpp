#include "apps/run/probing.h"

#include <fmt/format.h>
#include <glm/vector_relational.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

namespace patchlight {

namespace {

/// The nearest point of a triangle, by the region of its plane in which p lies. Source: [Ericson05] 5.1.5.
Vec3 nearest_on_triangle(const Vec3& p, const std::array<Vec3, 3>& t)
{
    const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) {
        return t[0];
    }
    const Vec3 bp = p - t[1];
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) {
        return t[1];
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        return t[0] + d1 / (d1 - d3) * ab;
    }
    const Vec3 cp = p - t[2];
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) {
        return t[2];
    }
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        return t[0] + d2 / (d2 - d6) * ac;
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        return t[1] + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t[2] - t[1]);
    }
    const double scale = 1 / (va + vb + vc);
    return t[0] + vb * scale * ab + vc * scale * ac;
}

}  // namespace

SurfaceProbe::SurfaceProbe(const StoredSolution& solution)
    : solution_(solution), locator_(solution.mesh), reach_(1e-6 * solution.scene.diameter)
{
    for (const SceneTriangle& triangle : solution.scene.triangles) {
        Facet facet;
        for (int k = 0; k < 3; ++k) {
            facet.corners[k] = solution.scene.vertices[triangle.vertices[k]];
        }
        const auto& c = facet.corners;
        facet.low = glm::min(glm::min(c[0], c[1]), c[2]) - reach_;
        facet.high = glm::max(glm::max(c[0], c[1]), c[2]) + reach_;
        facet.front = triangle.front;
        facet.back = triangle.back;
        facets_.push_back(facet);
    }
}

std::optional<ProbeAnswer> SurfaceProbe::at(const ProbePoint& point) const
{
    const Vec3 p = point.position * solution_.scene.unit - solution_.scene.center;
    SurfaceId best;
    double best_facing = 0, best_distance = std::numeric_limits<double>::infinity();
    const auto offer = [&](SurfaceId surface, double distance) {
        if (!surface.valid()) {
            return;
        }
        const Vec3& n = solution_.scene.surface(surface).frame.n;
        const double facing = point.normal ? glm::dot(glm::normalize(*point.normal), n) : 1;
        // Equal up to rounding: the nearer one answers, so that a normal tilted by the last bit decides nothing.
        const bool same = std::abs(facing - best_facing) <= 1e-9;
        if (facing <= 1e-9 || (!same && facing < best_facing) || (same && distance >= best_distance)) {
            return;
        }
        best = surface;
        best_facing = facing;
        best_distance = distance;
    };
    for (const Facet& f : facets_) {
        if (glm::any(glm::lessThan(p, f.low)) || glm::any(glm::greaterThan(p, f.high))) {
            continue;
        }
        const double distance = glm::length(p - nearest_on_triangle(p, f.corners));
        if (distance <= reach_) {
            offer(f.front, distance);
            offer(f.back, distance);
        }
    }
    if (!best.valid()) {
        return std::nullopt;
    }
    return answer(best, p);
}

ProbeAnswer SurfaceProbe::answer(SurfaceId surface, const Vec3& p) const
{
    ProbeAnswer result;
    result.surface = surface;
    const ElementLight light{solution_.mesh, locator_, solution_.vertex_B, &solution_.middle_B};
    result.B = light.at(surface, solution_.scene.surface(surface).frame.to_plane(p));
    return result;
}

std::vector<std::optional<ProbeAnswer>> SurfaceProbe::at(const std::vector<ProbePoint>& points) const
{
    std::vector<std::optional<ProbeAnswer>> answers(points.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 64), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            answers[i] = at(points[i]);
        }
    });
    return answers;
}

std::string probe_csv(const std::vector<ProbePoint>& points, const std::vector<std::optional<ProbeAnswer>>& answers)
{
    std::string out = "x,y,z,Br,Bg,Bb,surface\n";
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& xyz = points[i].as_written;
        out += fmt::format("{},{},{},", xyz[0], xyz[1], xyz[2]);
        if (const auto& a = answers[i]) {
            out += fmt::format("{},{},{},{}\n", a->B.r, a->B.g, a->B.b, a->surface.value);
        } else {
            out += ",,,\n";
        }
    }
    return out;
}

}  // namespace patchlight
