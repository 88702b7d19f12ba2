#include "apps/patchlight/command_description.h"

#include "apps/patchlight/command_examples.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

namespace patchlight {

namespace {

std::vector<std::string> split(const std::string& text, char at)
{
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, at);) {
        parts.push_back(part);
    }
    return parts;
}

/// CLI11 keeps a check's words only in the type that it shows: "TEXT:{none,both}".
std::vector<std::string> choices_in(const std::string& type)
{
    const std::size_t begin = type.find(":{"), end = type.rfind('}');
    if (begin == std::string::npos || end == std::string::npos || end < begin) {
        return {};
    }
    return split(type.substr(begin + 2, end - begin - 2), ',');
}

ValueKind kind_of(const std::string& type)
{
    ValueKind kind = ValueKind::free;
    for (const std::string& word : split(type, '|')) {
        // A file's completion offers folders, too.
        if (word.starts_with("FILE") || word == "SCENE" || word == "IMAGE" || word == "STUDY") {
            return ValueKind::file;
        }
        if (word == "DIR" || word.starts_with("RUN")) {
            kind = ValueKind::folder;
        }
    }
    return kind;
}

std::string excluded_by(const CLI::Option& option)
{
    std::vector<std::string> names;
    for (const CLI::Option* other : option.get_excludes()) {
        names.push_back(other->get_name());
    }
    std::ranges::sort(names);
    return names.empty() ? "" : fmt::format("; not with {}", fmt::join(names, ", "));
}

/// The texts end in brackets where they tell what is done without the option: a default goes there, too.
std::string text_of(const CLI::Option& option, const std::vector<std::string>& choices)
{
    std::string text = option.get_description(), without;
    if (const std::size_t bracket = text.rfind(" ["); bracket != std::string::npos && text.ends_with(']')) {
        without = text.substr(bracket);
        text.resize(bracket);
    }
    if (const std::string word = option.get_default_str(); !word.empty()) {
        without = fmt::format(" [{}]", word);
    }
    constexpr std::size_t readable = 50;
    if (const std::string all = fmt::format("{}", fmt::join(choices, ", ")); all.size() > readable) {
        text += "; one of " + all;
    }
    return text + excluded_by(option) + without;
}

OptionDescription described(const CLI::Option& option)
{
    OptionDescription d;
    for (const std::string& name : option.get_snames()) {
        d.names.push_back("-" + name);
    }
    for (const std::string& name : option.get_lnames()) {
        d.names.push_back("--" + name);
    }
    d.required = option.get_required();
    d.kind = ValueKind::none;
    if (option.get_items_expected_max() != 0) {
        d.values = option.get_type_size();
        const std::string type = option.get_type_name();
        d.choices = choices_in(type);
        d.kind = d.choices.empty() ? kind_of(type) : ValueKind::choice;
        const bool few = fmt::format("{}", fmt::join(d.choices, "|")).size() <= 52;
        d.value = d.choices.empty() ? type : few ? fmt::format("{}", fmt::join(d.choices, "|")) : "WORD";
        d.repeats = option.get_expected_max() > 1;
    }
    d.text = text_of(option, d.choices);
    return d;
}

/// The words behind the program.
std::string path_of(const CLI::App& app)
{
    if (app.get_parent() == nullptr) return {};
    const std::string above = path_of(*app.get_parent());
    return above.empty() ? app.get_name() : above + " " + app.get_name();
}

}  // namespace

CommandDescription described(const CLI::App& app)
{
    CommandDescription d;
    d.name = app.get_name();
    d.text = app.get_description();
    d.path = path_of(app);
    if (app.get_parent() == nullptr || app.get_footer() != app.get_parent()->get_footer()) {
        d.footer = app.get_footer();
    }
    d.purpose = "Other";
    for (const CommandExamples& known : command_examples()) {
        if (known.command == d.path) {
            d.purpose = known.purpose;
            d.examples = known.lines;
        }
    }
    for (const CLI::Option* option : app.get_options()) {
        (option->get_positional() ? d.values : d.options).push_back(described(*option));
    }
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        d.commands.push_back(described(*command));
    }
    return d;
}

std::string signature(const OptionDescription& option)
{
    std::string text = fmt::format("{}", fmt::join(option.names, ", "));
    if (!option.value.empty()) {
        text += (text.empty() ? "" : " ") + option.value;
    }
    return text + (option.repeats ? " ..." : "");
}

std::string usage(const CommandDescription& command)
{
    std::string text = "patchlight";
    if (!command.path.empty()) text += " " + command.path;
    if (!command.commands.empty()) text += " COMMAND";
    for (const OptionDescription& value : command.values) {
        text += fmt::format(" {}", signature(value));
    }
    for (const OptionDescription& option : command.options) {
        text += option.required ? fmt::format(" {}", signature(option)) : "";
    }
    return text + " [OPTIONS]";
}

}  // namespace patchlight
