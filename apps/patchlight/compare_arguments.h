#pragma once

#include "apps/patchlight/false_color_arguments.h"

namespace patchlight {

/// Words that are only understood once everything has been read.
struct CompareTexts {
    std::string size, exposure = "auto";
    std::vector<std::string> limits;
    FalseColorTexts false_color;
};

void add_compare(CLI::App& app, CompareCommand& command, CompareTexts& texts);
/// Throws UsageError.
void finish_compare(CompareCommand& command, const CompareTexts& texts);

}  // namespace patchlight
