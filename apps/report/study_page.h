#pragma once

#include "apps/study/study_folder.h"
#include "apps/study/study_result.h"

#include <cstdint>
#include <string>
#include <vector>

namespace patchlight {

/// A cell from one of the study's views.
struct StudyPicture {
    std::size_t cell = 0;  ///< place in StudyResult::cells
    std::string view;      ///< as the study names it; empty: the scene's first
    std::string png;       ///< the file's bytes
};

/// A study as a page shows it.
struct ShownStudy {
    StudyResult result;
    std::string sha256;                  ///< of the study file
    std::uint64_t seed = 1;              ///< of all cells, but where they vary it
    std::vector<StudyPicture> pictures;  ///< of one exposure; in the order in which they are to be shown
};

/// One HTML file for a whole study: error against elements and seconds, all cells, their pictures, comparisons, gates,
/// and from the cells' runs in `folder` where everything comes from. It opens from disk and asks nothing of the
/// network. Without seconds (leaves_out_seconds()) it depends on the results alone. Errors are as tables.h has them.
std::string study_page(const ShownStudy& study, const StudyFolder& folder);

}  // namespace patchlight
