#include "tests/command/command_runner.h"

#include <gmock/gmock.h>

#include <chrono>
#include <pty.h>
#include <regex>
#include <sys/ioctl.h>

namespace patchlight::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The command with its standard error on a terminal of its own; standard output in a file.
class OnTerminal {
public:
    OnTerminal(const std::vector<std::string>& arguments, const std::filesystem::path& folder, unsigned short columns,
               const std::map<std::string, std::string>& environment = {})
    {
        std::vector<std::string> words{PATCHLIGHT_COMMAND};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        const std::string out = folder / "stdout.txt";
        winsize size{24, columns, 0, 0};
        pid_ = ::forkpty(&terminal_, nullptr, nullptr, &size);
        if (pid_ != 0) return;
        ::setenv("TERM", "xterm", 1);
        ::unsetenv("NO_COLOR");
        for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
        ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), STDOUT_FILENO);
        ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    OnTerminal(const OnTerminal&) = delete;
    OnTerminal& operator=(const OnTerminal&) = delete;
    ~OnTerminal()
    {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            (void)::waitpid(pid_, nullptr, 0);
        }
        ::close(terminal_);
    }

    void send(int signal) const { ::kill(pid_, signal); }
    void resize(unsigned short columns) const
    {
        const winsize size{24, columns, 0, 0};
        ::ioctl(terminal_, TIOCSWINSZ, &size);
    }

    /// Reads until `text` has come, or everything. False when it never came.
    bool read_until(const std::string& text)
    {
        char buffer[4096];
        while (text.empty() || seen_.find(text) == std::string::npos) {
            const ssize_t n = ::read(terminal_, buffer, sizeof buffer);
            if (n <= 0) return false;  // EIO: nobody has the terminal any more
            seen_.append(buffer, static_cast<std::size_t>(n));
        }
        return true;
    }

    int wait()
    {
        read_until("");
        int status = 0;
        (void)::waitpid(pid_, &status, 0);
        pid_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }

    const std::string& seen() const { return seen_; }

private:
    int terminal_ = -1;
    pid_t pid_ = -1;
    std::string seen_;
};

/// What was drawn: the pieces between the ends of lines and returns, without colours and erasing.
std::vector<std::string> drawn_in(const std::string& seen)
{
    static const std::regex orders("\x1b\\[[0-9;]*[A-Za-z]");
    std::vector<std::string> pieces;
    std::string piece;
    for (const char c : std::regex_replace(seen, orders, "")) {
        if (c != '\r' && c != '\n') {
            piece += c;
            continue;
        }
        if (!piece.empty()) pieces.push_back(std::exchange(piece, ""));
    }
    if (!piece.empty()) pieces.push_back(piece);
    return pieces;
}

std::vector<std::string> bars_in(const std::string& seen)
{
    std::vector<std::string> bars;
    for (const std::string& piece : drawn_in(seen))
        if (piece.starts_with("[#") || piece.starts_with("[.")) bars.push_back(piece);
    return bars;
}

/// What a person sees in the end: each line after the last erasing of it.
std::string left_on(const std::string& seen)
{
    std::string shown, line;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (seen.compare(i, 5, "\r\x1b[2K") == 0) {
            line.clear();
            i += 4;
        } else if (seen[i] == '\n') {
            shown += std::exchange(line, "") + "\n";
        } else {
            line += seen[i];
        }
    }
    return shown + line;
}

class TerminalTest : public CommandTest {
protected:
    /// Rays enough for a second or more, so that the bar is drawn.
    std::vector<std::string> long_solve(const std::string& rays = "30000")
    {
        return {"solve", write_scene(),   "-o", path("run"),  "--max-elements",
                "4000",  "--vertex-rays", rays, "--pictures", "none"};
    }
};

TEST_F(TerminalTest, BarFitsAndIsGoneInTheEnd)
{
    for (const unsigned short columns : std::initializer_list<unsigned short>{80, 40, 12, 3}) {
        std::filesystem::remove_all(folder_ / "run");
        OnTerminal terminal(long_solve(), folder_, columns);
        ASSERT_EQ(terminal.wait(), 0) << terminal.seen();
        const auto bars = bars_in(terminal.seen());
        EXPECT_GE(bars.size(), columns > 3 ? 2U : 0U) << "a second has room for ten";
        for (const std::string& bar : bars) EXPECT_LT(bar.size(), columns) << bar;
        EXPECT_EQ(bars_in(left_on(terminal.seen())).size(), 0U) << left_on(terminal.seen());
        EXPECT_THAT(left_on(terminal.seen()), HasSubstr("cycle  0"));
        EXPECT_THAT(text_of(folder_ / "stdout.txt"), Not(HasSubstr("[#")));
    }
}

