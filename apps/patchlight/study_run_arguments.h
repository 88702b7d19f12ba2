#pragma once

#include "apps/patchlight/arguments.h"

#include <CLI/CLI.hpp>

namespace patchlight {

void add_study_run(CLI::App& app, StudyRunCommand& command);
void add_study_cell(CLI::App& app, StudyCellCommand& command);

}  // namespace patchlight
