#pragma once

#include "solver/element_light.h"
#include "solver/emitted_light.h"
#include "solver/estimate.h"
#include "solver/hit_rows.h"

#include <memory>

namespace patchlight {

/// Irradiance by all light but the emitters' own (where that is known apart), quadratic on a mesh of its own: it varies
/// otherwise than direct light, slowly behind shadows, fast toward the room's edges, and is much dearer.
class IndirectLight {
public:
    /// Without values at the middles of edges: linear.
    IndirectLight(PatchMesh mesh, VertexField<Rgb> at_vertices, MidpointRadiosity at_middles = {});

    /// W/m² at a point; 0 on a surface without patches.
    Rgb at(const Scene& scene, const SurfacePoint& point) const;

    const PatchMesh& mesh() const { return *mesh_; }

    double mesh_error = 0;  ///< √∫|ρ ΔH|² dA that its mesh leaves, W/m²·m
    double noise = 0;       ///< and that its rays leave
    std::size_t rays = 0;   ///< traced for it
    int vertex_rays = 0;    ///< at each vertex at the end

    double error() const;

private:
    // Where they are, they stay: the locator refers to the mesh.
    std::unique_ptr<const PatchMesh> mesh_;
    std::unique_ptr<const PatchLocator> locator_;
    VertexField<Rgb> at_vertices_;
    MidpointRadiosity at_middles_;
};

struct IndirectOptions {
    double target_error = 0;          ///< of the whole solution, relative; 0: as good as the budget's mesh
    std::size_t max_elements = 8000;  ///< of the whole solution's mesh: half of them for this one
    int rays = 0;                     ///< at each vertex at the end, 16 … 65536; 0: as many as the error asks for
    int rough_rays = 128;             ///< while its mesh is refined
    HemisphereDirections directions = HemisphereDirections::stratified;
    GatherOptions gather;  ///< seed, and shadow rays where direct light is sampled
    MarkOptions mark;
};

/// What the patches of a coarse mesh know: a solution of the whole system, per patch.
struct RoughSolution {
    const Exchange& exchange;
    const RadiositySystem& system;
    const Radiosity& B;
};

/// Solves the indirect light. First that of the rough solution, averaged at its vertices. Then, from a coarse mesh with
/// the contact lines, cycles of gathering with `rough_rays` at nodes and centroids and halving edges, until the mesh
/// leaves 0.4 of the target error or half the budget is used. Then twice all rays, from the light of the sweep before:
/// each sweep adds a bounce of linear light. What rays meet is linear light on a mesh refined for the emitters' light.
/// The noise is measured: some hundred points gathered twice, with other directions.
/// Depends on the scene and the options alone. Throws Interrupted.
IndirectLight solve_indirect(const RoughSolution& rough, const EmittedLight& emitted, const IndirectOptions& options,
                             const WorkMonitor& monitor = {});

}  // namespace patchlight
