#include "apps/patchlight/command_description.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace patchlight {

namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by)
{
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
        text.replace(at, what.size(), by);
    }
    return text;
}

/// Between single quotes, for bash and zsh.
std::string quoted(const std::string& text)
{
    return fmt::format("'{}'", replaced(text, "'", "'\\''"));
}

std::string fish_quoted(const std::string& text)
{
    return fmt::format("'{}'", replaced(replaced(text, "\\", "\\\\"), "'", "\\'"));
}

std::string all_names(const std::vector<OptionDescription>& options)
{
    std::vector<std::string> names;
    for (const OptionDescription& option : options) {
        names.insert(names.end(), option.names.begin(), option.names.end());
    }
    return fmt::format("{}", fmt::join(names, " "));
}

std::string command_names(const CommandDescription& program)
{
    std::vector<std::string> names;
    for (const CommandDescription& command : program.commands) {
        names.push_back(command.name);
    }
    return fmt::format("{}", fmt::join(names, " "));
}

/// What bash offers for a value.
std::string bash_offer(const OptionDescription& option)
{
    switch (option.kind) {
    case ValueKind::choice:
        return fmt::format("_patchlight_words '{}'", fmt::join(option.choices, " "));
    case ValueKind::file:
        return "_patchlight_paths -f";
    case ValueKind::folder:
        return "_patchlight_paths -d";
    default:
        return ":";
    }
}

std::string bash_cases(const CommandDescription& group, int depth, const std::string& indent);

std::string bash_case(const CommandDescription& command, int depth, const std::string& indent)
{
    std::string out = fmt::format("{}{})\n", indent, command.name);
    const std::string in = indent + "    ";
    if (!command.commands.empty()) {
        return out + bash_cases(command, depth + 1, in) + in + ";;\n";
    }
    out += in + "case $prev in\n";
    for (const OptionDescription& option : command.options) {
        if (option.kind != ValueKind::none) {
            out += fmt::format("{}    {}) {}; return ;;\n", in, fmt::join(option.names, " | "), bash_offer(option));
        }
    }
    out += fmt::format("{0}esac\n{0}case $cur in\n{0}    -*) _patchlight_words '{1}' ;;\n", in,
                       all_names(command.options));
    if (!command.values.empty()) {
        out += fmt::format("{}    *) {} ;;\n", in, bash_offer(command.values.front()));
    }
    return out + in + "esac ;;\n";
}

/// The word at `depth` names one of the group's commands: it is offered, or what stands behind it.
std::string bash_cases(const CommandDescription& group, int depth, const std::string& indent)
{
    std::string out = fmt::format("{0}if [ \"$COMP_CWORD\" -eq {1} ]; then\n{0}    _patchlight_words '{2} {3}'\n"
                                  "{0}    return\n{0}fi\n{0}case ${{COMP_WORDS[{1}]}} in\n",
                                  indent, depth, command_names(group), all_names(group.options));
    for (const CommandDescription& command : group.commands) {
        out += bash_case(command, depth, indent + "    ");
    }
    return out + indent + "esac\n";
}

std::string bash_script(const CommandDescription& program)
{
    std::string out = "# bash completion of patchlight, written by: patchlight completion bash\n"
                      "_patchlight_words() { mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$cur\"); }\n"
                      "_patchlight_paths()\n{\n"
                      "    compopt -o filenames 2>/dev/null\n"
                      "    mapfile -t COMPREPLY < <(compgen \"$1\" -- \"$cur\")\n}\n"
                      "_patchlight()\n{\n"
                      "    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]}\n"
                      "    COMPREPLY=()\n"
                      "    # --option=value comes in three words.\n"
                      "    if [ \"$prev\" = = ]; then\n        prev=${COMP_WORDS[COMP_CWORD - 2]}\n"
                      "    elif [ \"$cur\" = = ]; then\n        cur=\n    fi\n";
    return out + bash_cases(program, 1, "    ") + "}\ncomplete -F _patchlight patchlight\n";
}

/// In a description between brackets, or before a colon, these end it.
std::string zsh_text(const std::string& text)
{
    return replaced(replaced(replaced(replaced(text, "\\", "\\\\"), "[", "\\["), "]", "\\]"), ":", "\\:");
}

std::string zsh_action(const OptionDescription& option)
{
    std::string action = " ";
    switch (option.kind) {
    case ValueKind::none:
        return "";
    case ValueKind::choice:
        action = fmt::format("({})", fmt::join(option.choices, " "));
        break;
    case ValueKind::file:
        action = "_files";
        break;
    case ValueKind::folder:
        action = "_files -/";
        break;
    case ValueKind::free:
        break;
    }
    std::string out;
    for (int i = 0; i < option.values; ++i) {
        out += fmt::format(":{}:{}", zsh_text(option.value), action);
    }
    return out;
}

