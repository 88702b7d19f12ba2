#pragma once

#include "apps/patchlight/arguments.h"

#include <CLI/CLI.hpp>

namespace patchlight {

void add_report(CLI::App& app, ReportCommand& command);
/// Throws UsageError.
void finish_report(const ReportCommand& command);

}  // namespace patchlight
