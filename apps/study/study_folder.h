#pragma once

#include "apps/study/study_result.h"

#include <filesystem>
#include <string>

namespace patchlight {

/// Where a study's files are, under its output folder:
///     study.toml                    the study, as it was run last
///     study.json  table.md  table.csv   results of all cells; nothing in them depends on clock or machine
///     timing.json                   seconds of each cell's cycles
///     cells/ID/run/                 a cell's RUN, as solve writes it
///     cells/ID/measured.json        its errors against the reference, keyed by what they depend on
///     references/ID/                a reference: a RUN, or points with their radiosity
///     pictures/                     all cells from the study's views, at one exposure
///     report.html
struct StudyFolder {
    std::filesystem::path root;

    std::filesystem::path cell(const std::string& id) const { return root / "cells" / id; }
    std::filesystem::path run(const std::string& id) const { return cell(id) / "run"; }
    std::filesystem::path reference(const std::string& id) const { return root / "references" / id; }
    std::filesystem::path pictures() const { return root / "pictures"; }
};

}  // namespace patchlight