std::string zsh_options(const CommandDescription& command)
{
    std::string out;
    for (const OptionDescription& option : command.options) {
        for (const std::string& name : option.names) {
            const bool takes_equals = name.starts_with("--") && option.values == 1;
            out += " \\\n                " +
                   quoted(fmt::format("{}{}{}[{}]{}", option.repeats ? "*" : "", name, takes_equals ? "=" : "",
                                      zsh_text(option.text), zsh_action(option)));
        }
    }
    for (const OptionDescription& value : command.values) {
        out += " \\\n                " + quoted(zsh_action(value));
    }
    return out;
}

/// A group's commands, or what stands behind the one that was chosen.
std::string zsh_cases(const CommandDescription& group, const std::string& indent)
{
    std::string out = indent + "commands=(\n";
    for (const CommandDescription& command : group.commands) {
        out += fmt::format("{}    {}\n", indent, quoted(fmt::format("{}:{}", command.name, zsh_text(command.text))));
    }
    out += fmt::format("{0})\n{0}if (( CURRENT == 2 )); then\n{0}    _describe command commands\n"
                       "{0}    compadd -- {1}\n{0}    return\n{0}fi\n"
                       "{0}shift words\n{0}(( CURRENT-- ))\n{0}case $words[1] in\n",
                       indent, all_names(group.options));
    for (const CommandDescription& command : group.commands) {
        out += command.commands.empty() ? fmt::format("{0}    {1})\n{0}        _arguments{2} ;;\n", indent,
                                                      command.name, zsh_options(command))
                                        : fmt::format("{0}    {1})\n{2}{0}        ;;\n", indent, command.name,
                                                      zsh_cases(command, indent + "        "));
    }
    return out + indent + "esac\n";
}

std::string zsh_script(const CommandDescription& program)
{
    return "#compdef patchlight\n# zsh completion of patchlight, written by: patchlight completion zsh\n"
           "_patchlight() {\n    local -a commands\n" +
           zsh_cases(program, "    ") +
           "}\n"
           "if [[ $funcstack[1] == _patchlight ]]; then _patchlight \"$@\"; else compdef _patchlight patchlight; fi\n";
}

std::string fish_offer(const OptionDescription& option)
{
    switch (option.kind) {
    case ValueKind::none:
        return "";
    case ValueKind::choice:
        return fmt::format(" -x -a '{}'", fmt::join(option.choices, " "));
    case ValueKind::file:
        return " -r -F";
    case ValueKind::folder:
        return " -x -a '(__fish_complete_directories)'";
    case ValueKind::free:
        break;
    }
    return " -x";
}

std::string fish_line(const std::string& when, const OptionDescription& option)
{
    std::string line = fmt::format("complete -c patchlight -n '{}'", when);
    for (const std::string& name : option.names) {
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    }
    return line + fish_offer(option) + " -d " + fish_quoted(option.text) + "\n";
}

/// When a command's options are offered: it was named, and no group that may have another of its name.
std::string fish_when(const CommandDescription& program, const CommandDescription& command)
{
    std::string when = "__fish_seen_subcommand_from " + command.name;
    for (const CommandDescription& group : program.commands) {
        if (std::ranges::find(group.commands, command.name, &CommandDescription::name) != group.commands.end()) {
            when += "; and not __fish_seen_subcommand_from " + group.name;
        }
    }
    return when;
}

/// The commands of a group are offered when `before` holds.
std::string fish_commands(const CommandDescription& group, const std::string& before)
{
    std::string out;
    for (const CommandDescription& command : group.commands) {
        out += fmt::format("complete -c patchlight -n '{}' -a {} -d {}\n", before, command.name,
                           fish_quoted(command.text));
    }
    return out;
}

/// What stands behind a command.
std::string fish_values(const CommandDescription& command, const std::string& when)
{
    std::string out;
    if (!command.values.empty()) {
        // Where no option is at work: the value by its place.
        std::string offer = fish_offer(command.values.front());
        offer = replaced(replaced(offer, " -r", ""), " -x", "");
        out += fmt::format("complete -c patchlight -n '{}'{}\n", when, offer);
    }
    for (const OptionDescription& option : command.options) {
        out += fish_line(when, option);
    }
    return out;
}

std::string fish_script(const CommandDescription& program)
{
    std::string out = "# fish completion of patchlight, written by: patchlight completion fish\n"
                      "complete -c patchlight -f\n";
    for (const OptionDescription& option : program.options) {
        out += fish_line("__fish_use_subcommand", option);
    }
    out += fish_commands(program, "__fish_use_subcommand");
    for (const CommandDescription& command : program.commands) {
        const std::string when = fish_when(program, command);
        if (command.commands.empty()) {
            out += fish_values(command, when);
            continue;
        }
        out += fish_commands(command,
                             fmt::format("{}; and not __fish_seen_subcommand_from {}", when, command_names(command)));
        for (const CommandDescription& inner : command.commands) {
            out += fish_values(inner, when + "; and __fish_seen_subcommand_from " + inner.name);
        }
    }
    return out;
}

}  // namespace

std::string completion_script(const CommandDescription& program, const std::string& shell)
{
    if (shell == "zsh") {
        return zsh_script(program);
    }
    return shell == "fish" ? fish_script(program) : bash_script(program);
}

}  // namespace patchlight
