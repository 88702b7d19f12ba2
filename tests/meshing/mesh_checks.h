#pragma once

#include "meshing/patch_mesh.h"
#include "meshing/refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
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

/// Each edge has one patch on either side, or lies on the polygon's border; together the latter are the border.
inline void expect_conforming(const Scene& scene, const PatchMesh& mesh, SurfaceId id)
{
    const Surface& surface = scene.surface(id);
    std::map<std::pair<VertexId, VertexId>, PatchId> left_of;
    for (const PatchId p : mesh.patches_of(id)) {
        const auto c = mesh.corners(p);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_TRUE(left_of.try_emplace({c[k], c[(k + 1) % 3]}, p).second) << "two patches on one side of an edge";
        }
    }
    double border = 0;
    std::map<VertexId, int> borders_from;
    for (const auto& [edge, patch] : left_of) {
        const auto c = mesh.corners(patch);
        const auto k = static_cast<std::size_t>(std::find(c.begin(), c.end(), edge.first) - c.begin());
        const auto across = left_of.find({edge.second, edge.first});
        EXPECT_EQ(mesh.neighbours(patch)[k], across == left_of.end() ? PatchId() : across->second);
        if (across != left_of.end()) continue;
        const Vec3 &a = mesh.position(edge.first), &b = mesh.position(edge.second);
        border += glm::distance(a, b);
        EXPECT_EQ(++borders_from[edge.first], 1) << "patches that meet in a vertex only";
        EXPECT_TRUE(mesh.on_border(edge.first));
        // Far below the snapping distance of 1e-8 diameters: nothing can tell it from the border.
        for (const Vec3& p : {a, 0.5 * (a + b)}) {
            EXPECT_LE(distance_to_border(scene, surface, p), 1e-9 * scene.diameter);
        }
    }
    EXPECT_NEAR(border, perimeter(scene, surface), 1e-9 * perimeter(scene, surface)) << "holes and border are kept";
}

inline void expect_sound_mesh(const Scene& scene, const PatchMesh& mesh)
{
    ASSERT_EQ(mesh.surface_count(), scene.surfaces.size());
    for (std::uint32_t s = 0; s < mesh.surface_count(); ++s) {
        double area = 0;
        for (const PatchId p : mesh.patches_of(SurfaceId(s))) {
            EXPECT_GT(mesh.area(p), 0);
            area += mesh.area(p);
        }
        // Rounding of some thousand sums; slivers cancel: they are exact to the products they are made of.
        const double rounding = 1e-12 * scene.surfaces[s].area + 1e-15 * scene.diameter * scene.diameter;
        EXPECT_NEAR(area, scene.surfaces[s].area, rounding) << "surface " << s;
        expect_conforming(scene, mesh, SurfaceId(s));
    }
}

inline void expect_same_mesh(const PatchMesh& a, const PatchMesh& b)
{
    EXPECT_EQ(a.arrays().triangles, b.arrays().triangles);
    EXPECT_EQ(a.arrays().positions, b.arrays().positions);
    EXPECT_EQ(a.arrays().patch_surface, b.arrays().patch_surface);
    EXPECT_EQ(a.arrays().vertex_surface, b.arrays().vertex_surface);
}

/// Splits a share of all patches, to half or a quarter of their longest edge.
inline RefinementPlan random_plan(const PatchMesh& mesh, double share, std::uint32_t seed)
{
    std::mt19937 random(seed);
    RefinementPlan plan;
    for (const PatchId p : mesh.patches()) {
        const auto draw = static_cast<std::uint32_t>(random());
        if (draw % 1000 < 1000 * share)
            plan.splits.push_back({p, mesh.longest_edge(p) / (draw / 1000 % 2 == 0 ? 2 : 4)});
    }
    return plan;
}

/// Splits the patch nearest to a place to half its longest edge.
inline RefinementPlan plan_towards(const PatchMesh& mesh, const Vec3& place)
{
    PatchId nearest(std::size_t{0});
    for (const PatchId p : mesh.patches()) {
        if (glm::distance(mesh.centroid(p), place) < glm::distance(mesh.centroid(nearest), place)) nearest = p;
    }
    return {{{nearest, mesh.longest_edge(nearest) / 2}}};
}

}  // namespace patchlight::testing
