#include "apps/run/folder_lock.h"

#include "apps/run/run_folder.h"

#include <fmt/format.h>

#include <cerrno>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace patchlight {

namespace {

/// The process that has a file locked, from lines like `1: FLOCK ADVISORY WRITE 10748 fe:00:11085002 0 EOF`. 0: it is
/// another machine's or container's, or the file system's own numbers aren't the kernel's.
long holder_of(int descriptor)
{
    struct stat status {};
    if (::fstat(descriptor, &status) != 0) return 0;
    const std::string wanted =
        fmt::format("{:02x}:{:02x}:{}", ::major(status.st_dev), ::minor(status.st_dev), status.st_ino);
    std::ifstream locks("/proc/locks");
    for (std::string line; std::getline(locks, line);) {
        std::istringstream words(line);
        std::string number, kind, advisory, access, file;
        long process = 0;
        if (words >> number >> kind >> advisory >> access >> process >> file && kind == "FLOCK" && file == wanted) {
            return process;
        }
    }
    return 0;
}

[[noreturn]] void refuse(const std::filesystem::path& folder, long holder)
{
    throw FolderRefused(
        fmt::format("{} is being written by another patchlight ({}); wait for it or name a new folder", folder.string(),
                    holder > 0 ? fmt::format("process {}", holder) : "its process can't be seen from here"));
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, std::chrono::milliseconds patience)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC))
{
    if (descriptor_ < 0) {
        throw OutputError(fmt::format("{}: {}", folder.string(), std::generic_category().message(errno)));
    }
    // Not every file system can lock; then two programs at once are the user's own affair.
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        if (std::chrono::steady_clock::now() < deadline) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            continue;
        }
        const long holder = holder_of(descriptor_);
        ::close(descriptor_);
        refuse(folder, holder);
    }
}

FolderLock::~FolderLock()
{
    ::close(descriptor_);
}

void FolderLock::check(const std::filesystem::path& folder) const
{
    struct stat held {
    }, found{};
    if (::stat(folder.c_str(), &found) != 0) {
        throw OutputError(fmt::format("{}: {}; it was there when this began, and is not made again", folder.string(),
                                      std::generic_category().message(errno)));
    }
    if (::fstat(descriptor_, &held) == 0 && (held.st_dev != found.st_dev || held.st_ino != found.st_ino)) {
        throw OutputError(
            fmt::format("{}: something else has taken the place of the folder that this was writing", folder.string()));
    }
}

}  // namespace patchlight
