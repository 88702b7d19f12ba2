#pragma once

#include "apps/patchlight/arguments.h"

#include <CLI/CLI.hpp>

#include <string>

namespace patchlight {

/// Words that are only understood once everything has been read.
struct FalseColorTexts {
    std::string quantity, show = "radiosity", range, scale;
};

/// --false-color, --range, --scale and --isolines.
void add_false_color(CLI::App& app, FalseColorArguments& arguments, FalseColorTexts& texts);
/// These, and --show.
void add_false_color_and_show(CLI::App& app, FalseColorArguments& arguments, FalseColorTexts& texts);
/// Throws UsageError.
void finish_false_color(FalseColorArguments& arguments, const FalseColorTexts& texts);

}  // namespace patchlight
