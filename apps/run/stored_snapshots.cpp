#include "apps/run/stored_snapshots.h"

#include "apps/run/file_writer.h"
#include "apps/run/glb_file.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace patchlight {

namespace {

constexpr std::string_view prefix = "shots-", suffix = ".glb";

/// The number in a name that snapshot_file() gives.
std::optional<int> shots_in_name(const std::string& name)
{
    if (!name.starts_with(prefix) || !name.ends_with(suffix)) return std::nullopt;
    int shots = 0;
    const char *first = name.data() + prefix.size(), *last = name.data() + name.size() - suffix.size();
    const auto [end, error] = std::from_chars(first, last, shots);
    if (error != std::errc() || end != last || name != snapshot_file(shots)) return std::nullopt;
    return shots;
}

VertexRadiosity read_snapshot(const std::filesystem::path& file, std::size_t vertices)
{
    try {
        std::vector<Rgb> values = vectors_in(decode_glb(read_bytes(file)), "vertex_radiosity");
        if (values.size() != vertices) throw SceneError("solution", "is not of this run's last mesh");
        return VertexRadiosity(std::move(values));
    } catch (const std::runtime_error& problem) {
        throw SceneError("solution", file.string() + ": " + problem.what());
    }
}

}  // namespace

std::string snapshot_file(int shots)
{
    return fmt::format("{}{:02}{}", prefix, shots, suffix);
}

std::string encode_snapshot(const Scene& scene, const PatchMesh& mesh, const VertexRadiosity& vertex_B)
{
    return encode_glb(scene, mesh, vertex_B, {{"vertex_radiosity", bytes_of(vertex_B.values())}});
}

std::vector<StoredSnapshot> read_snapshots(const std::filesystem::path& folder, std::size_t vertices)
{
    std::vector<StoredSnapshot> snapshots;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        if (const auto shots = shots_in_name(entry->path().filename().string()))
            snapshots.push_back({*shots, read_snapshot(entry->path(), vertices)});
    }
    std::ranges::sort(snapshots, {}, &StoredSnapshot::shots);
    return snapshots;
}

}  // namespace patchlight
