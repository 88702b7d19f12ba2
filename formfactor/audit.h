#pragma once

#include "formfactor/form_factors.h"
#include "meshing/fields.h"

#include <cstddef>
#include <vector>

namespace patchlight {

/// How far rows are from summing to 1: |1 − Σ_j F_ij − backs_i − escaped_i|.
struct ClosureDefect {
    double mean = 0;  ///< plain, over the rows
    double worst = 0;
    PatchId worst_patch;  ///< invalid when there is no row
};

/// How far A_i F_ij is from A_j F_ji: |A_i F_ij − A_j F_ji| / max(A_i Σ_k F_ik, A_j Σ_k F_jk), the area exchanged one
/// way too little, as part of all that the larger of the two patches exchanges.
struct ReciprocityDefect {
    double mean = 0;  ///< plain, over the pairs that have a factor either way
    double worst = 0;
    PatchId first, second;  ///< the worst pair; invalid when no pair has a defect
    std::size_t pairs = 0;
};

struct NamedFactor {
    PatchId row, column;
    double factor = 0;
};

/// What can be seen of a matrix alone, without knowing the true factors. Plain data.
struct FormFactorAudit {
    std::size_t rows = 0, entries = 0;
    std::size_t zero_rows = 0;  ///< without a factor above 0
    ClosureDefect closure;
    ReciprocityDefect reciprocity;
    std::size_t outside_count = 0;     ///< factors below 0, or above 1 by more than 1e-12
    std::vector<NamedFactor> outside;  ///< the first eight of them, row by row
    std::size_t non_finite_count = 0;  ///< left out of everything else
    std::vector<NamedFactor> non_finite;
    std::size_t own_count = 0;  ///< F_ii that aren't 0, which planar patches can't have
};

/// Looks at every factor. In a closed scene nothing escapes, whatever the method says of it. In an open one, where
/// the method doesn't know what escapes (`matrix.escaped` is empty), only a sum above 1 counts. An empty
/// `matrix.backs` stands for 0. A matrix whose rows aren't ascending is copied once; else nothing is.
/// Throws std::invalid_argument when the areas are not the matrix's, or a column is past the end.
FormFactorAudit audit(const FormFactorMatrix& matrix, const PatchField<double>& areas, bool closed);

/// Puts the columns of every row in ascending order.
void sort_columns(FormFactorMatrix& matrix);

/// Fᵀ: factors only, columns ascending.
FormFactorMatrix transposed(const FormFactorMatrix& matrix);

/// What a repair did.
struct RepairReport {
    ClosureDefect closure_before, closure_after;
    ReciprocityDefect reciprocity_before, reciprocity_after;
    std::size_t iterations = 0;     ///< of scaling
    bool converged = true;          ///< false: some rows could not be scaled to their sums
    std::size_t added = 0;          ///< factors that were 0 and whose opposite was not
    double largest_row_change = 0;  ///< max_i Σ_j |F'_ij − F_ij|
    double largest_scaling = 0;     ///< max |d_i d_j − 1|: the largest relative change after symmetrising
};

/// Makes a matrix reciprocal and its rows sum to 1, without breaking either for the other:
/// G_ij = (A_i F_ij + A_j F_ji)/2, then G'_ij = d_i G_ij d_j with d > 0 such that
/// Σ_j G'_ij + d_i A_i escaped_i = A_i (1 − backs_i), by the symmetric iteration d_i ← d_i √(target_i / sum_i)
/// [KnightRuizUcar14], until every row is within 1e-12 of its sum or 1,000 times; F'_ij = G'_ij / A_i. In a closed
/// scene nothing escapes; in an open one what escapes is scaled along, and taken from the rows' sums where the method
/// doesn't know it. Factors stay ≥ 0, and what is 0 both ways stays 0. Rows are ascending afterwards, and
/// `matrix.escaped` is what was scaled; `matrix.backs` changes only in rows that were nothing but backs. It removes no
/// error of single factors: it only spreads them so that no power is made or lost. Needs three times the memory of the
/// matrix beside it. Throws std::invalid_argument as audit() does, and for factors that are negative or not finite.
RepairReport repair_symmetrically(FormFactorMatrix& matrix, const PatchField<double>& areas, bool closed);

}  // namespace patchlight
