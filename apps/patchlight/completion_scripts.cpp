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

std::string bash_case(const CommandDescription& command)
{
    std::string out = fmt::format("    {})\n        case $prev in\n", command.name);
    for (const OptionDescription& option : command.options) {
        if (option.kind != ValueKind::none) {
            out += fmt::format("            {}) {}; return ;;\n", fmt::join(option.names, " | "), bash_offer(option));
        }
    }
    out += fmt::format("        esac\n        case $cur in\n            -*) _patchlight_words '{}' ;;\n",
                       all_names(command.options));
    if (!command.values.empty()) {
        out += fmt::format("            *) {} ;;\n", bash_offer(command.values.front()));
    }
    return out + "        esac ;;\n";
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
                      "    elif [ \"$cur\" = = ]; then\n        cur=\n    fi\n"
                      "    if [ \"$COMP_CWORD\" -eq 1 ]; then\n";
    out += fmt::format("        _patchlight_words '{} {}'\n        return\n    fi\n", command_names(program),
                       all_names(program.options));
    out += "    case ${COMP_WORDS[1]} in\n";
    for (const CommandDescription& command : program.commands) {
        out += bash_case(command);
    }
    return out + "    esac\n}\ncomplete -F _patchlight patchlight\n";
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

std::string zsh_script(const CommandDescription& program)
{
    std::string out = "#compdef patchlight\n# zsh completion of patchlight, written by: patchlight completion zsh\n"
                      "_patchlight() {\n    local -a commands=(\n";
    for (const CommandDescription& command : program.commands) {
        out += fmt::format("        {}\n", quoted(fmt::format("{}:{}", command.name, zsh_text(command.text))));
    }
    out += fmt::format("    )\n    if (( CURRENT == 2 )); then\n        _describe command commands\n"
                       "        compadd -- {}\n        return\n    fi\n"
                       "    shift words\n    (( CURRENT-- ))\n    case $words[1] in\n",
                       all_names(program.options));
    for (const CommandDescription& command : program.commands) {
        out += fmt::format("        {})\n            _arguments{} ;;\n", command.name, zsh_options(command));
    }
    return out +
           "    esac\n}\n"
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

std::string fish_script(const CommandDescription& program)
{
    std::string out = "# fish completion of patchlight, written by: patchlight completion fish\n"
                      "complete -c patchlight -f\n";
    for (const OptionDescription& option : program.options) {
        out += fish_line("__fish_use_subcommand", option);
    }
    for (const CommandDescription& command : program.commands) {
        out += fmt::format("complete -c patchlight -n __fish_use_subcommand -a {} -d {}\n", command.name,
                           fish_quoted(command.text));
        const std::string when = "__fish_seen_subcommand_from " + command.name;
        if (!command.values.empty()) {
            // Where no option is at work: the value by its place.
            std::string offer = fish_offer(command.values.front());
            offer = replaced(replaced(offer, " -r", ""), " -x", "");
            out += fmt::format("complete -c patchlight -n '{}'{}\n", when, offer);
        }
        for (const OptionDescription& option : command.options) {
            out += fish_line(when, option);
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
