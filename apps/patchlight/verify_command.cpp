#include "apps/patchlight/commands.h"
#include "apps/patchlight/progress_display.h"
#include "apps/run/stored_scene.h"
#include "apps/verification/verify.h"
#include "solver/element_light.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <optional>

namespace patchlight {

namespace {

/// What is printed.
struct Verified {
    const Scene& scene;
    const CycleRecord& cycle;
    Verification measured;
    EstimateCheck check;
    PointShares within_own, within_mean;  ///< points within twice their patch's estimate, and twice the whole one
    std::vector<SurfaceError> surfaces;
    double seconds = 0, cpu_seconds = 0;  ///< of path tracing
};

/// The run's reconstruction as probing shows it, and its patches' estimates, √(η²/A).
ShownLight light_of(const StoredSolution& stored, const PatchLocator& locator)
{
    return [&stored, &locator](const DrawnPoint& point) -> ShownPoint {
        const Vec2 q = stored.scene.surface(point.surface).frame.to_plane(point.position);
        const PatchId patch = locator.locate(point.surface, static_cast<float>(q.x), static_cast<float>(q.y));
        if (!patch.valid()) return {};
        const ElementLight light{stored.mesh, locator, stored.vertex_B, &stored.middle_B};
        return {light.at(patch, q) - stored.scene.material_of(point.surface).emission,
                stored.eta[patch] / std::sqrt(stored.mesh.area(patch))};
    };
}

Verification trace(const VerifyCommand& command, const StoredSolution& stored, Session& session)
{
    const RayCaster caster(stored.scene);
    const PatchLocator locator(stored.mesh);
    session.interruption.check();
    ProgressDisplay display(session.messages);
    const WorkMonitor monitor{session.interruption.token(), [&](const WorkState& state) {
                                  display.show({.stage = "paths",
                                                .cycle = -1,
                                                .fraction = state.fraction,
                                                .elements = stored.mesh.patch_count(),
                                                .rays = state.rays});
                              }};
    const VerifyOptions options{command.points, command.most_paths, command.seed, {}};
    return verify_light(stored.scene, caster, light_of(stored, locator), options, monitor);
}

std::string word_of(Verdict verdict)
{
    switch (verdict) {
    case Verdict::holds:
        return "holds";
    case Verdict::too_small:
        return "too small";
    case Verdict::too_large:
        return "too large";
    case Verdict::undecided:
        break;
    }
    return "undecided";
}

Json json_of(const Interval& interval)
{
    return {interval.low, interval.high};
}

Json json_of(const PointShares& shares)
{
    return {{"within", shares.within}, {"beyond", shares.beyond}, {"undecided", shares.undecided}};
}

Json surfaces_json(const Verified& v)
{
    Json all = Json::array();
    for (const SurfaceError& error : v.surfaces) {
        const Surface& surface = v.scene.surface(error.surface);
        all.push_back({{"surface", error.surface.value},
                       {"object", as_utf8(v.scene.objects[surface.object.value])},
                       {"material", as_utf8(v.scene.material_of(error.surface).name)},
                       {"area", surface.area},
                       {"points", error.points},
                       {"l2", error.l2},
                       {"share", error.share}});
    }
    return all;
}

/// Infinite and unknown numbers become null.
std::string json_text(const Verified& v, const VerifyCommand& command)
{
    const MeasuredError& error = v.measured.error;
    const Json all{{"schema", "patchlight-verify/1"},
                   {"cycle", v.cycle.cycle},
                   {"elements", v.cycle.elements},
                   {"seed", command.seed},
                   {"l2", error.l2},
                   {"l2_ci", json_of(error.l2_ci)},
                   {"relrms", error.relrms},
                   {"relrms_ci", json_of(error.relrms_ci)},
                   {"points", v.measured.points.size()},
                   {"estimated_error", v.cycle.estimated_error},
                   {"effectivity", v.check.effectivity},
                   {"effectivity_ci", json_of(v.check.range)},
                   {"verdict", word_of(v.check.verdict)},
                   {"within_twice_the_estimate", {{"patch", json_of(v.within_own)}, {"mean", json_of(v.within_mean)}}},
                   {"paths", v.measured.paths},
                   {"rays", v.measured.rays},
                   {"path_noise", {{"l2", error.l2_noise}, {"relrms", error.relrms_noise}}},
                   {"seconds", v.seconds},
                   {"cpu_seconds", v.cpu_seconds},
                   {"surfaces", surfaces_json(v)}};
    return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string percent(const Interval& interval)
{
    return fmt::format("{:.3g} to {:.3g} %", 100 * interval.low, 100 * interval.high);
}

std::string share_text(const PointShares& shares)
{
    return fmt::format("{:.1f} % of points, {:.1f} % beyond, {:.1f} % undecided", 100 * shares.within,
                       100 * shares.beyond, 100 * shares.undecided);
}

std::string verdict_text(const Verified& v)
{
    const std::string ratio =
        fmt::format("{:.3g} % of estimated error over measured: {:.2f} ({:.2f} to {:.2f})",
                    100 * v.cycle.estimated_error, v.check.effectivity, v.check.range.low, v.check.range.high);
    return v.check.verdict == Verdict::undecided
               ? ratio + ": undecided, more --points or --paths may tell"
               : ratio + ": the estimate " + (v.check.verdict == Verdict::holds ? "" : "is ") +
                     word_of(v.check.verdict);
}

/// The surfaces that the error is on, the worst first.
std::string surface_table(const Verified& v)
{
    constexpr std::size_t shown = 10;
    std::vector<SurfaceError> worst = v.surfaces;
    std::ranges::stable_sort(worst, [](const auto& a, const auto& b) { return a.share > b.share; });
    worst.resize(std::min(shown, worst.size()));
    std::string out = fmt::format("{:>7}  {:<20} {:<16} {:>10} {:>7} {:>9} {:>13}\n", "surface", "object", "material",
                                  "area, m2", "points", "L2", "of all error");
    for (const SurfaceError& error : worst) {
        const Surface& surface = v.scene.surface(error.surface);
        out += fmt::format("{:>7}  {:<20} {:<16} {:>10.4g} {:>7} {:>7.2f} % {:>11.1f} %\n", error.surface.value,
                           as_utf8(v.scene.objects[surface.object.value]),
                           as_utf8(v.scene.material_of(error.surface).name), surface.area, error.points, 100 * error.l2,
                           100 * error.share);
    }
    if (v.surfaces.size() > shown) out += fmt::format("{:>7}  more with --json\n", v.surfaces.size() - shown);
    return out;
}

std::string summary(const Verified& v)
{
    const MeasuredError& error = v.measured.error;
    std::string out = fmt::format("cycle {}, {} elements, beside {} points of {} paths\n", v.cycle.cycle,
                                  v.cycle.elements, v.measured.points.size(), v.measured.paths);
    out += fmt::format("relative L2 error   {:.3g} % (95 %: {})\n", 100 * error.l2, percent(error.l2_ci));
    out += fmt::format("relative RMS error  {:.3g} % (95 %: {})\n", 100 * error.relrms, percent(error.relrms_ci));
    out += verdict_text(v) + "\n";
    out += "within twice their patch's estimate: " + share_text(v.within_own) + "\n";
    out += "within twice the mean estimate: " + share_text(v.within_mean) + "\n";
    out += surface_table(v);
    return out;
}

/// √(Σ|B|²/n), W/m²: what a relative error is relative to.
double mean_light(const std::vector<MeasuredPoint>& points)
{
    double sum = 0;
    for (const MeasuredPoint& p : points) {
        const Rgb squares = p.found * p.found - p.variance;
        sum += squares.r + squares.g + squares.b;
    }
    return points.empty() ? 0 : std::sqrt(std::max(0.0, sum) / static_cast<double>(points.size()));
}

int verify(const VerifyCommand& command, Session& session)
{
    const OpenedRun run = open_run(command.run);
    const StoredSolution stored = solution_of(run, command.cycle);
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t cpu_begin = std::clock();
    Verified v{stored.scene, record_of(run, command.cycle), trace(command, stored, session), {}, {}, {}, {}};
    v.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    v.cpu_seconds = static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
    v.check = check_estimate(v.cycle.estimated_error, v.measured.error);
    const double twice_mean = 2 * v.cycle.estimated_error * mean_light(v.measured.points);
    v.within_own = shares_within(v.measured.points, [](const MeasuredPoint& p) { return 2 * p.estimated; });
    v.within_mean = shares_within(v.measured.points, [&](const MeasuredPoint&) { return twice_mean; });
    v.surfaces = errors_by_surface(v.measured.points);
    session.interruption.check();
    write_result(command.json ? json_text(v, command) : summary(v));
    session.messages.note(
        fmt::format("{:.1f} M rays in {:.1f} s", 1e-6 * static_cast<double>(v.measured.rays), v.seconds));
    return 0;
}

}  // namespace

int run_command(const VerifyCommand& command, Session& session)
{
    session.messages.set_quiet(command.quiet);
    std::optional<tbb::global_control> threads;
    if (command.threads > 0) {
        threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(command.threads));
    }
    try {
        return verify(command, session);
    } catch (const Interrupted&) {
        session.messages.note("interrupted");
        return session.interruption.exit_code();
    }
}

}  // namespace patchlight
