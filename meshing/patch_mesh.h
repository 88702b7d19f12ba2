#pragma once

#include "meshing/fields.h"
#include "meshing/scene.h"
#include "meshing/surface_line.h"

#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace patchlight {

/// Half-open range of ids.
template <class IdType>
struct IdRange {
    std::uint32_t first = 0;
    std::uint32_t last = 0;

    std::size_t size() const { return last - first; }
    struct Iterator {
        std::uint32_t value;
        IdType operator*() const { return IdType(value); }
        Iterator& operator++()
        {
            ++value;
            return *this;
        }
        bool operator!=(const Iterator& other) const { return value != other.value; }
    };
    Iterator begin() const { return {first}; }
    Iterator end() const { return {last}; }
};

/// An edge of the mesh that lies on a line. Across a contact line the light jumps: patches on its left have vertices of
/// their own there, those on its right others at the same places. Elsewhere both sides have the same.
struct MeshLine {
    LineKind kind = LineKind::contact;
    std::array<std::uint32_t, 2> left{}, right{};  ///< from its start to its end
    bool beyond = false;  ///< not of the line itself: where the cut of a contact line goes on past its end
};

/// What a PatchMesh is made from. Vertices and patches are in order of their surface.
struct PatchMeshArrays {
    std::vector<Vec3> positions;                          ///< metres, recentred
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from the surface's front
    std::vector<SurfaceId> patch_surface;                 ///< non-decreasing
    std::vector<SurfaceId> vertex_surface;                ///< non-decreasing
    std::vector<MeshLine> lines;                          ///< in order of their surface
};

/// The patch mesh: triangles over the scene's surfaces, conforming within a surface; across surfaces vertices
/// need not match. A vertex belongs to one surface. Along contact lines the mesh is cut open: the light has two values
/// there, one a side. Held in an OpenMesh triangle mesh; immutable.
class PatchMesh {
public:
    PatchMesh();
    /// Throws std::invalid_argument when an index is past the end, surfaces are out of order, a triangle joins
    /// vertices of two surfaces, has no area, the triangles of a surface aren't a manifold, or a line isn't their edge
    /// or has its sides at different places.
    PatchMesh(const Scene& scene, PatchMeshArrays arrays);
    PatchMesh(PatchMesh&&) noexcept;
    PatchMesh& operator=(PatchMesh&&) noexcept;
    ~PatchMesh();

    std::size_t patch_count() const { return arrays_.triangles.size(); }
    std::size_t vertex_count() const { return arrays_.positions.size(); }
    IdRange<PatchId> patches() const { return {0, static_cast<std::uint32_t>(patch_count())}; }
    IdRange<VertexId> vertices() const { return {0, static_cast<std::uint32_t>(vertex_count())}; }
    IdRange<PatchId> patches_of(SurfaceId surface) const { return patch_ranges_[surface.value]; }
    IdRange<VertexId> vertices_of(SurfaceId surface) const { return vertex_ranges_[surface.value]; }
    std::size_t surface_count() const { return patch_ranges_.size(); }

    SurfaceId surface(PatchId patch) const { return arrays_.patch_surface[patch.value]; }
    SurfaceId surface(VertexId vertex) const { return arrays_.vertex_surface[vertex.value]; }
    const Vec3& position(VertexId vertex) const { return arrays_.positions[vertex.value]; }
    /// Coordinates in the frame of the vertex's surface.
    const Vec2& plane_position(VertexId vertex) const { return plane_positions_[vertex.value]; }
    std::array<VertexId, 3> corners(PatchId patch) const
    {
        const auto& t = arrays_.triangles[patch.value];
        return {VertexId(t[0]), VertexId(t[1]), VertexId(t[2])};
    }
    double area(PatchId patch) const { return areas_[patch]; }
    const PatchField<double>& areas() const { return areas_; }
    Vec3 centroid(PatchId patch) const;
    double longest_edge(PatchId patch) const;

    /// The patch on the other side of the edge from corner k to corner k+1, invalid on the surface's border.
    std::array<PatchId, 3> neighbours(PatchId patch) const;
    bool on_border(VertexId vertex) const;
    /// The patches around a vertex, in a fixed order.
    std::vector<PatchId> patches_around(VertexId vertex) const;

    const PatchMeshArrays& arrays() const { return arrays_; }
    std::span<const MeshLine> lines() const { return arrays_.lines; }
    std::span<const MeshLine> lines_of(SurfaceId surface) const
    {
        const auto [first, last] = line_ranges_[surface.value];
        return {arrays_.lines.data() + first, last - first};
    }

private:
    struct Topology;
    PatchMeshArrays arrays_;
    std::unique_ptr<Topology> topology_;
    std::vector<IdRange<PatchId>> patch_ranges_;
    std::vector<IdRange<VertexId>> vertex_ranges_;
    std::vector<std::pair<std::size_t, std::size_t>> line_ranges_;
    std::vector<Vec2> plane_positions_;
    PatchField<double> areas_;
};

}  // namespace patchlight
