#pragma once

#include "apps/patchlight/arguments.h"
#include "apps/patchlight/scene_arguments.h"

#include <CLI/CLI.hpp>

namespace patchlight {

/// Words of solve's that are only understood once everything has been read.
struct SolveTexts {
    SceneTexts scene;
    std::string refine = "both", direct = "exact", elements = "linear", solver = "gauss-seidel", method = "hemisphere",
                indicator = "residual", marking = "doerfler", directions = "stratified", order = "unshot-power",
                pictures = "all", memory, time, size, snapshots;
    double max_edge = 0;
    CLI::Option* max_elements_option = nullptr;
    CLI::Option* tolerance_option = nullptr;
};

/// All of solve's options but those of the machine. `c` and `t` are filled in while `app` parses.
void add_solve(CLI::App& app, SolveCommand& c, SolveTexts& t);

/// Throws UsageError ("usage").
void finish_solve(SolveCommand& c, const SolveTexts& t);

}  // namespace patchlight
