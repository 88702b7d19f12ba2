#pragma once

#include "apps/patchlight/arguments.h"

#include <CLI/CLI.hpp>

namespace patchlight {

void add_report(CLI::App& app, ReportCommand& command);

/// Where a page is written, of a run or of a study.
void add_page(CLI::App& app, PageOutput& page);
/// Throws UsageError.
void finish_page(const PageOutput& page);

}  // namespace patchlight
