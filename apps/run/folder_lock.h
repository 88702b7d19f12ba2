#pragma once

#include <chrono>
#include <filesystem>

namespace patchlight {

/// Keeps other programs out of a folder while it lives. Leaves no file behind.
class FolderLock {
public:
    /// Throws FolderRefused when another program holds it and doesn't let go in time, naming its process where this
    /// machine knows it; OutputError when the folder can't be opened. A file system that can't lock keeps nobody out.
    explicit FolderLock(const std::filesystem::path& folder, std::chrono::milliseconds patience = {});
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;
    ~FolderLock();

    /// Throws OutputError when `folder` isn't the one that was locked: removed, renamed, or another stands there now.
    void check(const std::filesystem::path& folder) const;

private:
    int descriptor_ = -1;
};

}  // namespace patchlight
