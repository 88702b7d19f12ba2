#include "apps/patchlight/command_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace patchlight {

namespace {

constexpr std::size_t width = 80, indent = 28;

/// `text` from column `at` on, broken between words, the further lines indented.
std::string wrapped(const std::string& text, std::size_t at, std::size_t further)
{
    std::string out;
    std::size_t column = at;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (column > further && column + 1 + word.size() > width) {
            out += fmt::format("\n{:{}}", "", further);
            column = further;
        } else if (column > at || !out.empty()) {
            out += ' ';
            ++column;
        }
        out += word;
        column += word.size();
    }
    return out + "\n";
}

std::string entry(const std::string& name, const std::string& text)
{
    std::string line = "  " + name;
    line += line.size() + 2 > indent ? fmt::format("\n{:{}}", "", indent) : std::string(indent - line.size(), ' ');
    return line + wrapped(text, indent, indent);
}

std::string entries(const std::string& title, const std::vector<OptionDescription>& options)
{
    std::string out = options.empty() ? "" : fmt::format("\n{}:\n", title);
    for (const OptionDescription& option : options) {
        out += entry(signature(option), option.text + (option.required && !option.names.empty() ? " (required)" : ""));
    }
    return out;
}

/// By purpose, in the order in which purposes first come up.
std::string listed(const std::vector<CommandDescription>& commands)
{
    std::vector<std::string> purposes;
    for (const CommandDescription& command : commands) {
        if (std::ranges::find(purposes, command.purpose) == purposes.end()) {
            purposes.push_back(command.purpose);
        }
    }
    std::string out;
    for (const std::string& purpose : purposes) {
        out += fmt::format("\n{}:\n", purpose);
        for (const CommandDescription& command : commands) {
            out += command.purpose == purpose ? entry(command.name, command.text) : "";
        }
    }
    return out;
}

}  // namespace

std::string help_text(const CommandDescription& command, const std::string& program)
{
    const bool whole = !command.commands.empty();
    std::string out;
    for (const std::string& line : command.examples) {
        out += fmt::format("{} {} {}\n", out.empty() ? "Example:" : "        ", program, line);
    }
    out += fmt::format("{}{}\n{}{}", out.empty() ? "" : "\n", wrapped(command.text, 0, 0),
                       wrapped("Usage: " + usage(command), 0, 11), listed(command.commands));
    out += entries("Values", command.values);
    out += entries("Options", command.options);
    if (whole) {
        out += fmt::format("\npatchlight {}COMMAND --help tells a command's options.\n",
                           command.path.empty() ? "" : command.path + " ");
    }
    return out + (command.footer.empty() ? "" : fmt::format("\n{}\n", command.footer));
}

}  // namespace patchlight
