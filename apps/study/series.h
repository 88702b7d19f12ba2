#pragma once

#include "apps/study/study_result.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace patchlight {

/// Cells that differ along the study's `along` axis alone: one line in a plot. Without such an axis each cell is a
/// series of its own.
struct StudySeries {
    std::string name;                ///< "refine=both"; of a study with one series: its name
    std::string scene;               ///< that all its cells are of, as scene_name() has it
    std::vector<std::size_t> cells;  ///< places in StudyResult::cells, in the order of the axis
};

/// In the order of their first cells.
std::vector<StudySeries> series_of(const StudyResult& study);

/// A cell's scene, wherever its file is: as the study's axis of scenes has it; without such an axis the file's name.
std::string scene_name(const StudyResult& study, const CellResult& cell);

/// Whether a cell ran to its end and shows something: its last cycle counts as its result.
bool ran_to_its_end(const CellResult& cell);

/// Whether the study measures: without a reference the solver's estimates stand in for errors.
bool is_measured(const StudyResult& study);

/// The error that rates and comparisons are about: the measured one, or the estimate where nothing is measured.
std::optional<double> error_of(const StudyResult& study, const CycleResult& cycle);

}  // namespace patchlight
