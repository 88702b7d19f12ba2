#pragma once

#include "apps/patchlight/arguments.h"

#include <CLI/CLI.hpp>

#include <string>

namespace patchlight {

/// Words that are only understood once everything has been read.
struct ExportTexts {
    std::string cycle = "last", quantity = "radiosity";
    CLI::Option* cycle_option = nullptr;
    CLI::Option* size_option = nullptr;
};

void add_export(CLI::App& app, ExportCommand& c, ExportTexts& t);
void finish_export(ExportCommand& c, const ExportTexts& t);

}  // namespace patchlight
