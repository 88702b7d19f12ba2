#include "apps/patchlight/verify_report.h"

#include "apps/run/stored_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

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

Json json_of(const VerifiedCycle& c)
{
    return {{"cycle", c.record.cycle},
            {"elements", c.record.elements},
            {"l2", c.error.l2},
            {"l2_ci", json_of(c.error.l2_ci)},
            {"relrms", c.error.relrms},
            {"relrms_ci", json_of(c.error.relrms_ci)},
            {"estimated_error", c.record.estimated_error},
            {"effectivity", c.check.effectivity},
            {"effectivity_ci", json_of(c.check.range)},
            {"verdict", word_of(c.check.verdict)},
            {"within_twice_the_estimate", {{"patch", json_of(c.within_own)}, {"mean", json_of(c.within_mean)}}}};
}

Json json_of(const SurfaceError& error, const Scene& scene)
{
    const Surface& surface = scene.surface(error.surface);
    return {{"surface", error.surface.value},
            {"object", as_utf8(scene.objects[surface.object.value])},
            {"material", as_utf8(scene.material_of(error.surface).name)},
            {"area", surface.area},
            {"points", error.points},
            {"l2", error.l2},
            {"share", error.share}};
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

std::string verdict_text(const VerifiedCycle& c)
{
    switch (c.check.verdict) {
    case Verdict::holds:
        return "it holds";
    case Verdict::too_small:
    case Verdict::too_large:
        return "it is " + word_of(c.check.verdict);
    case Verdict::undecided:
        break;
    }
    return "undecided, more --points or --paths may tell";
}

/// The surfaces that the error is on, the worst first.
std::string surface_table(const VerifyReport& report, const Scene& scene)
{
    constexpr std::size_t shown = 10;
    std::vector<SurfaceError> worst = report.surfaces;
    std::ranges::stable_sort(worst, [](const auto& a, const auto& b) { return a.share > b.share; });
    worst.resize(std::min(shown, worst.size()));
    std::string out = fmt::format("{:>7}  {:<20} {:<16} {:>10} {:>7} {:>9} {:>13}\n", "surface", "object", "material",
                                  "area, m2", "points", "L2", "of all error");
    for (const SurfaceError& error : worst) {
        const Surface& surface = scene.surface(error.surface);
        out += fmt::format("{:>7}  {:<20} {:<16} {:>10.4g} {:>7} {:>7.2f} % {:>11.1f} %\n", error.surface.value,
                           as_utf8(scene.objects[surface.object.value]), as_utf8(scene.material_of(error.surface).name),
                           surface.area, error.points, 100 * error.l2, 100 * error.share);
    }
    if (report.surfaces.size() > shown) out += fmt::format("{:>7}  more with --json\n", report.surfaces.size() - shown);
    return out;
}

std::string cycle_table(const VerifyReport& report)
{
    std::string out = fmt::format("{:>5} {:>9} {:>10} {:>10} {:>22} {:>6} {:>16}\n", "cycle", "elements", "estimated",
                                  "measured", "95 %", "ratio", "95 %");
    for (const VerifiedCycle& c : report.cycles)
        out += fmt::format("{:>5} {:>9} {:>8.3g} % {:>8.3g} % {:>22} {:>6.2f} {:>16}  {}\n", c.record.cycle,
                           c.record.elements, 100 * c.record.estimated_error, 100 * c.error.l2, percent(c.error.l2_ci),
                           c.check.effectivity, fmt::format("{:.2f} to {:.2f}", c.check.range.low, c.check.range.high),
                           word_of(c.check.verdict));
    return out;
}

/// √(Σ|B|²/n), W/m²: what the relative error is relative to.
double mean_light(const std::vector<MeasuredPoint>& points)
{
    double sum = 0;
    for (const MeasuredPoint& p : points) {
        const Rgb squares = p.found * p.found - p.variance;
        sum += squares.r + squares.g + squares.b;
    }
    return points.empty() ? 0 : std::sqrt(std::max(0.0, sum) / static_cast<double>(points.size()));
}

std::string json_text(Json all, const std::vector<FileProblem>& problems)
{
    all["problems"] = Json::array();
    for (const FileProblem& problem : problems)
        all["problems"].push_back({{"file", problem.file}, {"cause", problem.cause}});
    return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

VerifiedCycle verified_cycle(const CycleRecord& record, const VerifiedSolution& solution)
{
    const double twice_mean = 2 * record.estimated_error * mean_light(solution.points);
    return {record, solution.error, check_estimate(record.estimated_error, solution.error),
            shares_within(solution.points, [](const MeasuredPoint& p) { return 2 * p.estimated; }),
            shares_within(solution.points, [twice_mean](const MeasuredPoint&) { return twice_mean; })};
}

std::string json_text(const VerifyReport& report, const Scene& scene)
{
    const VerifiedCycle& last = report.cycles.back();
    Json all{{"schema", "patchlight-verify/1"}, {"seed", report.seed}, {"points", report.points}};
    all.update(json_of(last));
    all["paths"] = report.paths;
    all["rays"] = report.rays;
    all["path_noise"] = {{"l2", last.error.l2_noise}, {"relrms", last.error.relrms_noise}};
    all["seconds"] = report.seconds;
    all["cpu_seconds"] = report.cpu_seconds;
    all["surfaces"] = Json::array();
    for (const SurfaceError& error : report.surfaces) all["surfaces"].push_back(json_of(error, scene));
    if (report.cycles.size() > 1) {
        all["cycles"] = Json::array();
        for (const VerifiedCycle& cycle : report.cycles) all["cycles"].push_back(json_of(cycle));
    }
    return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string json_text(const OpenedRun& run, const std::vector<FileProblem>& problems)
{
    return json_text({{"schema", "patchlight-files/1"}, {"files", run.record.files.size()}}, problems);
}

std::string json_text(const StudyCheck& check)
{
    return json_text({{"schema", "patchlight-files/1"}, {"runs", check.runs.size()}, {"files", check.files}},
                     check.problems);
}

std::string summary_text(const VerifyReport& report, const Scene& scene)
{
    const VerifiedCycle& last = report.cycles.back();
    std::string out = report.cycles.size() > 1 ? cycle_table(report) : "";
    out += fmt::format("cycle     {}, {} elements, beside {} points of {} paths\n", last.record.cycle,
                       last.record.elements, report.points, report.paths);
    out += fmt::format("error     relative L2 {:.3g} % (95 %: {}), relative RMS {:.3g} % (95 %: {})\n",
                       100 * last.error.l2, percent(last.error.l2_ci), 100 * last.error.relrms,
                       percent(last.error.relrms_ci));
    out += fmt::format("estimate  {:.3g} %, of the measured error {:.2f} (95 %: {:.2f} to {:.2f}): {}\n",
                       100 * last.record.estimated_error, last.check.effectivity, last.check.range.low,
                       last.check.range.high, verdict_text(last));
    out += "points    within twice their patch's estimate: " + share_text(last.within_own) + "\n";
    out += "          within twice the whole estimate: " + share_text(last.within_mean) + "\n";
    return out + surface_table(report, scene);
}

}  // namespace patchlight
