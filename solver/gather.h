#pragma once

#include "solver/system.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace patchlight {

/// How light is gathered at points: emitters exactly (where Exchange has that; else small ones by Lambert's formula
/// times the visible fraction), the rest by rays over the hemisphere that bring B of the patches they meet.
struct GatherOptions {
    int rays = 512;             ///< over the hemisphere, 16 … 65536
    int shadow_rays = 1024;     ///< per point, shared among partly hidden emitters by their factors, 16 … 65536
    double small_source = 0.2;  ///< as in FormFactorOptions
    double crease_angle =
        30;  ///< degrees: facets of one material that meet at less share irradiance at common vertices
    std::uint64_t seed = 1;
};

/// A place on a surface.
struct SurfacePoint {
    Vec3 position{0.0};  ///< where rays start: off every edge by what single precision needs
    SurfaceId surface;
    Vec3 limit{0.0};  ///< where light is computed exactly: the place itself, off a border by a millionth of a patch
};

/// H in W/m² at points, and the rays it took.
struct GatheredLight {
    std::vector<Rgb> irradiance;
    std::vector<Rgb> again;  ///< by as many other rays, independently; empty where that isn't done
    std::size_t rays = 0;
};

/// Whatever tells the irradiance at points of the surfaces. May throw Interrupted.
using LightAtPoints = std::function<GatheredLight(std::span<const SurfacePoint>, const WorkMonitor&)>;

/// Irradiance at points from the patch solution B: one more bounce. Points of one surface share their directions,
/// so that what the rays don't resolve varies smoothly over it. The points' rows are those of `kept` where that holds
/// them; where it is empty, it is filled. Throws Interrupted.
GatheredLight gather_irradiance(const Exchange& exchange, const Radiosity& B, std::span<const SurfacePoint> points,
                                const GatherOptions& options, const WorkMonitor& monitor = {},
                                FormFactorMatrix* kept = nullptr);

/// The same as whatever tells the irradiance; keeps references to `exchange`, B and `kept`.
LightAtPoints light_from_patches(const Exchange& exchange, const Radiosity& B, const GatherOptions& options,
                                 FormFactorMatrix* kept = nullptr);

/// A place of a border, moved toward `inside` of its surface: what is there on this side.
SurfacePoint border_point(const Vec3& place, const Vec3& inside, SurfaceId surface, double diameter);

/// Where light is gathered for each vertex: moved into its surface.
std::vector<SurfacePoint> vertex_points(const Exchange& exchange);

/// Those, and the middle of every edge: once for the two patches that meet there, moved inside on borders and contact
/// lines.
struct ElementPoints {
    std::vector<SurfacePoint> points;                       ///< vertices first, by id
    std::vector<std::array<std::uint32_t, 3>> midpoint_of;  ///< into points: of each patch's edge k
};
ElementPoints element_points(const Exchange& exchange);

/// B = E + ρ H at every node of the elements, never averaged from neighbours, never across a surface's border; except
/// that facets of a curved object share their irradiance at common nodes, within one material, one room and the crease
/// angle (degrees). The vertices' values don't depend on `elements`. Throws Interrupted.
struct Reconstruction {
    VertexRadiosity B;
    MidpointRadiosity middle_B;  ///< empty: linear elements
    std::size_t rays = 0;
};
Reconstruction reconstruct(const Exchange& exchange, const LightAtPoints& light, double crease_angle,
                           const WorkMonitor& monitor = {}, Elements elements = Elements::linear);

/// B = E + ρ H at every vertex; `irradiance` begins with one value a vertex.
VertexRadiosity linear_radiosity(const Exchange& exchange, std::span<const Rgb> irradiance);

/// The means of a linear solution over the patches of its own mesh.
Radiosity patch_means(const PatchMesh& mesh, const VertexRadiosity& B);

/// Averages irradiance over vertices at one place whose surfaces have one material and normals within the crease
/// angle of the vertex's own, in one room (surface_shells()); never over copies of one surface's contact vertex.
void share_irradiance(const Exchange& exchange, double crease_angle, std::vector<Rgb>& irradiance);

}  // namespace patchlight
