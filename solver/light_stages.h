#pragma once

#include "solver/adaptive_options.h"
#include "solver/indirect_light.h"
#include "solver/kept_rows.h"
#include "solver/stages.h"

#include <optional>
#include <vector>

namespace patchlight {

/// The emitters' light, as far as it is asked for, and where it breaks off. Depends on the scene alone.
struct Emitted {
    std::optional<DirectLight> exact;  ///< also where only the lines need it
    bool uses_exact = false;           ///< else their light is sampled
    EmittedLight light;
    std::vector<Discontinuity> lines;

    /// For Exchange; null: sampled.
    const DirectLight* direct() const { return uses_exact && exact ? &*exact : nullptr; }
};

/// By emitters_light() and discontinuities(). Stages "direct" and "lines"; throws Interrupted.
Emitted emitted_light(const Scene& scene, const AdaptiveOptions& options, Stages& stages);

/// The equations of a mesh's patches, as options.final.solver wants them: without rows for links, made reciprocal for
/// conjugate gradients. `kept`: rows to use, or to be filled in. Stage "assemble"; throws Interrupted.
RadiositySystem assemble_patches(const Exchange& exchange, const AdaptiveOptions& options, Stages& stages,
                                 KeptRows* kept = nullptr);

/// The patches of one mesh, solved.
struct PatchSolution {
    Radiosity B;
    SolveReport report;
    EnergyBalance energy;
    std::size_t rays = 0;  ///< those of the rows, too
};

/// Solves (I − diag(ρ)F)B = E with all bounces. Where the emitters' light is known exactly, for the reflected part:
/// R = ρ H_direct + ρ F R. `system` is assemble_patches() of the same exchange and options, and afterwards what it was:
/// only in between its E is that of the equation solved. Stage "solve"; throws Interrupted.
PatchSolution solve_patches(const Exchange& exchange, RadiositySystem& system, const AdaptiveOptions& options,
                            Stages& stages);

/// What lights a mesh: the emitters, and the indirect light that follows from the solved patches of the uniform mesh.
/// Solved once, whatever the cycles; depends on scene and options alone. Keeps references to all it is made from, but
/// for the options.
class Lighting {
public:
    /// `system` and `patches` are those of `coarse`. Stages "importance", where something is looked at, and "indirect";
    /// throws Interrupted. `kept`, with Refine::none: rows of the nodes to use, or to be filled in.
    Lighting(const Exchange& coarse, const Emitted& emitted, const RadiositySystem& system,
             const PatchSolution& patches, const AdaptiveOptions& options, Stages& stages, KeptRows* kept = nullptr);

    /// Traced for it, and for the patches.
    std::size_t rays() const { return patches_.rays + (indirect_ ? indirect_->rays : 0); }

    /// The light at a mesh's nodes: the emitters', found anew at each point, and the indirect; with Refine::none by
    /// `gather_rays` rays to the patches of the uniform mesh, `kept` being their rows. Keeps references to all of them.
    LightAtPoints on(const Exchange& exchange, int gather_rays, FormFactorMatrix* kept = nullptr) const;

    /// The error of a mesh, and the linear reconstruction it was found with (see evaluate()). Stage "estimate"; throws
    /// Interrupted.
    Evaluation evaluated(const Exchange& exchange, const AdaptiveOptions& options, Stages& stages) const;

    /// The last mesh's nodes: on the uniform mesh with all rays, and for quadratic elements at the middles of edges,
    /// too; else those of the evaluation, `found`. Stage "gather"; throws Interrupted.
    Reconstruction final_nodes(const Exchange& exchange, Reconstruction found, const AdaptiveOptions& options,
                               Stages& stages) const;

    /// The error as far as it counts for what is looked at.
    ErrorEstimate counted(const PatchMesh& mesh, const ErrorEstimate& error) const;

    /// Where the light of a solution goes, by the rows of the uniform mesh; by links, where that of its patches does.
    EnergyBalance energy(const PatchMesh& mesh, const PatchLocator& locator, const Radiosity& B) const;

private:
    Exchange coarse_;
    const Emitted& emitted_;
    const RadiositySystem& system_;
    const PatchSolution& patches_;
    GatherOptions gather_;
    KeptRows* kept_;
    PatchField<double> weights_;  ///< how much the patches count for what is looked at; empty: all alike
    std::optional<IndirectLight> indirect_;
};

}  // namespace patchlight
