#include "apps/patchlight/arguments.h"
#include "apps/patchlight/command_examples.h"
#include "apps/patchlight/usage_error.h"
#include "tests/command/command_runner.h"

#include <gmock/gmock.h>

#include <functional>
#include <set>
#include <sstream>

namespace patchlight::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Examples are to be copied whole: they may be wider.
void expect_fits(const std::string& help)
{
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) {
        const bool example = line.find("patchlight ") == 9;
        EXPECT_LE(line.size(), example ? 100U : 80U) << line;
    }
}

class ExamplesTest : public CommandTest {};

TEST_F(ExamplesTest, AreTheirCommandsOwnAndAreUnderstood)
{
    for (const CommandExamples& known : command_examples()) {
        EXPECT_FALSE(known.lines.empty()) << known.command;
        for (const std::string& line : known.lines) {
            const auto words = words_of(line);
            EXPECT_TRUE(known.command.empty() || line.starts_with(std::string(known.command) + " ") ||
                        line == known.command)
                << line;
            std::vector<const char*> argv{"patchlight"};
            for (const std::string& word : words) argv.push_back(word.c_str());
            EXPECT_NO_THROW(parse_arguments(static_cast<int>(argv.size()), argv.data())) << line;
        }
    }
}

/// The commands of a group, and those of groups in it: their names stand in its help below lines that name their
/// purpose.
std::vector<std::string> commands_in(const std::string& group, const std::function<std::string(std::string)>& help)
{
    std::vector<std::string> commands;
    const std::string text = help(group);
    std::istringstream lines(text.substr(0, text.find("\nOptions:")));
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("  ") || line[2] == ' ') continue;
        const std::string path = (group.empty() ? "" : group + " ") + words_of(line).front();
        commands.push_back(path);
        if (help(path).find(" COMMAND") == std::string::npos) continue;
        for (std::string& inner : commands_in(path, help)) commands.push_back(std::move(inner));
    }
    return commands;
}

TEST_F(ExamplesTest, HelpOfEveryCommandBeginsWithOneAndFitsEightyColumns)
{
    const auto help_of = [&](const std::string& command) {
        const Outcome help = run(words_of(command + " --help"));
        EXPECT_EQ(help.code, 0);
        return help.out;
    };
    EXPECT_THAT(help_of(""), StartsWith("Example: patchlight "));
    expect_fits(help_of(""));
    std::set<std::string> known;
    for (const CommandExamples& examples : command_examples()) known.emplace(examples.command);
    const std::vector<std::string> commands = commands_in("", help_of);
    for (const std::string& command : commands) {
        EXPECT_TRUE(known.contains(command)) << command << " has no example";
        const std::string help = help_of(command);
        EXPECT_THAT(help, StartsWith("Example: patchlight " + command));
        EXPECT_THAT(help, HasSubstr("\nUsage: patchlight " + command));
        expect_fits(help);
    }
    EXPECT_EQ(commands.size() + 1, known.size()) << "an example of a command that doesn't exist";
}

TEST_F(ExamplesTest, RunInTheRepositorysRoot)
{
    std::filesystem::create_directory_symlink(PATCHLIGHT_DATA, folder_ / "data");
    // demo has a test of its own; the furniture room takes long.
    for (const CommandExamples& known : command_examples()) {
        if (known.command.empty() || known.command == "demo") continue;
        for (const std::string& line : known.lines) {
            const Outcome outcome = run(words_of(line), {.folder = folder_});
            EXPECT_EQ(outcome.code, 0) << line << "\n" << outcome.err;
            EXPECT_THAT(outcome.err, ::testing::Not(HasSubstr("warning"))) << line;
        }
    }
}

}  // namespace
}  // namespace patchlight::testing
