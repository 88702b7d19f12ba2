#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace patchlight {

/// How a child ended.
struct ChildEnd {
    int exit_code = 0;  ///< 128 + the signal when one ended it
    int signal = 0;     ///< 0: it ended by itself
};

/// This program again, with other arguments, beside us. What it says on standard error is kept; its results are not.
/// It is asked to stop when we die, however we do.
class ChildProcess {
public:
    /// `arguments` without the program's name. Throws std::system_error when it can't be started.
    explicit ChildProcess(const std::vector<std::string>& arguments);
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;
    /// Kills it, and waits, when it still runs.
    ~ChildProcess();

    /// How it ended; nothing while it runs. Takes in what it said meanwhile.
    std::optional<ChildEnd> ended();

    void send(int signal) const;

    /// The last of what it said, 64 KiB at most.
    const std::string& said() const { return said_; }
    std::chrono::duration<double> age() const { return std::chrono::steady_clock::now() - begin_; }

private:
    void listen();

    int pid_ = -1;
    int messages_ = -1;  ///< our end of its standard error
    std::string said_;
    std::optional<ChildEnd> end_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace patchlight
