#include "apps/patchlight/arguments.h"
#include "apps/patchlight/command_examples.h"
#include "apps/patchlight/usage_error.h"
#include "tests/command/command_runner.h"

#include <gmock/gmock.h>

#include <set>
#include <sstream>

namespace patchlight::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::string> words_of(const std::string& line)
{
    std::istringstream in(line);
    std::vector<std::string> words;
    for (std::string word; in >> word && word != ">";) words.push_back(word);
    return words;
}

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
            EXPECT_TRUE(known.command.empty() || words.front() == known.command) << line;
            std::vector<const char*> argv{"patchlight"};
            for (const std::string& word : words) argv.push_back(word.c_str());
            EXPECT_NO_THROW(parse_arguments(static_cast<int>(argv.size()), argv.data())) << line;
        }
    }
}

TEST_F(ExamplesTest, HelpOfEveryCommandBeginsWithOneAndFitsEightyColumns)
{
    const Outcome whole = run({"--help"});
    EXPECT_THAT(whole.out, StartsWith("Example: patchlight "));
    std::set<std::string> known;
    for (const CommandExamples& examples : command_examples()) known.emplace(examples.command);
    // Its commands stand below lines that name their purpose.
    std::istringstream lines(whole.out.substr(0, whole.out.find("\nOptions:")));
    std::size_t commands = 0;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("  ") || line[2] == ' ') continue;
        const std::string command = words_of(line).front();
        ++commands;
        EXPECT_TRUE(known.contains(command)) << command << " has no example";
        const Outcome help = run({command, "--help"});
        EXPECT_EQ(help.code, 0);
        EXPECT_THAT(help.out, StartsWith("Example: patchlight " + command));
        EXPECT_THAT(help.out, HasSubstr("\nUsage: patchlight " + command));
        expect_fits(help.out);
    }
    expect_fits(whole.out);
    EXPECT_EQ(commands + 1, known.size()) << "an example of a command that doesn't exist";
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
