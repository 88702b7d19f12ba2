#include "apps/patchlight/terminal.h"

#include "apps/patchlight/usage_error.h"
#include "apps/run/file_writer.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
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

Messages::Messages(bool quiet) : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1)
{
    const char* term = std::getenv("TERM");
    color_ = terminal_ && !is_set("NO_COLOR") && (term == nullptr || std::string_view(term) != "dumb");
}

std::string Messages::colored(const char* color, std::string_view text) const
{
    return color_ ? fmt::format("\x1b[{}m{}\x1b[0m", color, text) : std::string(text);
}

void Messages::error(std::string_view code, std::string_view text) const
{
    raw(fmt::format("{}: {}\n", colored("1;31", fmt::format("error[{}]", code)), harmless(text)));
}

void Messages::warning(std::string_view text) const
{
    raw(fmt::format("{}: {}\n", colored("1;33", "warning"), harmless(text)));
}

void Messages::note(std::string_view text) const
{
    if (!quiet_) {
        raw(harmless(text) + "\n");
    }
}

void Messages::raw(std::string_view text) const
{
    (void)write_all(STDERR_FILENO, text);
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
