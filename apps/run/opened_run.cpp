#include "apps/run/run_folder.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <system_error>

namespace patchlight {

void clear_run(const std::filesystem::path& folder)
{
    std::error_code error;
    for (const char* name : {"run.json", "timing.json", "solution.glb", "before.png", "after.png", "compare.png",
                             "mesh-before.png", "mesh-after.png", "view.exr", "report.html", "factors.bin"}) {
        std::filesystem::remove(folder / name, error);
    }
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name.starts_with("shots-") && (name.ends_with(".png") || name.ends_with(".glb"))) {
            std::filesystem::remove(entry->path(), error);
        }
    }
    std::filesystem::remove_all(folder / "cycles", error);
}

OpenedRun open_run(const std::filesystem::path& folder)
{
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error)) {
        throw FolderRefused(fmt::format("{} is not a folder; give the folder of a run", folder.string()));
    }
    if (!std::filesystem::is_regular_file(folder / "run.json", error)) {
        throw FolderRefused(fmt::format("{} holds no run.json; give the folder of a run", folder.string()));
    }
    try {
        return {folder, run_record_in(read_bytes(folder / "run.json")).record};
    } catch (const SceneError& problem) {
        throw SceneError("run", fmt::format("{}: {}", (folder / "run.json").string(), problem.what()));
    }
}

const CycleRecord& record_of(const OpenedRun& run, const WhichCycle& which)
{
    const auto& cycles = run.record.cycles;
    if (cycles.empty()) {
        throw FolderRefused(
            fmt::format("{} has no finished cycle yet; solve it to the end first", run.folder.string()));
    }
    switch (which.kind) {
    case WhichCycle::Kind::first:
        return cycles.front();
    case WhichCycle::Kind::last:
        return cycles.back();
    case WhichCycle::Kind::number:
        break;
    }
    for (const CycleRecord& cycle : cycles) {
        if (cycle.cycle == which.number) {
            return cycle;
        }
    }
    throw FolderRefused(fmt::format("{} has no cycle {}; it has {} to {}", run.folder.string(), which.number,
                                    cycles.front().cycle, cycles.back().cycle));
}

StoredSolution solution_of(const OpenedRun& run, const WhichCycle& which)
{
    const CycleRecord& record = record_of(run, which);
    std::error_code error;
    const std::filesystem::path last = run.folder / "solution.glb";
    if (which.kind == WhichCycle::Kind::last && std::filesystem::is_regular_file(last, error)) {
        return read_solution(last);
    }
    return read_solution(run.folder / cycle_folder(record.cycle) / "solution.glb");
}

}  // namespace patchlight
