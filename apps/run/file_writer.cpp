#include "apps/run/file_writer.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace patchlight {

namespace {

constexpr std::string_view temporary_mark = ".patchlight-tmp";

[[noreturn]] void fail(const std::filesystem::path& file, int error)
{
    throw OutputError(fmt::format("{}: {}", file.string(), std::generic_category().message(error)));
}

void write_all(int descriptor, std::span<const unsigned char> bytes, const std::filesystem::path& file)
{
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t n = ::write(descriptor, bytes.data() + done, bytes.size() - done);
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n <= 0) {
            fail(file, n < 0 ? errno : ENOSPC);
        }
        done += static_cast<std::size_t>(n);
    }
}

/// Closes at the end of its scope.
class Descriptor {
public:
    explicit Descriptor(int value) : value_(value) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor()
    {
        if (value_ >= 0) {
            ::close(value_);
        }
    }
    int get() const { return value_; }

private:
    int value_;
};

/// Some file systems can't, and say so; that is not for us to mend.
void sync(const Descriptor& descriptor, const std::filesystem::path& file)
{
    if (::fsync(descriptor.get()) != 0 && errno != EINVAL && errno != EROFS) {
        fail(file, errno);
    }
}

void write_temporary(const std::string& temporary, const std::function<void(const FileWriter::Sink&)>& produce,
                     const std::filesystem::path& file)
{
    const Descriptor out(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (out.get() < 0) {
        fail(file, errno);
    }
    produce([&](std::span<const unsigned char> bytes) { write_all(out.get(), bytes, file); });
    sync(out, file);
}

/// A rename is only on the disk once its folder is. A folder that may be written and not read can't be synced.
void sync_folder(const std::filesystem::path& folder, const std::filesystem::path& file)
{
    const Descriptor entry(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (entry.get() >= 0) {
        sync(entry, file);
    }
}

}  // namespace

void FileWriter::write(const std::filesystem::path& file, std::span<const unsigned char> bytes)
{
    write_pieces(file, [&](const Sink& sink) { sink(bytes); });
}

void FileWriter::write_pieces(const std::filesystem::path& file, const std::function<void(const Sink&)>& produce)
{
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    const std::string temporary =
        (folder / fmt::format(".{}.{}{}", file.filename().string(), ::getpid(), temporary_mark)).string();
    {
        const std::lock_guard lock(mutex_);
        if (abandoned_) {
            throw OutputError(file.string() + ": interrupted");
        }
        unfinished_.insert(temporary);
    }
    try {
        write_temporary(temporary, produce, file);
        const std::lock_guard lock(mutex_);
        if (abandoned_ || ::rename(temporary.c_str(), file.c_str()) != 0) {
            fail(file, abandoned_ ? EINTR : errno);
        }
        unfinished_.erase(temporary);
    } catch (...) {
        const std::lock_guard lock(mutex_);
        (void)::unlink(temporary.c_str());
        unfinished_.erase(temporary);
        throw;
    }
    sync_folder(folder, file);
}

void FileWriter::write(const std::filesystem::path& file, std::string_view text)
{
    write(file, std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

void FileWriter::make_folder(const std::filesystem::path& folder)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        throw OutputError(fmt::format("{}: {}", folder.string(), error.message()));
    }
    if (!std::filesystem::is_directory(folder, error)) {
        throw OutputError(fmt::format("{}: is not a folder", folder.string()));
    }
}

void FileWriter::make_folder_of(const std::filesystem::path& file)
{
    if (file.has_parent_path()) make_folder(file.parent_path());
}

void FileWriter::abandon() noexcept
{
    const std::lock_guard lock(mutex_);
    abandoned_ = true;
    for (const std::string& temporary : unfinished_) {
        (void)::unlink(temporary.c_str());
    }
}

void FileWriter::sweep(const std::filesystem::path& folder) noexcept
{
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name.starts_with('.') && name.ends_with(temporary_mark)) {
            (void)::unlink(entry->path().c_str());
        }
    }
}

std::string read_bytes(const std::filesystem::path& file)
{
    const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    const auto complain = [&](int error) {
        throw std::runtime_error(fmt::format("{}: {}", file.string(), std::generic_category().message(error)));
    };
    struct stat status {};
    if (in.get() < 0 || ::fstat(in.get(), &status) != 0) {
        complain(errno);
    }
    if (S_ISDIR(status.st_mode)) {
        complain(EISDIR);
    }
    std::string bytes;
    std::string piece(1 << 16, '\0');
    for (;;) {
        const ssize_t n = ::read(in.get(), piece.data(), piece.size());
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n < 0) {
            complain(errno);
        }
        if (n == 0) {
            return bytes;
        }
        bytes.append(piece.data(), static_cast<std::size_t>(n));
    }
}

}  // namespace patchlight
