#pragma once

#include "tests/meshing/flat_scenes.h"
#include "tests/meshing/mesh_checks.h"

#include <span>

/// What must hold where lines were put into a surface.
namespace patchlight::testing {

constexpr double line_merge = 2e-6;  ///< what insert_lines merges unless told, of the diameter

inline const SurfaceId only_surface{std::size_t{0}};

inline SurfaceLine line_from(const Vec2& start, const Vec2& end, LineKind kind = LineKind::ev)
{
    return {only_surface, kind, start, end};
}

/// On each surface that reflects a contact line and another that cross.
inline std::vector<SurfaceLine> crosses(const Scene& scene)
{
    std::vector<SurfaceLine> lines;
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
        if (!scene.material_of(SurfaceId(s)).reflects()) continue;
        const Surface& surface = scene.surfaces[s];
        const auto corner = [&](std::size_t k) { return surface.frame.to_plane(scene.vertices[surface.loops[0][k]]); };
        const Vec2 a = corner(0), b = corner(1), c = corner(2), middle = (a + b + c) / 3.0;
        const auto inwards = [&](const Vec2& q, double t) { return q + t * (middle - q); };
        lines.push_back({SurfaceId(s), LineKind::contact, inwards(a, 0.2), inwards(0.5 * (b + c), 0.2)});
        lines.push_back({SurfaceId(s), LineKind::ev, inwards(b, 0.3), inwards(0.5 * (a + c), 0.3)});
    }
    return lines;
}

/// A polygon and what lines make of its triangulation.
struct LinedSurface {
    Scene scene;
    SurfaceTriangulation triangulation;

    explicit LinedSurface(const PlaneLoops& loops, const PlaneFrame& frame = {}) : scene(flat_scene(loops, 0.5, frame))
    {
        triangulation = triangulate_polygon(scene, only_surface);
    }

    MeshingPlane plane() const { return {scene.surfaces[0].frame, scene.diameter}; }
    const PlaneFrame& frame() const { return scene.surfaces[0].frame; }
    Vec2 at(std::uint32_t vertex) const { return frame().to_plane(triangulation.positions[vertex]); }

    void insert(std::span<const SurfaceLine> lines) { triangulation = insert_lines(plane(), triangulation, lines); }

    /// The mesh of this surface alone, contact lines cut open.
    PatchMesh mesh() const
    {
        CutTriangulation cut = cut_contacts(frame(), triangulation);
        PatchMeshArrays arrays;
        arrays.vertex_surface.assign(cut.positions.size(), only_surface);
        arrays.patch_surface.assign(cut.triangles.size(), only_surface);
        arrays.positions = std::move(cut.positions);
        arrays.triangles = std::move(cut.triangles);
        arrays.lines = std::move(cut.lines);
        return PatchMesh(scene, std::move(arrays));
    }
};

inline double distance_to_segment(const Vec2& q, const Vec2& a, const Vec2& b)
{
    const double t = std::clamp(glm::dot(q - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::distance(q, a + t * (b - a));
}

/// How far places on a line are from the nearest edge of the mesh that is a line, at most, of the diameter. `used`
/// tells whether a place counts: those inside the surface.
template <class Used>
double distance_to_lines(const LinedSurface& surface, const SurfaceLine& line, const Used& used)
{
    double farthest = 0;
    for (int i = 0; i <= 50; ++i) {
        const Vec2 q = line.start + (i / 50.0) * (line.end - line.start);
        if (!used(q)) continue;
        double nearest = surface.scene.diameter;
        for (const auto& edge : surface.triangulation.lines)
            nearest =
                std::min(nearest, distance_to_segment(q, surface.at(edge.vertices[0]), surface.at(edge.vertices[1])));
        farthest = std::max(farthest, nearest);
    }
    return farthest / surface.scene.diameter;
}

inline double distance_to_lines(const LinedSurface& surface, const SurfaceLine& line)
{
    return distance_to_lines(surface, line, [](const Vec2&) { return true; });
}

inline double length_of_lines(const LinedSurface& surface)
{
    double sum = 0;
    for (const auto& edge : surface.triangulation.lines)
        sum += glm::distance(surface.at(edge.vertices[0]), surface.at(edge.vertices[1]));
    return sum;
}

/// Sound, constrained Delaunay, no triangle as thin as rounding, and the vertices of `before` still there.
inline void expect_sound_surface(const LinedSurface& surface, const SurfaceTriangulation& before)
{
    const PatchMesh mesh = surface.mesh();
    expect_sound_mesh(surface.scene, mesh);
    expect_delaunay(surface.scene, mesh);
    for (const auto& t : surface.triangulation.triangles) {
        const auto at = [&](std::size_t k) { return surface.at(t[k]) / surface.scene.diameter; };
        EXPECT_TRUE(MeshingPlane::is_thick(at(0), at(1), at(2)));
    }
    for (const Vec3& p : before.positions)
        EXPECT_TRUE(std::ranges::find(surface.triangulation.positions, p) != surface.triangulation.positions.end());
}

}  // namespace patchlight::testing
