#include "apps/run/run_folder.h"
#include "apps/run/sha256.h"
#include "meshing/scene_error.h"
#include "solver/invariants.h"
#include "tests/fuzz/made_run.h"

#include <filesystem>

using namespace patchlight;

namespace {

using testing::Choices;
using testing::made_run;

struct Damaged {
    std::filesystem::path folder;
    std::size_t cycles = 0;  ///< the last of which may be damaged
};

/// The folder of the made run when it was killed after its second cycle, and what the choices damage in it. A solution
/// that is damaged keeps its digest, or is given a new one.
Damaged damaged_folder(Choices& choices)
{
    const std::filesystem::path folder = testing::fuzz_folder().path() / "run";
    std::filesystem::remove_all(folder);
    const testing::MadeRun& run = made_run();
    const std::size_t what = choices.below(6);
    const std::size_t cycles = 1 + choices.below(run.cycles.size());
    RunRecord record;
    record.identity = run.identity;
    for (std::size_t cycle = 0; cycle < cycles; ++cycle) {
        CycleRecord of_cycle = run.records[cycle];
        std::string solution = run.cycles[cycle];
        const bool last = cycle + 1 == cycles;
        if (last && (what == 0 || what == 1)) solution = damaged(solution, choices);
        if (last && what == 1) of_cycle.solution_sha256 = sha256_hex(solution);
        std::string text = json_of(of_cycle).dump(2);
        if (last && what == 2) text = damaged(text, choices);
        if (last && what == 3) text = choices.rest();
        record.cycles.push_back(of_cycle);
        const std::string name = "run/" + cycle_folder(static_cast<int>(cycle)) + "/";
        testing::fuzz_folder().write(name + "solution.glb", solution);
        testing::fuzz_folder().write(name + "record.json", text);
    }
    std::string text = json_of(record).dump(2);
    if (what == 4) text = damaged(text, choices);
    testing::fuzz_folder().write("run/run.json", text);
    testing::fuzz_folder().write("run/timing.json",
                                 what == 5 ? choices.rest() : std::string(R"({"cycles": [{"cycle": 0}]})"));
    return {folder, cycles};
}

/// As SolveRun does, to the end.
void resume(RunFolder& folder)
{
    const RunRecord record = folder.record();
    std::optional<AdaptiveStart> start;
    if (!record.cycles.empty()) {
        const CycleRecord& last = record.cycles.back();
        StoredSolution solution = decode_solution(folder.read_in_cycle(last.cycle, "solution.glb"), "solution.glb");
        start.emplace(
            AdaptiveStart{last.cycle,
                          std::move(solution.mesh),
                          std::move(solution.B),
                          {std::move(solution.eta), std::move(solution.edge), last.error_total, last.estimated_error}});
    }
    AdaptiveObservers observers;
    observers.on_step = [&](const AdaptiveStep& step) {
        folder.finish_cycle(record_of(step), {{"cycle", step.cycle}});
    };
    solve_adaptively(made_run().scene, made_run().options, observers, std::move(start));
    folder.finish(RunStatus::finished, true, {{"host", "here"}});
}

}  // namespace

/// A run's folder that is gone on from. Light that can't be is told, for B of a damaged solution may be anything.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    Choices choices(data, size);
    try {
        FileWriter writer;
        const Damaged damaged = damaged_folder(choices);
        RunFolder folder(damaged.folder, made_run().identity, writer);
        // What is left without the damaged cycle is known to go on.
        if (folder.state() != FolderState::finished && folder.record().cycles.size() == damaged.cycles) resume(folder);
    } catch (const FolderRefused&) {
    } catch (const SceneError&) {
    } catch (const InvariantError&) {}
    return 0;
}
