#pragma once

#include "apps/run/run_folder.h"

#include <cstddef>
#include <string>
#include <vector>

namespace patchlight {

struct ReportOptions {
    std::size_t most_bytes = 3'000'000;  ///< of the page; the first and the last cycle are in it even if it gets larger
};

struct ReportPage {
    std::string html;
    std::vector<int> cycles;  ///< those that are in it
};

/// One HTML file that shows a run: its cycles in 3-D, its plots, its numbers, where they come from. It opens from disk
/// and asks nothing of the network; a content security policy says so, too. Of the cycles all are in it when they fit,
/// else the first, the last, and an even choice of the others. First and last are exact (floats), the others drawn from
/// 16-bit numbers. Seconds and threads come from timing.json, if the run has one and SOURCE_DATE_EPOCH isn't set;
/// nothing else in the page depends on clock or machine. Quadratic elements are drawn linear between their vertices.
/// Throws FolderRefused when the run has no finished cycle, SceneError when a stored file is broken.
ReportPage report_page(const OpenedRun& run, const ReportOptions& options = {});

}  // namespace patchlight
