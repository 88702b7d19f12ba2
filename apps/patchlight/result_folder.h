#pragma once

#include "apps/run/run_folder.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patchlight {

/// A folder of pictures that a command writes anew each time: it may be new, empty, or hold what the command itself
/// left there. Keeps other programs out while it lives.
class ResultFolder {
public:
    /// `mark` is the file by which a folder is known as ours; `names` all files that we may write. Makes the folder and
    /// deletes those of `names` that are there. Throws FolderRefused for a file, for a folder that holds anything but
    /// `names` and `mark`, or files without a `mark`; OutputError when it can't be made.
    ResultFolder(std::filesystem::path folder, const std::string& mark, const std::vector<std::string>& names,
                 FileWriter& writer);

    /// Throws OutputError.
    void write(const std::string& name, std::span<const unsigned char> bytes);
    void write(const std::string& name, std::string_view text);

private:
    std::filesystem::path folder_;
    FileWriter& writer_;
    FolderLock lock_;
};

}  // namespace patchlight
