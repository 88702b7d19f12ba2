#pragma once

#include "apps/run/run_options.h"
#include "solver/discontinuities.h"

#include <string>
#include <vector>

namespace patchlight {

/// The scene's discontinuity lines with the jumps of its emitters' light, the strongest first: those that change
/// the light most a hundredth of the scene's diameter away, see strength().
std::vector<Discontinuity> strongest_lines(const Scene& scene);

/// One object a line: kind, surface, object (or material, where objects have no names), from and to (the scene file's
/// coordinates), value (W/m²), slope (W/m³), second (W/m⁴).
Json json_of(const Scene& scene, const std::vector<Discontinuity>& lines);

/// Count and length by kind, then a row for each of the first twenty lines.
std::string table_of(const Scene& scene, const std::vector<Discontinuity>& lines);

}  // namespace patchlight
