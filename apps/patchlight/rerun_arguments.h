#pragma once

#include "apps/patchlight/arguments.h"

#include <CLI/CLI.hpp>

#include <string>

namespace patchlight {

/// `memory` is understood once everything has been read.
void add_rerun(CLI::App& app, RerunCommand& command, std::string& memory);
/// Throws UsageError.
void finish_rerun(RerunCommand& command, const std::string& memory);

}  // namespace patchlight
