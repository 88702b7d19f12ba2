#include "apps/run/run_record.h"

#include "apps/run/stored_scene.h"
#include "apps/run/whole_number.h"
#include "meshing/scene_error.h"

namespace patchlight {

namespace {

constexpr const char* schema = "patchlight-run/1";
constexpr std::size_t deepest_json = 64;

Json json_of(const EnergyBalance& energy)
{
    return {{"emitted", energy.emitted},
            {"absorbed", energy.absorbed},
            {"escaped", energy.escaped},
            {"relative_residual", energy.relative_residual}};
}

EnergyBalance energy_in(const Json& json)
{
    return {json.at("emitted").get<double>(), json.at("absorbed").get<double>(), json.at("escaped").get<double>(),
            json.at("relative_residual").get<double>()};
}

RunStatus status_in(const std::string& word)
{
    for (RunStatus status :
         {RunStatus::running, RunStatus::interrupted, RunStatus::not_converged, RunStatus::finished}) {
        if (name_of(status) == word) {
            return status;
        }
    }
    throw SceneError("run", "unknown status \"" + word + "\"");
}

using LineCounts = std::array<LineCount, line_kinds.size()>;

Json json_of(const LineCounts& counts)
{
    Json json = Json::object();
    for (const LineKind kind : line_kinds) {
        const LineCount& count = counts[static_cast<std::size_t>(kind)];
        json[std::string(name_of(kind))] = {
            {"found", count.found}, {"inserted", count.inserted}, {"left_out", count.found - count.inserted}};
    }
    return json;
}

LineCounts line_counts_in(const Json& json)
{
    LineCounts counts;
    for (const LineKind kind : line_kinds) {
        const Json& count = json.at(std::string(name_of(kind)));
        counts[static_cast<std::size_t>(kind)] = {whole_number_in<std::size_t>(count.at("found")),
                                                  whole_number_in<std::size_t>(count.at("inserted"))};
    }
    return counts;
}

CycleRecord cycle_in(const Json& json)
{
    CycleRecord r;
    r.cycle = whole_number_in<int>(json.at("cycle"));
    r.stage = mode_of(stage_names(), json.at("stage").get<std::string>());
    r.elements = whole_number_in<std::size_t>(json.at("elements"));
    r.vertices = whole_number_in<std::size_t>(json.at("vertices"));
    r.rays = whole_number_in<std::size_t>(json.at("rays"));
    r.estimated_error = json.at("estimated_error").get<double>();
    r.error_total = json.at("error_total").get<double>();
    r.unshot = json.at("unshot").get<double>();
    const Json& solve = json.at("solve");
    r.solver = mode_of(solver_names(), solve.at("solver").get<std::string>());
    r.solver_iterations = whole_number_in<std::size_t>(solve.at("iterations"));
    r.solver_residual = solve.at("residual").get<double>();
    r.solver_converged = solve.at("converged").get<bool>();
    // Runs of the versions before have none.
    if (solve.contains("history")) {
        r.solver_history = solve.at("history").get<std::vector<double>>();
    }
    r.links = solve.contains("links") ? whole_number_in<std::size_t>(solve.at("links")) : 0;
    r.splits = whole_number_in<std::size_t>(json.at("splits"));
    r.lines = line_counts_in(json.at("lines"));
    r.energy = energy_in(json.at("energy"));
    r.exposure = json.at("exposure").get<double>();
    r.solution_sha256 = json.at("solution_sha256").get<std::string>();
    return r;
}

/// JSON's and our own complaints about a broken record, in one kind.
template <class Read>
auto reading(Read&& read)
{
    try {
        return read();
    } catch (const nlohmann::json::exception& error) {
        throw SceneError("run", error.what());
    } catch (const std::invalid_argument& error) {
        throw SceneError("run", error.what());
    }
}

}  // namespace

std::string name_of(RunStatus status)
{
    switch (status) {
    case RunStatus::running:
        return "running";
    case RunStatus::interrupted:
        return "interrupted";
    case RunStatus::not_converged:
        return "not-converged";
    case RunStatus::finished:
        return "finished";
    }
    return "unknown";
}

CycleRecord record_of(const AdaptiveStep& step)
{
    CycleRecord r;
    r.cycle = step.cycle;
    r.stage = step.stage;
    r.elements = step.mesh.patch_count();
    r.vertices = step.mesh.vertex_count();
    r.rays = step.rays;
    r.estimated_error = step.error.relative;
    r.error_total = step.error.total;
    r.unshot = step.solved.unshot;
    r.solver = step.solved.solver;
    r.solver_iterations = step.solved.iterations;
    r.solver_residual = step.solved.residual;
    r.solver_converged = step.solved.converged;
    r.solver_history = step.solved.history;
    r.links = step.solved.links;
    r.splits = step.splits;
    r.lines = step.lines;
    r.energy = step.energy;
    return r;
}

Json json_of(const CycleRecord& r)
{
    return {{"cycle", r.cycle},
            {"stage", name_of(stage_names(), r.stage)},
            {"elements", r.elements},
            {"vertices", r.vertices},
            {"rays", r.rays},
            {"estimated_error", r.estimated_error},
            {"error_total", r.error_total},
            {"unshot", r.unshot},
            {"solve",
             {{"solver", name_of(solver_names(), r.solver)},
              {"iterations", r.solver_iterations},
              {"residual", r.solver_residual},
              {"converged", r.solver_converged},
              {"history", r.solver_history},
              {"links", r.links}}},
            {"splits", r.splits},
            {"lines", json_of(r.lines)},
            {"energy", json_of(r.energy)},
            {"exposure", r.exposure},
            {"solution_sha256", r.solution_sha256}};
}

CycleRecord cycle_record_in(const Json& json)
{
    return reading([&] { return cycle_in(json); });
}

Json json_of(const RunRecord& record)
{
    const RunIdentity& id = record.identity;
    Json cycles = Json::array();
    for (const CycleRecord& cycle : record.cycles) {
        cycles.push_back(json_of(cycle));
    }
    Json result, energy;
    if (!record.cycles.empty()) {
        const CycleRecord& last = record.cycles.back();
        result = {{"elements", last.elements},
                  {"vertices", last.vertices},
                  {"estimated_error", last.estimated_error},
                  {"converged", record.converged}};
        energy = json_of(last.energy);
    }
    return {{"schema", schema},
            {"tool",
             {{"name", "patchlight"},
              {"version", tool_version()},
              {"commit", tool_commit()},
              {"numeric", numeric_version()}}},
            {"scene",
             {{"file", as_utf8(id.scene_file)},
              {"sha256", id.scene_sha256},
              {"content_sha256", id.content_sha256},
              {"surfaces", id.surfaces},
              {"area", id.area},
              {"closed", id.closed}}},
            {"options", id.options},
            {"seed", id.seed},
            {"warnings", record.warnings},
            {"cycles", cycles},
            {"result", result},
            {"energy", energy},
            {"files", record.files},
            {"status", name_of(record.status)}};
}

StoredRecord run_record_in(const std::string& text)
{
    if (json_depth(text) > deepest_json) {
        throw SceneError("run", "is nested too deeply");
    }
    return reading([&] {
        const Json json = Json::parse(text);
        if (json.at("schema") != schema) {
            throw SceneError("run", "is of another schema than " + std::string(schema));
        }
        StoredRecord stored;
        RunIdentity& id = stored.record.identity;
        const Json& scene = json.at("scene");
        id.scene_file = scene.at("file").get<std::string>();
        id.scene_sha256 = scene.at("sha256").get<std::string>();
        id.content_sha256 = scene.at("content_sha256").get<std::string>();
        id.surfaces = whole_number_in<std::size_t>(scene.at("surfaces"));
        id.area = scene.at("area").get<double>();
        id.closed = scene.at("closed").get<bool>();
        id.options = json.at("options");
        id.seed = whole_number_in<std::uint64_t>(json.at("seed"));
        stored.record.warnings = json.at("warnings").get<std::vector<std::string>>();
        for (const Json& cycle : json.at("cycles")) {
            stored.record.cycles.push_back(cycle_in(cycle));
        }
        // Runs of the versions before have none.
        if (json.contains("files")) {
            stored.record.files = json.at("files").get<std::map<std::string, std::string>>();
        }
        stored.record.status = status_in(json.at("status").get<std::string>());
        stored.record.converged = json.at("result").is_object() && json.at("result").at("converged").get<bool>();
        stored.version = json.at("tool").at("version").get<std::string>();
        stored.commit = json.at("tool").at("commit").get<std::string>();
        stored.numeric = json.at("tool").value("numeric", "");
        return stored;
    });
}

bool same_run(const RunIdentity& a, const RunIdentity& b)
{
    return a.scene_sha256 == b.scene_sha256 && a.content_sha256 == b.content_sha256 && a.options == b.options &&
           a.seed == b.seed;
}

}  // namespace patchlight
