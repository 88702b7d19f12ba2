#include "formfactor/compressed_rows.h"

#include <utility>

namespace patchlight {

CompressedRows::CompressedRows(std::size_t patches) : rows_(patches)
{
    matrix_.raw_sum = PatchField<double>(patches);
    matrix_.escaped = PatchField<double>(patches);
    matrix_.backs = PatchField<double>(patches);
}

void CompressedRows::put(PatchId i, const FormFactorRow& row)
{
    Row& compact = rows_[i.value];
    compact.columns.reserve(row.patches.size());
    for (const PatchId p : row.patches) compact.columns.push_back(p.value);
    compact.factors.assign(row.factors.begin(), row.factors.end());
    matrix_.raw_sum[i] = row.raw_sum;
    matrix_.escaped[i] = row.escaped;
    matrix_.backs[i] = row.backs;
}

FormFactorMatrix CompressedRows::matrix(std::size_t rays)
{
    FormFactorMatrix F = std::exchange(matrix_, {});
    F.rays = rays;
    F.row_start.reserve(rows_.size() + 1);
    F.row_start.push_back(0);
    for (const Row& row : rows_) F.row_start.push_back(F.row_start.back() + row.columns.size());
    F.columns.reserve(F.row_start.back());
    F.factors.reserve(F.row_start.back());
    for (Row& row : rows_) {
        F.columns.insert(F.columns.end(), row.columns.begin(), row.columns.end());
        F.factors.insert(F.factors.end(), row.factors.begin(), row.factors.end());
        row = {};
    }
    rows_.clear();
    return F;
}

}  // namespace patchlight
