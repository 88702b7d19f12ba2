#include "apps/study/measure.h"

#include "apps/study/shown_points.h"
#include "solver/progress.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace patchlight {

namespace {

constexpr const char* schema = "patchlight-measured/1";

/// |shown − B| at its greatest over √mean |B|².
std::optional<double> greatest_error(const std::vector<MeasuredPoint>& points)
{
    double greatest = 0, light = 0;
    for (const MeasuredPoint& p : points) {
        greatest = std::max(greatest, glm::length(p.shown - p.found));
        light += glm::dot(p.found, p.found) / static_cast<double>(points.size());
    }
    if (greatest == 0) return 0;
    return light > 0 ? std::optional(greatest / std::sqrt(light)) : std::nullopt;
}

/// Everything that measurements depend on.
Json key_of(const OpenedRun& run, const Measures& measures)
{
    Json solutions = Json::array();
    for (const CycleRecord& cycle : run.record.cycles) solutions.push_back(cycle.solution_sha256);
    return {{"solutions", solutions},
            {"reference", measures.points == nullptr ? Json() : Json(measures.reference)},
            {"probes", measures.probes_sha256},
            {"seed", measures.seed},
            {"numeric", numeric_version()}};
}

Json number(const std::optional<double>& value)
{
    return value ? Json(*value) : Json();
}

std::optional<double> number_in(const Json& json)
{
    return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

Json json_of(const Measured& measured, const Json& key)
{
    Json cycles = Json::array(), probes = Json::array();
    for (const CycleError& c : measured.cycles) {
        const Json ci = c.error_ci ? Json::array({c.error_ci->low, c.error_ci->high}) : Json();
        cycles.push_back({{"error", number(c.error)}, {"error_ci", ci}, {"max_error", number(c.max_error)}});
    }
    for (const auto& B : measured.probes) probes.push_back(B ? patchlight::json_of(*B) : Json());
    return {{"schema", schema}, {"key", key}, {"cycles", cycles}, {"probes", probes}};
}

Measured measured_in(const Json& json)
{
    Measured result;
    for (const Json& c : json.at("cycles")) {
        CycleError error{number_in(c.at("error")), number_in(c.at("max_error")), {}};
        if (const Json& ci = c.at("error_ci"); !ci.is_null()) {
            error.error_ci = Interval{ci.at(0).get<double>(), ci.at(1).get<double>()};
        }
        result.cycles.push_back(error);
    }
    for (const Json& B : json.at("probes")) {
        result.probes.push_back(B.is_null() ? std::optional<Rgb>()
                                            : Rgb(B.at(0).get<double>(), B.at(1).get<double>(), B.at(2).get<double>()));
    }
    return result;
}

std::optional<Measured> kept(const std::filesystem::path& cache, const Json& key)
{
    try {
        const Json json = Json::parse(read_bytes(cache));
        if (json.at("schema") == schema && json.at("key") == key) return measured_in(json);
    } catch (const std::exception&) {
        // Measured anew.
    }
    return std::nullopt;
}

}  // namespace

CycleError error_against(const std::vector<ReferencePoint>& reference, const StoredSolution& solution,
                         std::uint64_t seed)
{
    std::vector<DrawnPoint> places;
    for (const ReferencePoint& point : reference) places.push_back(point.at);
    const std::vector<ShownPoint> shown = shown_at(solution, places);
    std::vector<MeasuredPoint> points;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        points.push_back({reference[i].at.surface, shown[i].reflected, shown[i].estimated, reference[i].reflected,
                          reference[i].variance});
    }
    const MeasuredError measured = measured_error(points, reference_seeds(seed).intervals);
    CycleError error;
    if (std::isfinite(measured.l2)) error.error = measured.l2;
    if (std::isfinite(measured.l2_ci.low) && std::isfinite(measured.l2_ci.high)) error.error_ci = measured.l2_ci;
    error.max_error = greatest_error(points);
    return error;
}

Measured measured(const OpenedRun& run, const Measures& measures, const std::filesystem::path& cache,
                  FileWriter* writer, const std::stop_token& stop)
{
    Measured result;
    if ((measures.points == nullptr && measures.probes.empty()) || run.record.cycles.empty()) return result;
    const Json key = key_of(run, measures);
    if (std::optional<Measured> before = kept(cache, key)) return *std::move(before);
    for (const CycleRecord& cycle : run.record.cycles) {
        if (stop.stop_requested()) throw Interrupted();
        const bool last = &cycle == &run.record.cycles.back();
        if (measures.points == nullptr && !last) continue;
        const StoredSolution solution = solution_of(run, {WhichCycle::Kind::number, cycle.cycle});
        if (measures.points != nullptr) {
            result.cycles.push_back(error_against(*measures.points, solution, measures.seed));
        }
        if (!last) continue;
        for (const auto& answer : SurfaceProbe(solution).at(measures.probes)) {
            result.probes.push_back(answer ? std::optional(answer->B) : std::nullopt);
        }
    }
    if (writer != nullptr) writer->write(cache, json_of(result, key).dump(2) + "\n");
    return result;
}

}  // namespace patchlight
