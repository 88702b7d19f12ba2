#pragma once

#include "apps/patchlight/arguments.h"
#include "apps/patchlight/scene_arguments.h"

#include <CLI/CLI.hpp>

#include <string>
#include <utility>
#include <vector>

namespace patchlight {

/// An option that only some methods have, with --between and for the whole matrix.
struct MethodOption {
    CLI::Option* option = nullptr;
    std::vector<FormFactorMethod> between;
    std::vector<FormFactorMethod> matrix;
};

/// What is understood once everything has been read.
struct FormFactorTexts {
    SceneTexts scene;
    std::string method = "exact", directions = "stratified", repair = "none", memory;
    std::pair<std::string, std::string> between;
    std::size_t rays = 0;
    int resolution = 0;
    double tolerance = 0, max_edge = 0;
    std::size_t max_elements = 2000;
    CLI::Option* between_option = nullptr;
    CLI::Option* max_elements_option = nullptr;
    std::vector<MethodOption> bound;  ///< to a method or to one of both ways
};

void add_form_factors(CLI::App& app, FormFactorsCommand& command, FormFactorTexts& texts);
/// Throws UsageError, for an option that the chosen method would not look at, too.
void finish_form_factors(FormFactorsCommand& command, const FormFactorTexts& texts);

void add_validate(CLI::App& app, ValidateCommand& command, std::string& method);
void finish_validate(ValidateCommand& command, const std::string& method);

}  // namespace patchlight
