#include "apps/patchlight/study_options.h"

#include "apps/patchlight/solve_arguments.h"
#include "apps/patchlight/usage_error.h"

#include <fmt/format.h>

#include <cctype>
#include <sstream>

namespace patchlight {

namespace {

/// Solve alone, as a program of its own.
struct SolveParser {
    CLI::App app{"solve"};
    SolveCommand command;
    SolveTexts texts;

    SolveParser()
    {
        add_solve(app, command, texts);
        add_machine(app, command.threads, command.quiet, command.json, "");
    }
};

bool is_path(const OptionText& option)
{
    const bool camera = option.name == "view" || option.name == "for-view";
    return option.name == "mesh" || (camera && option.value.ends_with(".json"));
}

/// Where in `text` an option is named, as a whole word.
std::size_t place_in(const std::string& text, const std::string& name)
{
    const std::string word = "--" + name;
    for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += word.size()) {
        const char next = at + word.size() < text.size() ? text[at + word.size()] : ' ';
        if (std::isalnum(static_cast<unsigned char>(next)) == 0 && next != '-') return at;
    }
    return std::string::npos;
}

}  // namespace

OptionNames solve_option_names()
{
    const SolveParser parser;
    OptionNames names;
    for (const CLI::Option* option : parser.app.get_options()) {
        for (const std::string& name : option->get_lnames())
            if (name != "help" && name != "config") names.push_back(name);
    }
    return names;
}

ReadStudy read_study_file(const std::string& file)
{
    std::string text = text_of_study(file);
    Study study = read_study(text, file, solve_option_names());
    return {std::move(study), std::move(text)};
}

std::vector<std::string> words_of(const OptionText& option, const std::filesystem::path& file)
{
    std::vector<std::string> words;
    std::istringstream values(option.value);
    for (std::string value; std::getline(values, value);) {
        const std::string word = is_path(option) ? (file.parent_path() / value).string() : value;
        words.push_back(fmt::format("--{}={}", option.name, word));
    }
    return words;
}

std::string with_place(const std::string& cause, std::span<const OptionText> options, const std::filesystem::path& file)
{
    const OptionText* about = nullptr;
    std::size_t first = std::string::npos;
    for (const OptionText& option : options) {
        const std::size_t at = place_in(cause, option.name);
        if (at < first && option.place.line > 0) {
            first = at;
            about = &option;
        }
    }
    if (about == nullptr) return cause;
    return fmt::format("{}:{}:{}: {}", file.string(), about->place.line, about->place.column, cause);
}

SolveCommand solve_command_of(const std::string& scene, const std::string& run, std::span<const OptionText> options,
                              const std::filesystem::path& file)
{
    SolveParser parser;
    std::vector<std::string> words{"solve", "-o" + run};
    for (const OptionText& option : options) {
        const std::vector<std::string> more = words_of(option, file);
        words.insert(words.end(), more.begin(), more.end());
    }
    words.insert(words.end(), {"--", scene});
    std::vector<const char*> argv;
    for (const std::string& word : words) argv.push_back(word.c_str());
    try {
        parser.app.parse(static_cast<int>(argv.size()), argv.data());
        finish_solve(parser.command, parser.texts);
    } catch (const CLI::ParseError& error) {
        throw UsageError("usage", with_place(error.what(), options, file));
    } catch (const UsageError& error) {
        throw UsageError(error.code(), with_place(error.what(), options, file));
    }
    return parser.command;
}

}  // namespace patchlight
