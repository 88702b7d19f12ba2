#pragma once

#include "meshing/patch_mesh.h"
#include "meshing/refinement.h"
#include "meshing/surface_triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <utility>
#include <vector>

/// What must hold of every mesh, whatever was meshed.
namespace patchlight::testing {

inline double smallest_angle(const PatchMesh& mesh, PatchId patch)
{
    const auto c = mesh.corners(patch);
    double smallest = std::numbers::pi;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 a = mesh.position(c[(k + 1) % 3]) - mesh.position(c[k]);
        const Vec3 b = mesh.position(c[(k + 2) % 3]) - mesh.position(c[k]);
        smallest = std::min(smallest, std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
    }
    return smallest * 180 / std::numbers::pi;
}

inline double smallest_angle(const PatchMesh& mesh)
{
    double smallest = 180;
    for (const PatchId p : mesh.patches()) smallest = std::min(smallest, smallest_angle(mesh, p));
    return smallest;
}

inline double longest_edge(const PatchMesh& mesh)
{
    double longest = 0;
    for (const PatchId p : mesh.patches()) longest = std::max(longest, mesh.longest_edge(p));
    return longest;
}

inline double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b)
{
    const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::distance(p, a + t * (b - a));
}

inline double distance_to_border(const Scene& scene, const Surface& surface, const Vec3& p)
{
    double nearest = scene.diameter;
    for (const auto& loop : surface.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec3 &a = scene.vertices[loop[i]], &b = scene.vertices[loop[(i + 1) % loop.size()]];
            nearest = std::min(nearest, distance_to_segment(p, a, b));
        }
    }
    return nearest;
}

inline double perimeter(const Scene& scene, const Surface& surface)
{
    double sum = 0;
    for (const auto& loop : surface.loops) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            sum += glm::distance(scene.vertices[loop[i]], scene.vertices[loop[(i + 1) % loop.size()]]);
        }
    }
    return sum;
}

using DirectedEdge = std::pair<VertexId, VertexId>;

/// The edges that are a border because a contact line was cut open there, as the patch beside each runs along it. Both
/// sides lie at the same places, to the bit.
inline std::set<DirectedEdge> cut_edges(const PatchMesh& mesh, SurfaceId id)
{
    std::set<DirectedEdge> cuts;
    for (const MeshLine& line : mesh.lines_of(id)) {
        for (std::size_t k = 0; k < 2; ++k)
            EXPECT_EQ(mesh.position(VertexId(line.left[k])), mesh.position(VertexId(line.right[k])));
        const bool is_cut = line.left != line.right;
        EXPECT_TRUE(is_cut || line.kind != LineKind::contact) << "contact lines are cut open";
        if (!is_cut) continue;
        cuts.emplace(VertexId(line.left[0]), VertexId(line.left[1]));
        cuts.emplace(VertexId(line.right[1]), VertexId(line.right[0]));
    }
    return cuts;
}

