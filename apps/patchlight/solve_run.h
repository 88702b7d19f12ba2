#pragma once

#include "apps/patchlight/arguments.h"
#include "apps/patchlight/commands.h"
#include "apps/patchlight/progress_display.h"
#include "apps/patchlight/run_pictures.h"
#include "apps/patchlight/scene_input.h"
#include "apps/run/run_folder.h"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace patchlight {

/// One solve into one folder: calls solve_adaptively, writes what it reports, and at the end the pictures.
class SolveRun {
public:
    /// All must live as long as this. `rows`: of another run, used again; none: traced.
    SolveRun(const SceneInput& input, const RayCaster& caster, const View& view, const SolveCommand& command,
             RunFolder& folder, Session& session, KeptRows rows);

    /// From the beginning, or from the last whole cycle in the folder. Returns whether it converged.
    /// Throws Interrupted after run.json has been marked.
    bool go();

private:
    using Clock = std::chrono::steady_clock;

    void solve_from(const RunRecord& before);
    void on_step(const AdaptiveStep& step);
    void write_results();
    void write_pictures(const StoredSolution& last);
    void write_snapshots(const StoredSolution& last);
    void write_picture(const std::string& name, const std::vector<unsigned char>& bytes);
    StoredSolution stored(int cycle) const;
    bool converged() const;
    Json machine() const;

    const SceneInput& input_;
    const RayCaster& caster_;
    const View view_;
    const SolveCommand& command_;
    RunFolder& folder_;
    Session& session_;
    ProgressDisplay display_;
    KeptRows rows_;
    std::size_t reused_rays_ = 0;
    std::optional<RunPictures> pictures_;
    double exposure_ = 0;
    Clock::time_point start_ = Clock::now();
    double picture_seconds_ = 0;
};

/// The whole of a run into its folder, which isn't finished yet; what is there at the deadline after an interrupt is
/// marked. `rows`: of another run, used again. All must live as long as this. Throws as SolveRun::go().
void solve_into(RunFolder& folder, const SceneInput& input, const RayCaster& caster, const View& view,
                const SolveCommand& command, const std::vector<std::string>& warnings, Session& session,
                KeptRows rows = {});

/// What identifies the run of a command: scene and effective options.
RunIdentity identity_of(const SceneInput& input, const SolveCommand& command, const View& view);

}  // namespace patchlight
