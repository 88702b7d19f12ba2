#include "meshing/scene_files.h"

#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace patchlight {

namespace fs = std::filesystem;

std::string read_whole_file(const fs::path& file, std::uintmax_t limit)
{
    const auto refuse = [&](const std::string& reason) {
        throw SceneError("file", fmt::format("{}: {}", file.string(), reason));
    };
    std::error_code failure;
    const fs::file_status status = fs::status(file, failure);
    if (status.type() == fs::file_type::not_found) refuse("no such file");
    if (failure) refuse(failure.message());
    if (fs::is_directory(status)) refuse("is a folder");
    if (!fs::is_regular_file(status)) refuse("is not a regular file");
    const std::uintmax_t size = fs::file_size(file, failure);
    if (failure) refuse(failure.message());
    if (size > limit) refuse(fmt::format("has {} bytes, the limit is {}", size, limit));

    std::ifstream stream(file, std::ios::binary);
    if (!stream) refuse(std::strerror(errno));
    std::string bytes(size, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    if (stream.gcount() != static_cast<std::streamsize>(size)) refuse("could not be read to its end");
    return bytes;
}

SceneFolder::SceneFolder(const fs::path& scene_file)
{
    std::error_code failure;
    folder_ = fs::canonical(fs::absolute(scene_file).parent_path(), failure);
    if (failure) throw SceneError("file", fmt::format("{}: {}", scene_file.string(), failure.message()));
}

std::optional<fs::path> SceneFolder::resolve(const std::string& reference) const
{
    std::string name = reference;
    std::replace(name.begin(), name.end(), '\\', '/');
    const fs::path relative(name);
    const bool has_scheme = name.find("://") != std::string::npos || (name.size() > 1 && name[1] == ':');
    if (name.empty() || name.find('\0') != std::string::npos || relative.is_absolute() || has_scheme) return {};
    std::error_code failure;
    const fs::path target = fs::weakly_canonical(folder_ / relative, failure);
    if (failure) return {};
    const fs::path inside = target.lexically_relative(folder_);
    if (inside.empty() || *inside.begin() == ".." || inside == ".") return {};
    return target;
}

}  // namespace patchlight
