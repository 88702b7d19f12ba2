#pragma once

#include "apps/run/run_folder.h"
#include "meshing/vectors.h"

#include <CLI/CLI.hpp>

#include <string>
#include <utility>
#include <vector>

namespace patchlight {

/// Checks of the whole text of a value, before it is converted: "1e9" is no whole number, "nan" no number.
CLI::Validator whole_between(long long low, long long high);
CLI::Validator number_between(double low, double high);
CLI::Validator number_above(double low);

/// Values made of several numbers. Throw UsageError naming the option.
std::pair<int, int> size_in(const std::string& option, const std::string& text);
Vec3 vector_in(const std::string& option, const std::string& text);
std::vector<int> shots_in(const std::string& option, const std::string& text);
/// MATERIAL=W or MATERIAL=r,g,b.
std::pair<std::string, Rgb> emitter_in(const std::string& option, const std::string& text);
WhichCycle cycle_in(const std::string& option, const std::string& text);
/// Bytes: a number and B, kB, MB, GB, TB (powers of 1000) or KiB, MiB, GiB, TiB (of 1024).
double bytes_in(const std::string& option, const std::string& text);
/// Of every --memory.
inline constexpr const char* memory_help =
    "refuse what needs more, as 8GiB or 500MB [80 % of what the machine or its control group has, at most 16GiB]";
/// Seconds: a number alone, or with s, min or h; above 0 and at most 1e9.
double seconds_in(const std::string& option, const std::string& text);
double number_in(const std::string& option, const std::string& text);

}  // namespace patchlight