TEST_F(TerminalTest, BarIsDrawnTenTimesASecondAtMostAndRunsForward)
{
    const auto begin = std::chrono::steady_clock::now();
    OnTerminal terminal(long_solve(), folder_, 120);
    ASSERT_EQ(terminal.wait(), 0);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const auto bars = bars_in(terminal.seen());
    EXPECT_LE(static_cast<double>(bars.size()), 10 * seconds + 1);
    double last = 0;
    std::size_t indirect = 0;
    for (const std::string& bar : bars) {
        std::smatch match;
        // Bars of stages that don't tell how far they are have no number.
        if (!std::regex_search(bar, match, std::regex(R"((\d+) %  indirect)"))) continue;
        ++indirect;
        EXPECT_GE(std::stod(match[1]), last) << "the indirect stage is one, however many loops it takes";
        last = std::stod(match[1]);
    }
    EXPECT_GE(indirect, 2U);
}

TEST_F(TerminalTest, BarFollowsANarrowerTerminal)
{
    OnTerminal terminal(long_solve("65536"), folder_, 100);
    ASSERT_TRUE(terminal.read_until("indirect"));
    terminal.resize(30);
    const std::size_t before = bars_in(terminal.seen()).size();
    ASSERT_EQ(terminal.wait(), 0);
    const auto bars = bars_in(terminal.seen());
    // One more may have been on its way.
    ASSERT_GT(bars.size(), before + 1);
    for (std::size_t i = before + 1; i < bars.size(); ++i) EXPECT_LT(bars[i].size(), 30U) << bars[i];
}

TEST_F(TerminalTest, SignalLeavesNoBarBehind)
{
    for (const int signal : {SIGINT, SIGTERM}) {
        std::filesystem::remove_all(folder_ / "run");
        OnTerminal terminal(long_solve("65536"), folder_, 80);
        ASSERT_TRUE(terminal.read_until("[")) << terminal.seen();
        terminal.send(signal);
        EXPECT_EQ(terminal.wait(), 128 + signal);
        EXPECT_EQ(bars_in(left_on(terminal.seen())).size(), 0U) << left_on(terminal.seen());
        EXPECT_THAT(left_on(terminal.seen()), HasSubstr("interrupted"));
    }
}

TEST_F(TerminalTest, ErrorsAreColouredUnlessNobodyWantsThat)
{
    const std::vector<std::string> words{"inspect", path("absent.obj")};
    OnTerminal coloured(words, folder_, 80);
    EXPECT_EQ(coloured.wait(), 3);
    EXPECT_THAT(coloured.seen(), HasSubstr("\x1b[1;31merror["));
    for (const auto& wish : {std::pair{"NO_COLOR", "1"}, std::pair{"TERM", "dumb"}}) {
        OnTerminal plain(words, folder_, 80, {wish});
        EXPECT_EQ(plain.wait(), 3);
        EXPECT_THAT(plain.seen(), Not(HasSubstr("\x1b")));
        EXPECT_THAT(plain.seen(), HasSubstr("error["));
    }
}

TEST_F(TerminalTest, ADumbOneAndQuietOnesGetNoBar)
{
    OnTerminal dumb(long_solve(), folder_, 80, {{"TERM", "dumb"}});
    EXPECT_EQ(dumb.wait(), 0);
    EXPECT_THAT(dumb.seen(), Not(HasSubstr("\x1b")));
    EXPECT_EQ(bars_in(dumb.seen()).size(), 0U);
    std::filesystem::remove_all(folder_ / "run");
    auto words = long_solve();
    words.emplace_back("--quiet");
    OnTerminal quiet(words, folder_, 80);
    EXPECT_EQ(quiet.wait(), 0);
    EXPECT_EQ(quiet.seen().find("cycle"), std::string::npos) << quiet.seen();
    EXPECT_EQ(bars_in(quiet.seen()).size(), 0U);
}

TEST_F(TerminalTest, APipeGetsOneLineACycle)
{
    const Outcome outcome = run(small({"solve", write_scene(), "-o", path("run"), "--pictures", "none"}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, Not(HasSubstr("\r")));
    EXPECT_THAT(outcome.err, Not(HasSubstr("\x1b")));
    std::istringstream lines(outcome.err);
    int cycles = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("warning: ")) continue;
        EXPECT_THAT(line, ::testing::StartsWith("cycle "));
        ++cycles;
    }
    EXPECT_EQ(static_cast<std::size_t>(cycles),
              static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_ / "run/cycles"), {})));
}

TEST_F(TerminalTest, ASolveEndsWithATableOfBeforeAndAfter)
{
    const Outcome outcome = run(small({"solve", write_scene(), "-o", path("run"), "--pictures", "none"}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::regex table(R"(\n +elements +estimated error +seconds +energy rest)"
                           R"(\nbefore +\d+ +[\d.]+ % +[\d.]+ +-?[\d.e-]+ %)"
                           R"(\nafter +\d+ +[\d.]+ % +[\d.]+ +-?[\d.e-]+ %\n)");
    EXPECT_TRUE(std::regex_search(outcome.out, table)) << outcome.out;
}

}  // namespace
}  // namespace patchlight::testing
