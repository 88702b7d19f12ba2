#pragma once

#include "apps/patchlight/arguments.h"
#include "apps/study/study.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace patchlight {

/// The long names of solve's options, without dashes: what files may say.
OptionNames solve_option_names();

/// A study, and the bytes that it was read from.
struct ReadStudy {
    Study study;
    std::string text;
};

/// Throws StudyError.
ReadStudy read_study_file(const std::string& file);

/// The command that `patchlight solve SCENE -o RUN` with these options would be, by the same parser. `file` is where
/// the options stand: paths among them are relative to it. Throws UsageError ("usage") that begins with the file and
/// the place of the option.
SolveCommand solve_command_of(const std::string& scene, const std::string& run, std::span<const OptionText> options,
                              const std::filesystem::path& file);

/// The words of a command line for an option of a file: "--rays=64".
std::vector<std::string> words_of(const OptionText& option, const std::filesystem::path& file);

/// What was said about a command line, with the place of the option that it is about in front.
std::string with_place(const std::string& cause, std::span<const OptionText> options,
                       const std::filesystem::path& file);

}  // namespace patchlight
