#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace patchlight {

/// What can stand where a value is asked for.
enum class ValueKind { none, free, choice, file, folder };

/// An option, or a value that stands for itself.
struct OptionDescription {
    std::vector<std::string> names;  ///< as typed: "-o", "--refine"; empty: a value by its place
    std::string value;               ///< what stands for its value: "N", "RUN"; empty: there is none
    int values = 0;                  ///< words it takes
    ValueKind kind = ValueKind::free;
    std::vector<std::string> choices;
    std::string text;  ///< what it does, and in brackets what is done without it
    bool required = false;
    bool repeats = false;
};

/// All that help, manual page and completions know of a command.
struct CommandDescription {
    std::string name, text, footer;
    std::string path;                   ///< the words behind the program: "study check"; empty: the program
    std::string purpose;                ///< the group that it is listed in
    std::vector<std::string> examples;  ///< command lines without the program, for the repository's root
    std::vector<OptionDescription> values, options;
    std::vector<CommandDescription> commands;
};

/// What the parser knows, and the commands' examples, in the order in which they were added.
CommandDescription described(const CLI::App& app);

/// "-o RUN", "--refine none|both", "SCENE": what is typed.
std::string signature(const OptionDescription& option);

/// "patchlight solve SCENE -o RUN [OPTIONS]"
std::string usage(const CommandDescription& command);

/// For a terminal of 80 columns. `program` is what examples begin with; `command` is the whole program, a group of
/// commands or one of them.
std::string help_text(const CommandDescription& command, const std::string& program);

/// The manual page, for groff's man macros; `version` stands in its footer.
std::string man_page(const CommandDescription& program, const std::string& version);

/// What a shell reads to complete the command's lines: `shell` is bash, zsh or fish.
std::string completion_script(const CommandDescription& program, const std::string& shell);

}  // namespace patchlight
