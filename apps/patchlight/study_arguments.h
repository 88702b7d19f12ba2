#pragma once

#include "apps/patchlight/arguments.h"

#include <CLI/CLI.hpp>

namespace patchlight {

/// The commands of `patchlight study`; filled in while the line is parsed.
struct StudyCommands {
    StudyCheckCommand check;
    StudyRunCommand run;
    StudyCellCommand cell;
    StudyTableCommand table;
    StudyReportCommand report;
};

void add_study(CLI::App& app, StudyCommands& commands);
/// The one of them that was asked for. Throws UsageError.
Command chosen_study(const CLI::App& app, const StudyCommands& commands);

}  // namespace patchlight
