#include "apps/patchlight/solve_run.h"

#include "apps/imaging/comparison.h"
#include "apps/imaging/image_file.h"
#include "apps/patchlight/view_choice.h"
#include "apps/run/sha256.h"
#include "apps/run/stored_factors.h"
#include "apps/run/stored_scene.h"
#include "apps/run/stored_snapshots.h"
#include "meshing/scene_error.h"
#include "solver/snapshots.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <ctime>
#include <sys/resource.h>
#include <unistd.h>

namespace patchlight {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Bytes that this process has held at once.
double peak_memory()
{
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

std::string_view text_of(const std::vector<unsigned char>& bytes)
{
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Rows that were used again leave no mark in run.json, which counts the rays that an answer rests on.
Json seconds_of(const AdaptiveStep& step, std::size_t reused_rays)
{
    const StageSeconds& s = step.seconds;
    const double tracing = s.assemble + s.solve + s.gather + s.estimate;
    return {{"cycle", step.cycle},
            {"seconds",
             {{"mesh", s.mesh},
              {"assemble", s.assemble},
              {"solve", s.solve},
              {"gather", s.gather},
              {"estimate", s.estimate}}},
            {"rays_per_second", tracing > 0 ? static_cast<double>(step.rays - reused_rays) / tracing : 0.0},
            {"rays_reused", reused_rays}};
}

std::string line_of(const CycleRecord& r, const StageSeconds& s)
{
    const double seconds = s.mesh + s.assemble + s.solve + s.gather + s.estimate;
    return fmt::format("cycle {:>2} {:<8} {:>8} elements  estimated error {:.3g} %  {:.3g} rays  {:.2f} s", r.cycle,
                       name_of(stage_names(), r.stage), r.elements, 100 * r.estimated_error,
                       static_cast<double>(r.rays), seconds);
}

}  // namespace

RunIdentity identity_of(const SceneInput& input, const SolveCommand& command, const View& view)
{
    const auto [width, height] = picture_size(command.pictures.size, view);
    RunIdentity id;
    id.scene_file = std::filesystem::path(command.scene.file).filename().string();
    id.scene_sha256 = input.sha256;
    id.content_sha256 = scene_digest(input.scene);
    id.surfaces = input.scene.surfaces.size();
    id.area = total_area(input.scene);
    id.closed = input.scene.closed;
    id.seed = command.options.form_factors.seed;
    Json shown = view.name.empty() ? Json() : json_of(view);
    if (shown.is_object()) {
        shown["name"] = as_utf8(view.name);
    }
    Json scene = json_of(command.scene.options);
    Json goal = command.goal ? json_of(*command.goal) : Json();
    if (goal.is_object()) {
        goal["aspect"] = command.goal->aspect;
    }
    // A round trip through text, so that options compare as they will when read back: names in UTF-8 and numbers alike.
    const Json options = {{"scene", scene},
                          {"solve", json_of(command.options)},
                          {"mesh", command.mesh_of.empty() ? Json() : Json(command.mesh_sha256)},
                          {"for_view", goal},
                          {"pictures",
                           {{"written", command.pictures.pictures ? "all" : "none"},
                            {"width", width},
                            {"height", height},
                            {"view", shown},
                            {"snapshots", command.pictures.snapshots}}}};
    id.options = Json::parse(options.dump(-1, ' ', false, Json::error_handler_t::replace));
    return id;
}

SolveRun::SolveRun(const SceneInput& input, const RayCaster& caster, const View& view, const SolveCommand& command,
                   RunFolder& folder, Session& session, KeptRows rows)
    : input_(input), caster_(caster), view_(view), command_(command), folder_(folder), session_(session),
      display_(session.messages), rows_(std::move(rows)), reused_rays_(rows_.rays())
{
    if (command.pictures.pictures) {
        const auto [width, height] = picture_size(command.pictures.size, view_);
        pictures_.emplace(input.scene, caster, view_, width, height);
    }
}

bool SolveRun::go()
{
    try {
        const RunRecord before = folder_.record();
        if (!before.cycles.empty()) {
            exposure_ = before.cycles.front().exposure;
            session_.messages.note(
                fmt::format("{}: resumed after cycle {}", folder_.path().string(), before.cycles.back().cycle));
        }
        // Nothing left to split: that cycle was the last one, only the pictures are missing.
        if (before.cycles.empty() || before.cycles.back().splits > 0) {
            solve_from(before);
        }
        display_.show({.stage = "results", .cycle = -1});
        write_results();
        display_.clear();
        folder_.finish(converged() ? RunStatus::finished : RunStatus::not_converged, converged(), machine());
        return converged();
    } catch (const Interrupted&) {
        display_.clear();
        const auto cycles = folder_.record().cycles;
        if (!cycles.empty()) {
            folder_.write("solution.glb", folder_.read_in_cycle(cycles.back().cycle, "solution.glb"));
        }
        folder_.finish(RunStatus::interrupted, false, machine());
        throw;
    }
}

void SolveRun::solve_from(const RunRecord& before)
{
    AdaptiveObservers observers;
    observers.stop = session_.interruption.token();
    observers.on_step = [this](const AdaptiveStep& step) { on_step(step); };
    observers.on_progress = [this](const Progress& progress) { display_.show(progress); };
    if (command_.keep_factors || reused_rays_ > 0) {
        observers.rows = &rows_;
    }
    std::optional<AdaptiveStart> from;
    if (!before.cycles.empty()) {
        const CycleRecord& last = before.cycles.back();
        StoredSolution solution = stored(last.cycle);
        if (scene_digest(solution.scene) != before.identity.content_sha256) {
            throw FolderRefused(
                fmt::format("{}: its cycle {} is of another scene", folder_.path().string(), last.cycle));
        }
        from.emplace(
            AdaptiveStart{last.cycle,
                          std::move(solution.mesh),
                          std::move(solution.B),
                          {std::move(solution.eta), std::move(solution.edge), last.error_total, last.estimated_error}});
    }
    solve_adaptively(input_.scene, command_.options, observers, std::move(from));
}

void SolveRun::on_step(const AdaptiveStep& step)
{
    CycleRecord record = record_of(step);
    const std::string bytes =
        encode_solution(input_.scene, step.mesh, step.B, step.vertex_B, step.error.eta, step.error.edge, step.middle_B);
    record.solution_sha256 = sha256_hex(bytes);
    folder_.write_in_cycle(step.cycle, "solution.glb", bytes);
    session_.interruption.check();
    if (pictures_) {
        const auto start = Clock::now();
        const PatchLocator locator(step.mesh);
        const ShownSolution shown{input_.scene, step.mesh, locator, step.B, step.vertex_B, &step.middle_B};
        if (folder_.record().cycles.empty()) {
            exposure_ = pictures_->exposure_for(shown);
        }
        folder_.write_in_cycle(step.cycle, "picture.png", text_of(pictures_->png(shown, exposure_)));
        picture_seconds_ += seconds_since(start);
        session_.interruption.check();
    }
    if (command_.keep_factors) {
        session_.writer.write(folder_.path() / factors_file,
                              encode_factors(rows_, factors_key(input_.scene, step.mesh.arrays(), command_.options,
                                                                caster_.instruction_set())));
        session_.interruption.check();
    }
    record.exposure = exposure_;
    folder_.finish_cycle(record, seconds_of(step, reused_rays_));
    session_.messages.note(line_of(record, step.seconds));
}

void SolveRun::write_results()
{
    const auto cycles = folder_.record().cycles;
    const StoredSolution last = stored(cycles.back().cycle);
    session_.interruption.check();
    if (pictures_) {
        const auto start = Clock::now();
        write_pictures(last);
        write_snapshots(last);
        picture_seconds_ += seconds_since(start);
    }
    folder_.write("solution.glb", folder_.read_in_cycle(cycles.back().cycle, "solution.glb"));
}

void SolveRun::write_pictures(const StoredSolution& last)
{
    const RunRecord record = folder_.record();
    const StoredSolution first = stored(record.cycles.front().cycle);
    const PatchLocator first_locator(first.mesh), last_locator(last.mesh);
    const ShownSolution before{first.scene, first.mesh, first_locator, first.B, first.vertex_B, &first.middle_B};
    const ShownSolution after{last.scene, last.mesh, last_locator, last.B, last.vertex_B, &last.middle_B};
    const Image left = pictures_->srgb(before, exposure_), right = pictures_->srgb(after, exposure_);
    write_picture("before.png", encode_png(left));
    write_picture("after.png", encode_png(right));
    const CycleRecord &a = record.cycles.front(), &b = record.cycles.back();
    write_picture("compare.png", encode_png(side_by_side({left, caption_title("before", a), caption_detail(a)},
                                                         {right, caption_title("after", b), caption_detail(b)})));
    write_picture("mesh-before.png", pictures_->png(before, exposure_, true));
    write_picture("mesh-after.png", pictures_->png(after, exposure_, true));
    write_picture("view.exr", pictures_->exr(after, record.identity.options));
}

void SolveRun::write_snapshots(const StoredSolution& last)
{
    const std::vector<int>& shots = command_.pictures.snapshots;
    if (shots.empty()) {
        return;
    }
    const auto snapshots = progressive_snapshots(input_.scene, caster_, last.mesh, shots, command_.options.gather,
                                                 session_.interruption.token());
    const PatchLocator locator(last.mesh);
    for (std::size_t i = 0; i < shots.size(); ++i) {
        const ShownSolution shown{input_.scene, last.mesh, locator, last.B, snapshots[i]};
        write_picture(fmt::format("shots-{:02}.png", shots[i]), pictures_->png(shown, exposure_));
        folder_.write(snapshot_file(shots[i]), encode_snapshot(input_.scene, last.mesh, snapshots[i]));
    }
}

void SolveRun::write_picture(const std::string& name, const std::vector<unsigned char>& bytes)
{
    folder_.write(name, text_of(bytes));
    session_.interruption.check();
}

StoredSolution SolveRun::stored(int cycle) const
{
    return decode_solution(folder_.read_in_cycle(cycle, "solution.glb"),
                           (folder_.cycle_folder(cycle) / "solution.glb").string());
}

bool SolveRun::converged() const
{
    const CycleRecord last = folder_.record().cycles.back();
    const double target = command_.options.target_error;
    return last.solver_converged && (target <= 0 || last.estimated_error <= target);
}

Json SolveRun::machine() const
{
    char host[256] = {};
    (void)::gethostname(host, sizeof host - 1);
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    return {{"seconds", {{"total", seconds_since(start_)}, {"pictures", picture_seconds_}}},
            {"peak_memory", peak_memory()},
            {"threads", tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)},
            {"instruction_set", caster_.instruction_set()},
            {"host", as_utf8(host)},
            {"ended", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", utc)}};
}

void solve_into(RunFolder& folder, const SceneInput& input, const RayCaster& caster, const View& view,
                const SolveCommand& command, const std::vector<std::string>& warnings, Session& session, KeptRows rows)
{
    folder.set_warnings(warnings);
    session.interruption.on_deadline([&] {
        folder.interrupt();
        session.writer.abandon();
    });
    struct Unhook {
        Interruption& interruption;
        ~Unhook() { interruption.on_deadline({}); }
    } const unhook{session.interruption};
    SolveRun(input, caster, view, command, folder, session, std::move(rows)).go();
}

}  // namespace patchlight
