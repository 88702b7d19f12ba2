#include "apps/patchlight/kept_factors.h"

#include "apps/patchlight/usage_error.h"
#include "apps/run/stored_factors.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace patchlight {

namespace {

constexpr double mib = 1024.0 * 1024;

/// Of the nearest folder above that exists; negative: unknown.
double room_on_disk(std::filesystem::path folder)
{
    std::error_code error;
    folder = std::filesystem::absolute(folder, error);
    while (!std::filesystem::exists(folder, error) && folder.has_parent_path() && folder != folder.parent_path())
        folder = folder.parent_path();
    const auto space = std::filesystem::space(folder, error);
    return error ? -1 : static_cast<double>(space.available);
}

}  // namespace

KeptRows factors_of_run(const SolveCommand& command, const Scene& scene, const RayCaster& caster,
                        const Session& session)
{
    if (command.mesh_of.empty()) return {};
    const std::filesystem::path file = std::filesystem::path(command.mesh_of) / factors_file;
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return {};
    const auto bytes = static_cast<double>(std::filesystem::file_size(file, error));
    const PatchMeshArrays& mesh = *command.options.mesh;
    // The file, and its rows, which take more where factors are stored in single precision, twice.
    require_memory(4 * bytes + mesh_bytes(static_cast<double>(mesh.triangles.size())), command.memory,
                   fmt::format("delete {}: its rows are then traced anew", file.string()));
    try {
        const Json key = factors_key(scene, mesh, command.options, caster.instruction_set());
        StoredFactors stored = decode_factors(read_bytes(file), key, mesh.triangles.size());
        if (stored.rows) {
            session.messages.note(fmt::format("{}: used again, {:.3g} rays needn't be traced", file.string(),
                                              static_cast<double>(stored.rows->rays())));
            return std::move(*stored.rows);
        }
        session.messages.note(fmt::format("{}: not used, for other \"{}\"", file.string(), stored.differs));
    } catch (const std::runtime_error& problem) {
        session.messages.warning(fmt::format("{}: {}; traced anew", file.string(), problem.what()));
    }
    return {};
}

void check_factors_fit(const SolveCommand& command, const CostEstimate& cost, const Session& session)
{
    if (!command.keep_factors) return;
    const double bytes = factors_bytes(static_cast<double>(cost.elements), command.options);
    require_memory(cost.bytes + 3 * bytes, command.memory,
                   "ask for fewer elements or rays, or leave out --keep-factors");
    const double room = room_on_disk(command.run);
    if (room >= 0 && bytes > room)
        throw LimitError(
            fmt::format("--keep-factors needs up to {:.0f} MiB on the disk of {}, and {:.0f} are free; ask "
                        "for fewer elements or rays",
                        bytes / mib, command.run, room / mib));
    session.messages.note(fmt::format("{} takes up to {:.0f} MiB", factors_file, bytes / mib));
}

}  // namespace patchlight
