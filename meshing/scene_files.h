#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace patchlight {

/// The bytes of a regular file of at most `limit` bytes.
/// Throws SceneError("file", "PATH: reason") when it is missing, a folder, unreadable or larger.
std::string read_whole_file(const std::filesystem::path& file, std::uintmax_t limit = std::uintmax_t{1} << 31U);

/// The folder a scene file stands in: what the file refers to is looked for there and nowhere else.
class SceneFolder {
public:
    explicit SceneFolder(const std::filesystem::path& scene_file);

    /// The file that a reference inside the scene means; nothing when the reference is absolute, a URL, leaves
    /// the folder by `..` or by a link. The file need not exist.
    std::optional<std::filesystem::path> resolve(const std::string& reference) const;

    const std::filesystem::path& path() const { return folder_; }

private:
    std::filesystem::path folder_;  ///< canonical
};

}  // namespace patchlight
