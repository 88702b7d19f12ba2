#pragma once

#include "formfactor/form_factors.h"
#include "solver/radiosity.h"

#include <functional>
#include <vector>

namespace patchlight {

/// F as the solvers need it: H_i = Σ_j F_ij B_j for all i, three bands at once. Rows today; links can stand here, too.
/// `H` has the size of `B`. Called from one thread; the answer must not depend on how many threads it uses.
using LightOperator = std::function<void(const Radiosity& B, Radiosity& H)>;

/// B with an empty fourth band, so that a patch's light is one aligned load.
class LightLanes {
public:
    explicit LightLanes(const Radiosity& B);

    void set(PatchId patch, const Rgb& value) { lanes_[patch.value] = {{value.r, value.g, value.b, 0}}; }
    const double* data() const { return lanes_.front().bands; }

private:
    struct alignas(32) Lanes {
        double bands[4];
    };
    std::vector<Lanes> lanes_;
};

/// Σ_j F_ij B_j of one row, three bands together: one pass over its columns and factors. The same bits on processors
/// with AVX2 and without.
Rgb gathered(const FormFactorMatrix& F, const LightLanes& B, std::size_t row);

/// The operator of a matrix's rows, on all threads. Keeps a reference to F.
LightOperator rows_of(const FormFactorMatrix& F);

/// How far A F is from symmetric: |⟨u, A F v⟩ − ⟨v, A F u⟩| over what those sums hold, for fixed u and v that look
/// random. Rounding for reciprocal rows, 1e-6 and more for sampled ones; costs one product.
double asymmetry(const LightOperator& F, const PatchField<double>& areas);

/// What asymmetry() may be for conjugate gradients, and for rows to serve as columns.
inline constexpr double reciprocal_enough = 1e-9;

}  // namespace patchlight
