#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

/// The group a command is listed in, and lines to try, without the program's name: they run one after the other in the
/// repository's root.
struct CommandExamples {
    std::string_view command;  ///< as "study check"; empty: the program itself
    std::string_view purpose;
    std::vector<std::string> lines;
};

/// In the order in which they can be tried.
const std::vector<CommandExamples>& command_examples();

}  // namespace patchlight
