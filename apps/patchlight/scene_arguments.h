#pragma once

#include "apps/patchlight/arguments.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace patchlight {

/// What --two-sided and --emitter said, understood once everything has been read.
struct SceneTexts {
    std::vector<std::string> two_sided, emitters;
};

/// The scene and how it is to be read.
void add_scene(CLI::App& app, SceneArguments& scene, SceneTexts& texts);
/// Throws UsageError.
void finish_scene(SceneArguments& scene, const SceneTexts& texts);

/// --threads, --quiet and --json; `json_text` says what that prints.
void add_machine(CLI::App& app, int& threads, bool& quiet, bool& json, const std::string& json_text);

/// The words of a mode, for CLI::IsMember.
template <class Mode>
std::vector<std::string> words(const ModeNames<Mode>& names)
{
    std::vector<std::string> result;
    for (const auto& entry : names) {
        result.push_back(entry.first);
    }
    return result;
}

}  // namespace patchlight
