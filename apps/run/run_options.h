#pragma once

#include "meshing/read_scene.h"
#include "solver/adaptive.h"

#include <nlohmann/json.hpp>

#include <string>
#include <utility>
#include <vector>

namespace patchlight {

/// Keys stay in the order they are written.
using Json = nlohmann::ordered_json;

/// A mode and the word that the command and the files have for it.
template <class Mode>
using ModeNames = std::vector<std::pair<std::string, Mode>>;

const ModeNames<Refine>& refine_names();
const ModeNames<Direct>& direct_names();
const ModeNames<Elements>& element_names();
const ModeNames<Solver>& solver_names();
/// Those that a solve offers.
const ModeNames<FormFactorMethod>& form_factor_names();
/// All.
const ModeNames<FormFactorMethod>& form_factor_method_names();
const ModeNames<Indicator>& indicator_names();
const ModeNames<Marking>& marking_names();
const ModeNames<HemisphereDirections>& direction_names();
const ModeNames<ShootingOrder>& order_names();
const ModeNames<Stage>& stage_names();

/// The word for a mode.
template <class Mode>
std::string name_of(const ModeNames<Mode>& names, Mode mode)
{
    for (const auto& [name, value] : names) {
        if (value == mode) {
            return name;
        }
    }
    return "unknown";
}

/// The mode of a word. Throws std::invalid_argument.
template <class Mode>
Mode mode_of(const ModeNames<Mode>& names, const std::string& word)
{
    for (const auto& [name, value] : names) {
        if (name == word) {
            return value;
        }
    }
    throw std::invalid_argument("unknown word \"" + word + "\"");
}

/// The effective options as they are written into every result; lengths in metres, angles in degrees.
Json json_of(const AdaptiveOptions& options);
/// The way back; a mesh and what is looked at are not in it. Throws SceneError ("run") for what is missing, of another
/// type or an unknown word.
AdaptiveOptions adaptive_options_in(const Json& json);
Json json_of(const SceneOptions& options);
SceneOptions scene_options_in(const Json& json);
Json json_of(const View& view);
/// Throws SceneError ("run"). The aspect is the picture's own unless the JSON has one.
View view_in(const Json& json);
Json json_of(const Rgb& value);

}  // namespace patchlight
