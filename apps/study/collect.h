#pragma once

#include "apps/run/file_writer.h"
#include "apps/study/study_folder.h"
#include "apps/study/study_result.h"

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

namespace patchlight {

/// A cell of which is known where it stands.
struct PlannedCell {
    StudyCell cell;
    std::string id;         ///< of its folder
    std::string reference;  ///< its reference's folder; empty: none
    std::string problem;    ///< why it can't be run; `id` is empty then
};

/// A study with all its cells' places: depends on the study's file and the scenes alone.
struct StudyPlan {
    Study study;
    std::string sha256;      ///< of the study's file
    std::uint64_t seed = 1;  ///< of all cells, but where they vary it
    std::vector<PlannedCell> cells;
};

/// Why a cell isn't done that was run: what `study run` leaves beside it, and takes away when it is run again.
struct CellOutcome {
    CellStatus status = CellStatus::failed;  ///< or over_time
    std::string message;
};
void write_outcome(const StudyFolder& folder, const std::string& id, const CellOutcome& outcome, FileWriter& writer);
void remove_outcome(const StudyFolder& folder, const std::string& id);

/// What the study came to so far: cells that haven't begun, are being run or can't be read included. Reads only, and
/// measures anew what isn't kept, unless there is a `writer` to keep it. Throws PointsError for broken probes,
/// SceneError for a broken reference, Interrupted.
StudyResult collect(const StudyPlan& plan, const StudyFolder& folder, FileWriter* writer = nullptr,
                    const std::stop_token& stop = {});

}  // namespace patchlight
