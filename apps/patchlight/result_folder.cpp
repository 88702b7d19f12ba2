#include "apps/patchlight/result_folder.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {

namespace {

const std::filesystem::path& taken(const std::filesystem::path& folder, const std::string& mark,
                                   const std::vector<std::string>& names)
{
    std::error_code error;
    if (std::filesystem::exists(folder, error) && !std::filesystem::is_directory(folder, error)) {
        throw FolderRefused(fmt::format("{} is a file; name a new folder", folder.string()));
    }
    FileWriter::make_folder(folder);
    FileWriter::sweep(folder);
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        const bool known = name == mark || std::ranges::find(names, name) != names.end();
        if (!known || !std::filesystem::exists(folder / mark, error)) {
            throw FolderRefused(
                fmt::format("{} holds {}, which is not of this command; name a new folder", folder.string(), name));
        }
    }
    return folder;
}

}  // namespace

ResultFolder::ResultFolder(std::filesystem::path folder, const std::string& mark, const std::vector<std::string>& names,
                           FileWriter& writer)
    : folder_(std::move(folder)), writer_(writer), lock_(taken(folder_, mark, names))
{
    std::error_code error;
    for (const std::string& name : names) {
        if (name != mark) std::filesystem::remove(folder_ / name, error);
    }
}

void ResultFolder::write(const std::string& name, std::span<const unsigned char> bytes)
{
    writer_.write(folder_ / name, bytes);
}

void ResultFolder::write(const std::string& name, std::string_view text)
{
    writer_.write(folder_ / name, text);
}

}  // namespace patchlight