/// Each edge has one patch on either side, or lies on the polygon's border, or a contact line was cut open there;
/// together those of the second kind are the border.
inline void expect_conforming(const Scene& scene, const PatchMesh& mesh, SurfaceId id)
{
    const Surface& surface = scene.surface(id);
    std::map<DirectedEdge, PatchId> left_of;
    for (const PatchId p : mesh.patches_of(id)) {
        const auto c = mesh.corners(p);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_TRUE(left_of.try_emplace({c[k], c[(k + 1) % 3]}, p).second) << "two patches on one side of an edge";
        }
    }
    const std::set<DirectedEdge> cuts = cut_edges(mesh, id);
    for (const DirectedEdge& cut : cuts) EXPECT_TRUE(left_of.contains(cut)) << "a cut with a patch on one side only";
    double border = 0;
    std::map<VertexId, int> borders_from;
    for (const auto& [edge, patch] : left_of) {
        const auto c = mesh.corners(patch);
        const auto k = static_cast<std::size_t>(std::find(c.begin(), c.end(), edge.first) - c.begin());
        const auto across = left_of.find({edge.second, edge.first});
        EXPECT_EQ(mesh.neighbours(patch)[k], across == left_of.end() ? PatchId() : across->second);
        if (across != left_of.end()) {
            EXPECT_FALSE(cuts.contains(edge)) << "a cut that was left closed";
            continue;
        }
        EXPECT_EQ(++borders_from[edge.first], 1) << "patches that meet in a vertex only";
        EXPECT_TRUE(mesh.on_border(edge.first));
        if (cuts.contains(edge)) continue;
        const Vec3 &a = mesh.position(edge.first), &b = mesh.position(edge.second);
        border += glm::distance(a, b);
        // Far below the snapping distance of 1e-8 diameters: nothing can tell it from the border.
        for (const Vec3& p : {a, 0.5 * (a + b)}) {
            EXPECT_LE(distance_to_border(scene, surface, p), 1e-9 * scene.diameter);
        }
    }
    EXPECT_NEAR(border, perimeter(scene, surface), 1e-9 * perimeter(scene, surface)) << "holes and border are kept";
}

/// Of its loops, in its plane.
inline double polygon_area(const Scene& scene, const Surface& surface)
{
    double twice = 0;
    for (const auto& loop : surface.loops) {
        const auto at = [&](std::size_t i) { return surface.frame.to_plane(scene.vertices[loop[i]]); };
        for (std::size_t i = 1; i + 1 < loop.size(); ++i) twice += cross2(at(0), at(i), at(i + 1));
    }
    return 0.5 * twice;
}

/// The polygons' areas are preserved. Surfaces tell theirs to `snapped`: where corners were snapped, to what that
/// moved.
inline void expect_sound_mesh(const Scene& scene, const PatchMesh& mesh, double snapped = 1e-12)
{
    ASSERT_EQ(mesh.surface_count(), scene.surfaces.size());
    for (std::uint32_t s = 0; s < mesh.surface_count(); ++s) {
        double area = 0;
        for (const PatchId p : mesh.patches_of(SurfaceId(s))) {
            EXPECT_GT(mesh.area(p), 0);
            area += mesh.area(p);
        }
        // Rounding of some thousand sums; slivers cancel: they are exact to the products they are made of.
        const double rounding = 1e-15 * scene.diameter * scene.diameter;
        EXPECT_NEAR(area, polygon_area(scene, scene.surfaces[s]), 1e-12 * area + rounding) << "surface " << s;
        EXPECT_NEAR(area, scene.surfaces[s].area, snapped * area + rounding) << "surface " << s;
        expect_conforming(scene, mesh, SurfaceId(s));
    }
}

inline void expect_same_mesh(const PatchMesh& a, const PatchMesh& b)
{
    EXPECT_EQ(a.arrays().triangles, b.arrays().triangles);
    EXPECT_EQ(a.arrays().positions, b.arrays().positions);
    EXPECT_EQ(a.arrays().patch_surface, b.arrays().patch_surface);
    EXPECT_EQ(a.arrays().vertex_surface, b.arrays().vertex_surface);
    ASSERT_EQ(a.lines().size(), b.lines().size());
    for (std::size_t i = 0; i < a.lines().size(); ++i) {
        EXPECT_EQ(a.lines()[i].kind, b.lines()[i].kind);
        EXPECT_EQ(a.lines()[i].left, b.lines()[i].left);
        EXPECT_EQ(a.lines()[i].right, b.lines()[i].right);
        EXPECT_EQ(a.lines()[i].beyond, b.lines()[i].beyond);
    }
}

