#include "apps/patchlight/command_description.h"

#include <fmt/format.h>

#include <sstream>

namespace patchlight {

namespace {

/// Text as roff takes it for itself: no line is an order, a minus is one that can be copied.
std::string plain(const std::string& text)
{
    std::string out;
    bool at_start = true;
    for (const char c : text) {
        if (at_start && (c == '.' || c == '\'')) {
            out += "\\&";
        }
        out += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
        at_start = c == '\n';
    }
    return out;
}

std::string verbatim(const std::vector<std::string>& lines, const std::string& before)
{
    std::string out = ".PP\n.nf\n.RS\n";
    for (const std::string& line : lines) {
        out += plain(before + line) + "\n";
    }
    return out + ".RE\n.fi\n";
}

std::string paragraph(const OptionDescription& option)
{
    const std::string required = option.required && !option.names.empty() ? " (required)" : "";
    return fmt::format(".TP\n.B {}\n{}\n", plain(signature(option)), plain(option.text + required));
}

std::string section(const CommandDescription& command)
{
    std::string out = fmt::format(".SS {}\n{}.\n", plain(usage(command)), plain(command.text));
    if (!command.examples.empty()) {
        out += verbatim(command.examples, "patchlight ");
    }
    for (const auto* options : {&command.values, &command.options}) {
        for (const OptionDescription& option : *options) {
            out += paragraph(option);
        }
    }
    if (!command.footer.empty()) {
        out += fmt::format(".PP\n{}\n", plain(command.footer));
    }
    for (const CommandDescription& inner : command.commands) {
        out += section(inner);
    }
    return out;
}

}  // namespace

std::string man_page(const CommandDescription& program, const std::string& version)
{
    std::string out = fmt::format(".TH PATCHLIGHT 1 \"\" \"patchlight {}\" \"User Commands\"\n"
                                  ".SH NAME\npatchlight \\- radiosity on adaptive meshes\n"
                                  ".SH SYNOPSIS\n.B patchlight\n.I COMMAND\n[\\fIOPTIONS\\fR]\n"
                                  ".SH DESCRIPTION\n"
                                  "Solves the light between diffuse surfaces on a mesh that is refined where it is "
                                  "wrong, and tells how wrong the answer still is. Results go to standard output, "
                                  "progress and messages to standard error.\n",
                                  plain(version));
    if (!program.examples.empty()) {
        out += std::string(".SH EXAMPLES\n") + verbatim(program.examples, "patchlight ");
    }
    out += ".SH OPTIONS\n";
    for (const OptionDescription& option : program.options) {
        out += paragraph(option);
    }
    out += ".SH COMMANDS\n";
    for (const CommandDescription& command : program.commands) {
        out += section(command);
    }
    out += fmt::format(".SH EXIT STATUS\n{}\n", plain(program.footer));
    return out + ".SH ENVIRONMENT\n"
                 ".TP\n.B NO_COLOR\nwhen set, messages have no colours on a terminal either\n"
                 ".TP\n.B COLUMNS\nhow wide the progress bar may be, where the terminal doesn't say\n";
}

}  // namespace patchlight
