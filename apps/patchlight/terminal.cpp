#include "apps/patchlight/terminal.h"

#include "apps/patchlight/usage_error.h"
#include "apps/run/file_writer.h"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <system_error>
#include <unistd.h>

namespace patchlight {

namespace {

/// 0, or the error number.
int write_all(int descriptor, std::string_view text)
{
    while (!text.empty()) {
        const ssize_t n = ::write(descriptor, text.data(), text.size());
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n <= 0) {
            return n < 0 ? errno : EIO;
        }
        text.remove_prefix(static_cast<std::size_t>(n));
    }
    return 0;
}

bool is_set(const char* variable)
{
    const char* value = std::getenv(variable);
    return value != nullptr && *value != '\0';
}

/// Names come from files: what would steer a terminal is shown, not obeyed.
std::string harmless(std::string_view text)
{
    std::string shown;
    for (char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        shown += byte < 0x20 && c != '\n' ? fmt::format("\\x{:02x}", byte) : std::string(1, c);
    }
    return shown;
}

}  // namespace

Messages::Messages(bool quiet) : quiet_(quiet)
{
    const char* term = std::getenv("TERM");
    terminal_ = ::isatty(STDERR_FILENO) == 1 && (term == nullptr || std::string_view(term) != "dumb");
    color_ = terminal_ && !is_set("NO_COLOR");
}

std::string Messages::colored(const char* color, std::string_view text) const
{
    return color_ ? fmt::format("\x1b[{}m{}\x1b[0m", color, text) : std::string(text);
}

void Messages::error(std::string_view code, std::string_view text) const
{
    say(fmt::format("{}: {}\n", colored("1;31", fmt::format("error[{}]", code)), harmless(text)));
}

void Messages::warning(std::string_view text) const
{
    say(fmt::format("{}: {}\n", colored("1;33", "warning"), harmless(text)));
}

void Messages::note(std::string_view text) const
{
    if (!quiet_) {
        say(harmless(text) + "\n");
    }
}

void Messages::status(std::string_view text) const
{
    const std::lock_guard lock(writing_);
    if (closed_ || (text.empty() && !has_status_)) {
        return;
    }
    (void)write_all(STDERR_FILENO, erased() + std::string(text));
    has_status_ = !text.empty();
}

void Messages::close(std::string_view last_note) const
{
    const std::unique_lock lock(writing_, std::chrono::milliseconds(50));
    if (lock.owns_lock()) {
        (void)write_all(STDERR_FILENO, erased() + (quiet_ ? "" : harmless(last_note) + "\n"));
        has_status_ = false;
        closed_ = true;
    }
}

void Messages::say(std::string_view text) const
{
    const std::lock_guard lock(writing_);
    (void)write_all(STDERR_FILENO, erased() + std::string(text));
    has_status_ = false;
}

/// In one write with what follows: nothing flickers.
std::string Messages::erased() const
{
    return has_status_ ? "\r\x1b[2K" : "";
}

int terminal_columns()
{
    winsize size{};
    if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
        return size.ws_col;
    }
    const char* columns = std::getenv("COLUMNS");
    const int told = columns == nullptr ? 0 : std::atoi(columns);
    return told > 0 ? told : 80;
}

void keep_standard_descriptors()
{
    // For reading only: what is written there still fails, and is reported.
    int descriptor = 0;
    do {
        descriptor = ::open("/dev/null", O_RDONLY);
    } while (descriptor >= 0 && descriptor <= STDERR_FILENO);
    if (descriptor >= 0) {
        ::close(descriptor);
    }
}

void write_result(std::string_view text)
{
    const int error = write_all(STDOUT_FILENO, text);
    if (error == EPIPE) {
        throw PipeClosed();
    }
    if (error != 0) {
        throw OutputError("standard output: " + std::generic_category().message(error));
    }
}

}  // namespace patchlight
