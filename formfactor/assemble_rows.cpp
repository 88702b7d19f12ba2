#include "formfactor/form_factors.h"
#include "formfactor/row_sampler.h"

namespace patchlight {

namespace {

struct CompactRow {
    std::vector<std::uint32_t> columns;
    std::vector<double> factors;
};

}  // namespace

FormFactorMatrix assemble_rows(const RowSampler& sampler, std::size_t patches, const WorkMonitor& monitor)
{
    FormFactorMatrix F;
    F.raw_sum = PatchField<double>(patches);
    F.escaped = PatchField<double>(patches);
    F.backs = PatchField<double>(patches);
    std::vector<CompactRow> rows(patches);
    F.rays = for_each_row<RowScratch>(patches, monitor, [&](std::size_t i, RowScratch& scratch) {
        sampler.patch_row(PatchId(i), scratch);
        const FormFactorRow& row = scratch.row;
        rows[i].columns.reserve(row.patches.size());
        rows[i].factors.reserve(row.patches.size());
        for (std::size_t k = 0; k < row.patches.size(); ++k) {
            rows[i].columns.push_back(row.patches[k].value);
            rows[i].factors.push_back(row.factors[k]);
        }
        F.raw_sum[PatchId(i)] = row.raw_sum;
        F.escaped[PatchId(i)] = row.escaped;
        F.backs[PatchId(i)] = row.backs;
    });
    F.row_start.reserve(patches + 1);
    F.row_start.push_back(0);
    for (const CompactRow& row : rows) F.row_start.push_back(F.row_start.back() + row.columns.size());
    F.columns.reserve(F.row_start.back());
    F.factors.reserve(F.row_start.back());
    for (CompactRow& row : rows) {
        F.columns.insert(F.columns.end(), row.columns.begin(), row.columns.end());
        F.factors.insert(F.factors.end(), row.factors.begin(), row.factors.end());
        row = {};
    }
    return F;
}

}  // namespace patchlight