/// Halves an edge, any, of a share of all patches.
inline RefinementPlan random_plan(const PatchMesh& mesh, double share, std::uint32_t seed)
{
    std::mt19937 random(seed);
    RefinementPlan plan;
    for (const PatchId p : mesh.patches()) {
        const auto draw = static_cast<std::uint32_t>(random());
        if (draw % 1000 < 1000 * share) plan.bisections.push_back({p, static_cast<std::uint8_t>(draw / 1000 % 3)});
    }
    std::shuffle(plan.bisections.begin(), plan.bisections.end(), random);
    return plan;
}

/// Halves the longest edge of the patch nearest to a place.
inline RefinementPlan plan_towards(const PatchMesh& mesh, const Vec3& place)
{
    PatchId nearest(std::size_t{0});
    for (const PatchId p : mesh.patches()) {
        if (glm::distance(mesh.centroid(p), place) < glm::distance(mesh.centroid(nearest), place)) nearest = p;
    }
    const auto c = mesh.corners(nearest);
    const auto length = [&](std::size_t k) {
        return glm::distance(mesh.position(c[k]), mesh.position(c[(k + 1) % 3]));
    };
    std::uint8_t longest = 0;
    for (const std::uint8_t k : {std::uint8_t{1}, std::uint8_t{2}})
        if (length(k) > length(longest)) longest = k;
    RefinementPlan plan;
    plan.bisections.push_back({nearest, longest});
    return plan;
}

/// Meshing's coordinates as whole numbers of their steps: predicates are exact.
struct WholePlane {
    __extension__ using Wide = __int128;
    static std::array<Wide, 2> whole(const Vec2& q)
    {
        return {static_cast<Wide>(std::llround(std::ldexp(q.x, 30))),
                static_cast<Wide>(std::llround(std::ldexp(q.y, 30)))};
    }
    /// d inside the circumcircle of a counter-clockwise triangle.
    static bool in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d)
    {
        std::array<std::array<Wide, 3>, 3> rows{};
        const auto o = whole(d);
        std::size_t i = 0;
        for (const Vec2* q : {&a, &b, &c}) {
            const auto p = whole(*q);
            const Wide x = p[0] - o[0], y = p[1] - o[1];
            rows[i++] = {x, y, x * x + y * y};
        }
        const auto minor = [&](std::size_t r, std::size_t s) {
            return rows[r][0] * rows[s][1] - rows[r][1] * rows[s][0];
        };
        return rows[0][2] * minor(1, 2) - rows[1][2] * minor(0, 2) + rows[2][2] * minor(0, 1) > 0;
    }
};

/// No edge but border and lines has the far corner of one patch inside the circumcircle of the other, unless turning
/// it would leave a triangle thinner than rounding.
inline void expect_delaunay(const Scene& scene, const PatchMesh& mesh)
{
    std::set<DirectedEdge> fixed;
    for (const MeshLine& line : mesh.lines()) {
        fixed.emplace(VertexId(line.left[0]), VertexId(line.left[1]));
        fixed.emplace(VertexId(line.left[1]), VertexId(line.left[0]));
    }
    std::size_t wrong = 0;
    for (const PatchId p : mesh.patches()) {
        const MeshingPlane plane{scene.surface(mesh.surface(p)).frame, scene.diameter};
        const auto at = [&](VertexId v) { return plane.to_plane(mesh.position(v)); };
        const auto c = mesh.corners(p);
        const auto across = mesh.neighbours(p);
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId a = c[k], b = c[(k + 1) % 3], apex = c[(k + 2) % 3];
            if (!across[k].valid() || fixed.contains({a, b})) continue;
            const auto others = mesh.corners(across[k]);
            VertexId far = others[0];
            for (const VertexId v : others)
                if (v != a && v != b) far = v;
            wrong += WholePlane::in_circle(at(a), at(b), at(apex), at(far)) &&
                     MeshingPlane::is_thick(at(apex), at(a), at(far)) &&
                     MeshingPlane::is_thick(at(apex), at(far), at(b));
        }
    }
    EXPECT_EQ(wrong, 0U) << "edges that aren't constrained Delaunay";
}

}  // namespace patchlight::testing
