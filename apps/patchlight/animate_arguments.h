#pragma once

#include "apps/patchlight/arguments.h"

#include <CLI/CLI.hpp>

#include <string>

namespace patchlight {

/// Words that are only understood once everything has been read.
struct AnimateTexts {
    std::string what = "cycles", size, exposure = "auto";
    CLI::Option* frames = nullptr;
    CLI::Option* delay = nullptr;
};

void add_animate(CLI::App& app, AnimateCommand& command, AnimateTexts& texts);
/// Throws UsageError.
void finish_animate(AnimateCommand& command, const AnimateTexts& texts);

}  // namespace patchlight
