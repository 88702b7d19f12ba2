#pragma once

#include "apps/patchlight/arguments.h"

#include <CLI/CLI.hpp>

#include <string>

namespace patchlight {

/// `cycle` is understood once everything has been read.
void add_verify(CLI::App& app, VerifyCommand& command, std::string& cycle);
/// Throws UsageError.
void finish_verify(VerifyCommand& command, const std::string& cycle);

}  // namespace patchlight
