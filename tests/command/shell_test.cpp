#include "tests/command/command_runner.h"

#include <gmock/gmock.h>

#include <regex>

namespace patchlight::testing {
namespace {

using ::testing::HasSubstr;

/// What a shell prints on a script of ours.
std::string printed_by(const std::string& program, const std::filesystem::path& folder, const std::string& script)
{
    write_text(folder / "script", script);
    const std::string command = program + " " + (folder / "script").string() + " >" + (folder / "printed").string() +
                                " 2>&1 </dev/null; echo \"exit $?\" >>" + (folder / "printed").string();
    (void)!std::system(command.c_str());
    return text_of(folder / "printed");
}

bool there_is(const std::string& program)
{
    return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

class ShellTest : public CommandTest {
protected:
    std::string completion(const std::string& shell)
    {
        const Outcome outcome = run({"completion", shell});
        EXPECT_EQ(outcome.code, 0);
        EXPECT_EQ(outcome.err, "");
        write_text(path("completion." + shell), outcome.out);
        return path("completion." + shell);
    }

    /// What bash offers for a line of words, the last of which is being typed.
    std::string bash_offers(const std::string& words)
    {
        return printed_by("bash", folder_ / "scratch",
                          "cd " + folder_.string() + "\nsource " + completion("bash") + "\nCOMP_WORDS=(patchlight " +
                              words +
                              ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_patchlight\n"
                              "printf '%s\\n' \"${COMPREPLY[@]}\" | sort\n");
    }
};

TEST_F(ShellTest, ScriptsAreWellFormed)
{
    for (const char* shell : {"bash", "zsh", "fish"}) {
        const std::string file = completion(shell);
        ASSERT_TRUE(there_is(shell)) << "./dev installs it";
        EXPECT_EQ(printed_by(std::string(shell) + " -n", folder_ / "scratch", text_of(file)), "exit 0\n") << shell;
    }
}

TEST_F(ShellTest, BashCompletesCommandsOptionsAndValues)
{
    write_text(path("a room.obj"), "");
    std::filesystem::create_directory(folder_ / "a run");
    EXPECT_EQ(bash_offers("so"), "solve\nexit 0\n");
    EXPECT_EQ(bash_offers("solve --ref"), "--refine\nexit 0\n");
    EXPECT_EQ(bash_offers("solve --solver h"), "hierarchical\nexit 0\n");
    EXPECT_EQ(bash_offers("solve --solver = c"), "conjugate-gradient\nexit 0\n") << "as bash splits --solver=c";
    EXPECT_EQ(bash_offers("solve --solver ="), "bicgstab\nconjugate-gradient\ngauss-seidel\nhierarchical\n"
                                               "jacobi\nprogressive\nexit 0\n");
    EXPECT_EQ(bash_offers("solve a"), "a room.obj\na run\nexit 0\n");
    EXPECT_EQ(bash_offers("verify a"), "a run\nexit 0\n") << "a run is a folder";
    EXPECT_EQ(bash_offers("solve --max-elements a"), "\nexit 0\n") << "no file is a number";
    EXPECT_EQ(bash_offers("completion z"), "zsh\nexit 0\n");
    EXPECT_EQ(bash_offers("study ch"), "check\nexit 0\n");
    EXPECT_EQ(bash_offers("study check --jo"), "--jobs\nexit 0\n");
    EXPECT_EQ(bash_offers("study check a"), "a room.obj\na run\nexit 0\n");
    EXPECT_EQ(bash_offers("nonsense --ref"), "\nexit 0\n");
    EXPECT_THAT(bash_offers("''"), HasSubstr("demo\n"));
}

TEST_F(ShellTest, FishCompletesCommandsOptionsAndValues)
{
    ASSERT_TRUE(there_is("fish")) << "./dev installs it";
    const std::string file = completion("fish");
    const auto offers = [&](const std::string& line) {
        return printed_by("HOME=" + folder_.string() + " fish --no-config", folder_ / "scratch",
                          "source " + file + "\ncomplete -C '" + line + "'\n");
    };
    EXPECT_THAT(offers("patchlight so"), HasSubstr("solve\t"));
    EXPECT_THAT(offers("patchlight solve --ref"), HasSubstr("--refine\t"));
    EXPECT_THAT(offers("patchlight solve --solver h"), ::testing::MatchesRegex("hierarchical\t[^\n]*\nexit 0\n"));
    EXPECT_THAT(offers("patchlight completion z"), HasSubstr("zsh"));
    EXPECT_THAT(offers("patchlight study "), HasSubstr("check\t"));
    EXPECT_THAT(offers("patchlight study check --jo"), HasSubstr("--jobs\t"));
    EXPECT_THAT(offers("patchlight study check "), ::testing::Not(HasSubstr("check\t"))) << "it stands there already";
}

TEST_F(ShellTest, ZshCompletesInASession)
{
    ASSERT_TRUE(there_is("zsh")) << "./dev installs it";
    // zsh completes only where somebody types: a terminal inside, in which a tab completes what is the only way on.
    const std::string script =
        "zmodload zsh/zpty\nzpty z 'zsh -f -i'\n"
        "zpty -w z 'PROMPT=; autoload -Uz compinit; compinit -u -d " +
        path("dump") + "; source " + completion("zsh") +
        "; patchlight() { print -r -- \"<${(j:|:)@}>\" }; print re\"\"ady'\n"
        "zpty -r z seen '*ready*'\n"
        "for line in 'so' 'solve --refi' 'solve --solver hier' 'completion z' 'study ch' 'study check --jo'; do\n"
        "  zpty -w -n z \"patchlight $line\"$'\\t\\n'\n"
        "  zpty -r z seen '*<*>*'\n  print -r -- \"$seen\"\ndone\nzpty -d z\n";
    const std::string printed = printed_by("timeout 60 zsh -f", folder_ / "scratch", script);
    for (const char* completed : {"<solve>", "<solve|--refine", "<solve|--solver|hierarchical>", "<completion|zsh>",
                                  "<study|check>", "<study|check|--jobs"})
        EXPECT_THAT(printed, HasSubstr(completed));
}

TEST_F(ShellTest, ManualPageHoldsEveryCommandAndOptionAndPleasesGroff)
{
    const Outcome page = run({"man"});
    EXPECT_EQ(page.code, 0);
    EXPECT_EQ(run({"man"}).out, page.out);
    std::string unescaped = std::regex_replace(page.out, std::regex(R"(\\-)"), "-");
    std::istringstream lines(run({"--help"}).out);
    std::size_t options = 0;
    for (std::string line; std::getline(lines, line);) {
        std::smatch command;
        if (!std::regex_search(line, command, std::regex("^  ([a-z]+) "))) continue;
        EXPECT_THAT(unescaped, HasSubstr("\n.SS patchlight " + command[1].str())) << command[1];
        const std::string help = run({command[1], "--help"}).out;
        const std::size_t section = unescaped.find("\n.SS patchlight " + command[1].str());
        const std::string of_command = unescaped.substr(section, unescaped.find("\n.S", section + 4) - section);
        const std::regex name("\n  (-[-a-z]+(, --[-a-z]+)?)");
        for (std::sregex_iterator match(help.begin(), help.end(), name), end; match != end; ++match, ++options)
            EXPECT_NE(of_command.find("\n.B " + (*match)[1].str()), std::string::npos) << (*match)[1];
    }
    EXPECT_GT(options, 50U);
    EXPECT_THAT(unescaped, HasSubstr("\n.SS patchlight study check STUDY [OPTIONS]\n"));
    ASSERT_TRUE(there_is("groff")) << "./dev installs it";
    EXPECT_EQ(printed_by("groff -man -ww -z -Tutf8", folder_ / "scratch", page.out), "exit 0\n");
}

}  // namespace
}  // namespace patchlight::testing
