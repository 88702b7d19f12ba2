#include "formfactor/compressed_rows.h"
#include "formfactor/form_factors.h"
#include "formfactor/row_sampler.h"

namespace patchlight {

FormFactorMatrix assemble_rows(const RowSampler& sampler, std::size_t patches, const WorkMonitor& monitor)
{
    CompressedRows rows(patches);
    const std::size_t rays = for_each_row<RowScratch>(patches, monitor, [&](std::size_t i, RowScratch& scratch) {
        sampler.patch_row(PatchId(i), scratch);
        rows.put(PatchId(i), scratch.row);
    });
    return rows.matrix(rays);
}

}  // namespace patchlight
