#pragma once

#include "apps/patchlight/arguments.h"

#include <CLI/CLI.hpp>

#include <string>

namespace patchlight {

void add_study_table(CLI::App& app, StudyTableCommand& command);
void add_study_report(CLI::App& app, StudyReportCommand& command);
/// Throws UsageError.
void finish_study_report(const StudyReportCommand& command);

}  // namespace patchlight
