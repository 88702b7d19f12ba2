#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace patchlight {

/// Output that could not be written (exit 6): the path and the system's reason.
class OutputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Writes files so that a reader sees the old or the new one whole, never a part: into a temporary beside the
/// file, synced, renamed. It knows its unfinished temporaries, so that an interrupted program leaves none.
/// May be used from several threads.
class FileWriter {
public:
    /// Throws OutputError; the file is then what it was, and no temporary is left.
    void write(const std::filesystem::path& file, std::span<const unsigned char> bytes);
    void write(const std::filesystem::path& file, std::string_view text);

    /// Takes the next bytes of a file.
    using Sink = std::function<void(std::span<const unsigned char>)>;
    /// The same for what would be too much to hold twice: `produce` hands over piece by piece. What it throws goes
    /// through, and leaves no temporary either.
    void write_pieces(const std::filesystem::path& file, const std::function<void(const Sink&)>& produce);

    /// Makes a folder, and those above it. Throws OutputError.
    static void make_folder(const std::filesystem::path& folder);
    /// The same for the folder that a file is to stand in.
    static void make_folder_of(const std::filesystem::path& file);

    /// Unlinks what is unfinished. For the way out after an interrupt or without memory: nothing can be written
    /// afterwards. Allocates nothing, and may be called where another call of this thread's ran out of memory.
    void abandon() noexcept;

    /// Deletes temporaries that a killed program left in a folder.
    static void sweep(const std::filesystem::path& folder) noexcept;

private:
    std::recursive_mutex mutex_;
    std::set<std::string> unfinished_;
    bool abandoned_ = false;
};

/// The whole of a file. Throws std::runtime_error with the path and the reason.
std::string read_bytes(const std::filesystem::path& file);

}  // namespace patchlight
