#include "apps/patchlight/commands.h"
#include "apps/patchlight/cost_estimate.h"
#include "apps/patchlight/inspect_lines.h"
#include "apps/patchlight/scene_input.h"
#include "apps/run/stored_scene.h"

#include <fmt/format.h>

namespace patchlight {

namespace {

Json counts_of(const SceneReport& r)
{
    return {{"vertices_read", r.vertices_read},
            {"faces_read", r.faces_read},
            {"welded_vertices", r.welded_vertices},
            {"zero_area_faces", r.zero_area_faces},
            {"duplicate_faces", r.duplicate_faces},
            {"nonplanar_faces", r.nonplanar_faces},
            {"self_crossing_faces", r.self_crossing_faces},
            {"nonmanifold_edges", r.nonmanifold_edges},
            {"t_junctions", r.t_junctions},
            {"coplanar_overlaps", r.coplanar_overlaps},
            {"opposed_pairs", r.opposed_pairs},
            {"needles", r.needles},
            {"crossing_faces", r.crossing_faces}};
}

Json materials_of(const Scene& scene)
{
    std::vector<double> areas(scene.materials.size());
    std::vector<std::size_t> surfaces(scene.materials.size());
    for (const Surface& s : scene.surfaces) {
        areas[s.material.value] += s.area;
        ++surfaces[s.material.value];
    }
    Json list = Json::array();
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& m = scene.materials[i];
        const Rgb power = areas[i] * m.emission;
        list.push_back({{"name", as_utf8(m.name)},
                        {"surfaces", surfaces[i]},
                        {"area", areas[i]},
                        {"reflectance", json_of(m.reflectance)},
                        {"emission", json_of(m.emission)},
                        {"power", power.r + power.g + power.b},
                        {"two_sided", m.two_sided}});
    }
    return list;
}

Json box_of(const Scene& scene)
{
    Vec3 low(scene.vertices.empty() ? 0.0 : 1e300), high(scene.vertices.empty() ? 0.0 : -1e300);
    for (const Vec3& p : scene.vertices) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return {{"low", json_of((low + scene.center) / scene.unit)}, {"high", json_of((high + scene.center) / scene.unit)}};
}

Json inspection(const SceneInput& input, const FirstHits& hits, const std::vector<std::string>& warnings)
{
    const Scene& scene = input.scene;
    const CostEstimate cost = estimate_cost(scene, AdaptiveOptions{});
    Json views = Json::array();
    for (const View& view : scene.views) {
        views.push_back(as_utf8(view.name));
    }
    Json said = Json::array();
    for (const std::string& warning : warnings) {
        said.push_back(as_utf8(warning));
    }
    return {{"schema", "patchlight-inspect/1"},
            {"scene", as_utf8(scene.name)},
            {"format", input.report.format},
            {"sha256", input.sha256},
            {"unit", scene.unit},
            {"surfaces", scene.surfaces.size()},
            {"triangles", scene.triangles.size()},
            {"vertices", scene.vertices.size()},
            {"area", total_area(scene)},
            {"emitted_power", emitted_power(scene)},
            {"closed", scene.closed},
            {"diameter", scene.diameter},
            {"bounding_box", box_of(scene)},
            {"snap_distance", input.report.snap_distance},
            {"counts", counts_of(input.report)},
            {"covered_area", input.report.covered_area},
            {"materials", materials_of(scene)},
            {"views", views},
            {"first_hits",
             {{"backs", hits.backs},
              {"escaped", hits.escaped},
              {"emitted_backs", hits.emitted_backs},
              {"emitted_escaped", hits.emitted_escaped}}},
            {"cost", {{"elements", cost.elements}, {"rays", cost.rays}, {"bytes", cost.bytes}}},
            {"warnings", said}};
}

std::string rgb_text(const Json& value)
{
    return fmt::format("{:.3g} {:.3g} {:.3g}", value[0].get<double>(), value[1].get<double>(), value[2].get<double>());
}

std::string table_of(const Json& j, const SceneInput& input)
{
    std::string out = fmt::format("scene      {} ({}), {} per file unit\n", j["scene"].get<std::string>(),
                                  input.report.format, fmt::format("{} m", input.scene.unit));
    out += fmt::format("surfaces   {}, {:.6g} m2, {}\n", input.scene.surfaces.size(), total_area(input.scene),
                       input.scene.closed ? "closed" : "open");
    out += fmt::format("size       diameter {:.6g} m, from {} to {} (file units)\n", input.scene.diameter,
                       rgb_text(j["bounding_box"]["low"]), rgb_text(j["bounding_box"]["high"]));
    out += fmt::format("snapping   below {:.3g} m\n", input.report.snap_distance);
    out += fmt::format("cameras    {}\n", j["views"].empty() ? "none" : j["views"].dump());
    out += "\nmaterial                  surfaces        area  reflectance            power\n";
    for (const Json& m : j["materials"]) {
        out += fmt::format("{:<24} {:>9} {:>8.4g} m2  {:<20} {:>8.4g} W{}\n", m["name"].get<std::string>(),
                           m["surfaces"].get<std::size_t>(), m["area"].get<double>(), rgb_text(m["reflectance"]),
                           m["power"].get<double>(), m["two_sided"].get<bool>() ? "  two-sided" : "");
    }
    out += "\nread and mended\n";
    for (const auto& [name, count] : j["counts"].items()) {
        out += fmt::format("  {:<20} {}\n", name, count.get<std::size_t>());
    }
    out += fmt::format("  {:<20} {:.6g} m2\n", "covered_area", j["covered_area"].get<double>());
    const Json& hits = j["first_hits"];
    out += fmt::format("\nrays from the fronts meet first: black backs {:.2f} %, nothing {:.2f} %\n"
                       "emitted power: black backs {:.2f} %, nothing {:.2f} %\n",
                       100 * hits["backs"].get<double>(), 100 * hits["escaped"].get<double>(),
                       100 * hits["emitted_backs"].get<double>(), 100 * hits["emitted_escaped"].get<double>());
    out += fmt::format("a solve with default options: about {} elements, {:.2g} rays, {:.2g} MiB\n",
                       j["cost"]["elements"].get<std::size_t>(), j["cost"]["rays"].get<double>(),
                       j["cost"]["bytes"].get<double>() / (1024.0 * 1024));
    return out;
}

}  // namespace

int run_command(const InspectCommand& command, Session& session)
{
    const SceneInput input = load_scene(command.scene);
    session.interruption.check();
    const RayCaster caster(input.scene);
    const FirstHits hits = sample_first_hits(input.scene, caster);
    std::vector<std::string> warnings = input.report.warnings;
    for (std::string& warning : first_hit_warnings(hits)) {
        warnings.push_back(std::move(warning));
    }
    for (const std::string& warning : warnings) {
        session.messages.warning(warning);
    }
    Json all = inspection(input, hits, warnings);
    std::vector<Discontinuity> lines;
    if (command.lines) {
        lines = strongest_lines(input.scene);
        all["lines"] = json_of(input.scene, lines);
    }
    write_result(command.json ? all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"
                              : table_of(all, input) + (command.lines ? table_of(input.scene, lines) : ""));
    return 0;
}

}  // namespace patchlight
