#pragma once

#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace patchlight::testing {

inline std::string text_of(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_text(const std::filesystem::path& file, const std::string& text)
{
    std::ofstream(file, std::ios::binary) << text;
}

/// The words of a line, up to where it leads its output into a file.
inline std::vector<std::string> words_of(const std::string& line)
{
    std::istringstream in(line);
    std::vector<std::string> words;
    for (std::string word; in >> word && word != ">";) words.push_back(word);
    return words;
}

/// How the command ended. A signal that killed it counts as minus its number.
struct Outcome {
    int code = 0;
    std::string out, err;
};

struct Surroundings {
    std::map<std::string, std::string> environment{};
    std::filesystem::path folder{};           ///< to work in
    std::optional<rlim_t> largest_file{};     ///< bytes
    std::filesystem::path standard_output{};  ///< instead of what Outcome shows
};

/// The built command, running. Kills what is left of it.
class RunningCommand {
public:
    RunningCommand(const std::vector<std::string>& arguments, const std::filesystem::path& scratch,
                   const Surroundings& around)
        : out_(scratch / "stdout.txt"), err_(scratch / "stderr.txt")
    {
        const std::string shown = around.standard_output.empty() ? out_.string() : around.standard_output.string();
        std::vector<std::string> words{PATCHLIGHT_COMMAND};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (std::string& word : words) {
            argv.push_back(word.data());
        }
        argv.push_back(nullptr);
        pid_ = ::fork();
        if (pid_ == 0) {
            become(argv.data(), shown, around);
        }
    }
    RunningCommand(const RunningCommand&) = delete;
    RunningCommand& operator=(const RunningCommand&) = delete;
    ~RunningCommand()
    {
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            (void)::waitpid(pid_, nullptr, 0);
        }
    }

    void send(int signal) const { ::kill(pid_, signal); }

    Outcome wait()
    {
        int status = 0;
        while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {}
        pid_ = -1;
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), text_of(out_), text_of(err_)};
    }

    /// Until `there` says so, a minute at most; false when it didn't, or the command ended before.
    bool wait_for(const std::function<bool()>& there) const
    {
        for (int i = 0; i < 30'000; ++i) {
            if (there()) {
                return true;
            }
            siginfo_t info{};
            if (::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid != 0) {
                return there();
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    }

private:
    [[noreturn]] void become(char* const* argv, const std::string& shown, const Surroundings& around) const
    {
        const int out = ::open(shown.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
        const int err = ::open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
        ::dup2(out, STDOUT_FILENO);
        ::dup2(err, STDERR_FILENO);
        for (const auto& [name, value] : around.environment) {
            ::setenv(name.c_str(), value.c_str(), 1);
        }
        if (!around.folder.empty() && ::chdir(around.folder.c_str()) != 0) {
            ::_exit(126);
        }
        if (around.largest_file) {
            const rlimit limit{*around.largest_file, *around.largest_file};
            ::setrlimit(RLIMIT_FSIZE, &limit);
        }
        ::execv(argv[0], argv);
        ::_exit(127);
    }

    std::filesystem::path out_, err_;
    pid_t pid_ = -1;
};

/// A folder for a test, and the command run in it.
class CommandTest : public ::testing::Test {
protected:
    CommandTest() { std::filesystem::create_directory(folder_ / "scratch"); }

    Outcome run(const std::vector<std::string>& arguments, const Surroundings& around = {})
    {
        return RunningCommand(arguments, folder_ / "scratch", around).wait();
    }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    /// A lit room without a wall, in metres: floor, back wall and a lamp; a camera beside it.
    std::string write_scene(const std::string& name = "room.obj") const
    {
        const std::filesystem::path file = folder_ / name;
        write_text(file, scene_text);
        write_text(folder_ / "room.mtl", material_text);
        write_text(std::filesystem::path(file).replace_extension(".view.json"), view_text);
        return file.string();
    }

    /// Options that make a solve of that scene take a tenth of a second.
    static std::vector<std::string> small(std::vector<std::string> words)
    {
        for (const char* word :
             {"--max-elements", "220", "--max-edge", "0.5", "--rays", "32", "--vertex-rays", "16", "--size", "32x32"}) {
            words.emplace_back(word);
        }
        return words;
    }

    /// Names of all files below a folder, and their bytes.
    static std::map<std::string, std::string> files_in(const std::filesystem::path& folder)
    {
        std::map<std::string, std::string> files;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
            if (entry.is_regular_file()) {
                files[std::filesystem::relative(entry.path(), folder).string()] = text_of(entry.path());
            }
        }
        return files;
    }

    /// The files that are to be the same wherever and however fast a run was made.
    static std::map<std::string, std::string> lasting_files_in(const std::filesystem::path& folder)
    {
        auto files = files_in(folder);
        files.erase("timing.json");
        files.erase("report.html");  // the demo's: it shows seconds, too
        return files;
    }

    static constexpr const char* scene_text = "mtllib room.mtl\n"
                                              "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nv 1 1 0\n"
                                              "v .4 .5 .4\nv .6 .5 .4\nv .6 .5 .6\nv .4 .5 .6\n"
                                              "o floor\nusemtl white\nf 1 4 3 2\n"
                                              "o wall\nusemtl red\nf 1 2 6 5\n"
                                              "o lamp\nusemtl lamp\nf 7 8 9 10\n";
    static constexpr const char* material_text = "newmtl white\nKd .7 .7 .7\nnewmtl red\nKd .6 .1 .1\n"
                                                 "newmtl lamp\nKd 0 0 0\nKe 10 9 8\n";
    static constexpr const char* view_text =
        "{\"name\": \"front\", \"from\": [0.5, 0.6, 2.4], \"to\": [0.5, 0.4, 0], \"up\": [0, 1, 0], \"fov\": 40}";

    const TemporaryFolder temporary_;
    const std::filesystem::path& folder_ = temporary_.path();
};

}  // namespace patchlight::testing
