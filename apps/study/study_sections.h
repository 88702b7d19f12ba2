#pragma once

#include "apps/study/study.h"
#include "apps/study/toml_file.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace patchlight {

/// A path that is written in a file, relative to it.
std::filesystem::path beside(const std::filesystem::path& file, const std::string& written);

/// Tables of a study file. All throw StudyError.
StudyReference reference_in(const TomlFile& toml, const TomlEntry& section, const std::filesystem::path& file,
                            const std::function<std::vector<OptionText>(const TomlEntry&)>& options_in);
/// `study` has its axes and reference already: gates that could not be measured are refused.
StudyGates gates_in(const TomlFile& toml, const TomlEntry& section, const Study& study);
std::vector<StudyComparison> comparisons_in(const TomlFile& toml, const TomlEntry& section);
StudyPictures pictures_in(const TomlFile& toml, const TomlEntry& section, const std::filesystem::path& file);
StudyLimits limits_in(const TomlFile& toml, const TomlEntry& section);

}  // namespace patchlight
