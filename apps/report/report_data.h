#pragma once

#include "apps/report/report_payload.h"
#include "apps/run/run_folder.h"

#include <vector>

namespace patchlight {

/// What a page knows: a description, and the arrays that it points into.
struct ReportData {
    Json description;
    ReportPayload payload;
    std::vector<int> cycles;  ///< those that are in it
};

/// Gathers a run. Of its cycles the first and the last are always in it, of the others as many as `payload_bytes` leave
/// room for, evenly chosen. Throws as report_page().
ReportData report_data(const OpenedRun& run, std::size_t payload_bytes);

/// Of cycles with so many bytes each, the places of those to keep: first and last, and of the others the largest even
/// choice whose sum with these isn't above `most`.
std::vector<std::size_t> even_choice(const std::vector<std::size_t>& bytes, std::size_t most);

}  // namespace patchlight
