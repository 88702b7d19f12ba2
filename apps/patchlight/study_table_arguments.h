#pragma once

#include "apps/patchlight/arguments.h"

#include <CLI/CLI.hpp>

#include <string>

namespace patchlight {

void add_study_table(CLI::App& app, StudyTableCommand& command);
void add_study_report(CLI::App& app, StudyReportCommand& command);

}  // namespace patchlight
