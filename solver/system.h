#pragma once

#include "formfactor/form_factors.h"
#include "solver/radiosity.h"

namespace patchlight {

/// (I − diag(ρ)F) B = E on a patch mesh: row i gathers, B_i = E_i + ρ_i Σ_j F_ij B_j. Three bands at once.
struct RadiositySystem {
    PatchField<double> area;  ///< m²
    PatchField<Rgb> E;        ///< W/m²
    PatchField<Rgb> rho;
    FormFactorMatrix F;
};

}  // namespace patchlight
