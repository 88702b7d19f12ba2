#include "apps/patchlight/child_process.h"

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace patchlight {

namespace {

constexpr std::size_t most_said = 64 * 1024;
constexpr int cannot_start = 127;

/// Between fork and exec: nothing that allocates or locks.
[[noreturn]] void become(char* const* arguments, int nowhere, int messages, pid_t parent)
{
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(cannot_start);
    ::dup2(nowhere, STDIN_FILENO);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(messages, STDERR_FILENO);
    ::execv("/proc/self/exe", arguments);
    ::_exit(cannot_start);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments)
{
    std::vector<std::string> words{"patchlight"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    int ends[2] = {-1, -1};
    const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nowhere < 0 || ::pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) {
        throw std::system_error(errno, std::generic_category(), "a cell's process");
    }
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ == 0) become(pointers.data(), nowhere, ends[1], parent);
    const int error = errno;
    ::close(nowhere);
    ::close(ends[1]);
    messages_ = ends[0];
    if (pid_ < 0) {
        ::close(messages_);
        throw std::system_error(error, std::generic_category(), "a cell's process");
    }
}

ChildProcess::~ChildProcess()
{
    if (!end_) {
        send(SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
    ::close(messages_);
}

std::optional<ChildEnd> ChildProcess::ended()
{
    if (end_) return end_;
    int status = 0;
    const pid_t reaped = ::waitpid(pid_, &status, WNOHANG);
    listen();
    if (reaped == pid_) {
        const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
        end_ = ChildEnd{signal != 0 ? 128 + signal : WEXITSTATUS(status), signal};
    }
    return end_;
}

void ChildProcess::send(int signal) const
{
    if (!end_) ::kill(pid_, signal);
}

void ChildProcess::listen()
{
    char bytes[4096];
    for (ssize_t n = 0; (n = ::read(messages_, bytes, sizeof bytes)) > 0;) {
        said_.append(bytes, static_cast<std::size_t>(n));
    }
    if (said_.size() > most_said) said_.erase(0, said_.size() - most_said);
}

}  // namespace patchlight
