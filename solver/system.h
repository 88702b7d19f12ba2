#pragma once

#include "formfactor/direct_light.h"
#include "formfactor/row_sampler.h"
#include "solver/radiosity.h"

#include <memory>
#include <optional>
#include <vector>

namespace patchlight {

/// What light is exchanged over: the scene, its visibility, and the patch mesh of one cycle. References must outlive
/// it.
struct Exchange {
    const Scene& scene;
    const RayCaster& caster;
    const PatchMesh& mesh;
    const PatchLocator& locator;
    const DirectLight* direct = nullptr;  ///< emitters' light exactly; null: sampled like all else
};

/// The surfaces that emit.
std::vector<SurfaceId> emitters(const Scene& scene);

/// Exact light of the scene's emitters, in the order of emitters(); nothing when more than 500 surfaces emit, or
/// few in a scene so large that finding what hides them would not end (10,000 surfaces and 300 emitters).
std::optional<DirectLight> emitters_light(const Scene& scene, const WorkMonitor& monitor = {});

/// The emitters' light that arrives at a point, exactly, W/m².
Rgb direct_irradiance(const Scene& scene, const DirectLight& direct, const Vec3& place, SurfaceId surface,
                      DirectLight::Scratch& scratch);

/// (I − diag(ρ)F) B = E on a patch mesh: row i gathers, B_i = E_i + ρ_i Σ_j F_ij B_j. Three bands at once.
struct RadiositySystem {
    PatchField<double> area;  ///< m²
    PatchField<Rgb> E;        ///< W/m²
    PatchField<Rgb> rho;
    PatchField<Rgb> direct;  ///< the emitters' light at each patch, exactly (W/m², mean); empty: F brings it
    FormFactorMatrix F;      ///< empty when rows are only computed on demand
};

/// B = E.
Radiosity emittance(const Scene& scene, const PatchMesh& mesh);

/// Areas, E, ρ and exact direct light of every patch (the mean of three points inside); no form factors yet.
RadiositySystem unassembled(const Exchange& exchange);

/// The whole system with its sampled rows: `kept` where that holds them; where it is empty, it is filled. Throws
/// Interrupted.
RadiositySystem assemble(const Exchange& exchange, const FormFactorOptions& options, const WorkMonitor& monitor = {},
                         FormFactorMatrix* kept = nullptr);

/// Where the light went, W, three bands together. emitted = absorbed + escaped, but for the error.
struct EnergyBalance {
    double emitted = 0;            ///< Σ A E
    double absorbed = 0;           ///< Σ A (1 − ρ) H, and what met black backs
    double escaped = 0;            ///< what met nothing
    double relative_residual = 0;  ///< (emitted − absorbed − escaped) / emitted; raw, nothing is normalised
};

/// From the gathered irradiance, H = F B or direct light + F (B − E), and the rows' own escape; needs an assembled
/// system.
EnergyBalance energy_balance(const RadiositySystem& system, const Radiosity& B);

}  // namespace patchlight
