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
    IndirectLight(std::shared_ptr<const PatchMesh> mesh, VertexField<Rgb> at_vertices,
                  MidpointRadiosity at_middles = {});

    /// W/m² at a point; 0 on a surface without patches.
    Rgb at(const Scene& scene, const SurfacePoint& point) const;

    const std::shared_ptr<const PatchMesh>& mesh() const { return mesh_; }

    double mesh_error = 0;  ///< √∫|ρ ΔH|² dA that its mesh leaves, W/m²·m
    double noise = 0;       ///< and that its rays leave
    std::size_t rays = 0;   ///< traced for it
    int vertex_rays = 0;    ///< at each node

    double error() const;

private:
    // Where they are, they stay: the locator refers to the mesh.
    std::shared_ptr<const PatchMesh> mesh_;
    std::unique_ptr<const PatchLocator> locator_;
    VertexField<Rgb> at_vertices_;
    MidpointRadiosity at_middles_;
};

struct IndirectOptions {
    double target_error = 0;          ///< of the whole solution, relative; 0: as good as the budget's mesh
    std::size_t max_elements = 8000;  ///< of the whole solution's mesh: half of them for this one
    int rays = 0;                     ///< at each node, 32 … 65536; 0: as many as the error asks for
    HemisphereDirections directions = HemisphereDirections::stratified;
    GatherOptions gather{};  ///< seed, and shadow rays where direct light is sampled
    MarkOptions mark{};
};

/// What the patches of a coarse mesh know: a solution of the whole system, per patch.
struct RoughSolution {
    const Exchange& exchange;
    const RadiositySystem& system;
    const Radiosity& B;
    const PatchField<double>* weights = nullptr;  ///< how much each patch's error counts (see importance.h); null: 1
};

/// Solves the indirect light. First that of the rough solution, averaged at its vertices. Then, from a coarse mesh with
/// the contact lines, cycles of gathering at nodes and halving edges, until linear elements would miss 1.2 of the
/// target error (0.8 where there is only a budget), quadratic ones some 0.4, or half the budget is used; light is
/// gathered twice, by other rays, half of them each, so that noise isn't taken for error. Then two sweeps over the kept
/// hits, one where they aren't all kept, from the light of the sweep before, a bounce each. What rays meet is quadratic
/// light on a mesh refined for the emitters' light. Without a number of rays a pilot of some hundred points finds how
/// many leave 0.4 of the target error, 512 at least where there is only a budget. Both errors, what elements and what
/// rays miss, are measured at the end. Depends on the scene and the options alone. Throws Interrupted.
IndirectLight solve_indirect(const RoughSolution& rough, const EmittedLight& emitted, const IndirectOptions& options,
                             const WorkMonitor& monitor = {});

}  // namespace patchlight
