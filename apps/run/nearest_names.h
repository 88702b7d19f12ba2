#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

/// Insertions, deletions and changes of a byte that lead from one word to the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The names, nearest to `name` first; those equally near in their order.
std::vector<std::string> by_nearness(std::string_view name, std::vector<std::string> names);

/// `, did you mean "…"?` with the name that was probably meant; empty where none is near.
std::string did_you_mean(std::string_view name, std::span<const std::string> names);

}  // namespace patchlight
