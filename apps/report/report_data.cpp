#include "apps/report/report_data.h"

#include "apps/imaging/line_overlay.h"
#include "apps/report/page_markup.h"
#include "apps/run/stored_scene.h"
#include "apps/run/stored_snapshots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

std::vector<float> floats_of(std::span<const Vec3> values)
{
    std::vector<float> out;
    out.reserve(values.size() * 3);
    for (const Vec3& v : values)
        for (int k = 0; k < 3; ++k) out.push_back(static_cast<float>(v[k]));
    return out;
}

std::vector<float> floats_of(std::span<const double> values)
{
    return {values.begin(), values.end()};
}

/// The first patch of each surface, and one past the last.
std::vector<std::uint32_t> first_patches(const PatchMesh& mesh)
{
    std::vector<std::uint32_t> first;
    for (std::uint32_t s = 0; s < mesh.surface_count(); ++s) first.push_back(mesh.patches_of(SurfaceId(s)).first);
    first.push_back(static_cast<std::uint32_t>(mesh.patch_count()));
    return first;
}

/// The ends of the lines on the mesh, by kind.
Json lines_json(const PatchMesh& mesh, ReportPayload& payload)
{
    Json lines = Json::array();
    for (const LineKind kind : line_kinds) {
        std::vector<std::uint32_t> ends;
        for (const MeshLine& line : mesh.lines())
            if (line.kind == kind && !line.beyond) ends.insert(ends.end(), line.left.begin(), line.left.end());
        lines.push_back(payload.indices(ends));
    }
    return lines;
}

Json cycle_json(int cycle, const StoredSolution& s, bool exact, ReportPayload& payload)
{
    const auto numbers = [&](const std::vector<float>& values) {
        return exact ? payload.floats(values) : payload.halves(values);
    };
    std::vector<std::uint32_t> corners;
    for (const auto& t : s.mesh.arrays().triangles) corners.insert(corners.end(), t.begin(), t.end());
    Json out = {{"cycle", cycle},
                {"exact", exact},
                {"positions", exact ? payload.floats(floats_of(s.mesh.arrays().positions))
                                    : payload.rounded_points(s.mesh.arrays().positions)},
                {"corners", payload.indices(corners)},
                {"vertex_light", numbers(floats_of(s.vertex_B.values()))},
                {"patch_light", numbers(floats_of(s.B.values()))},
                {"eta", numbers(floats_of(s.eta.values()))},
                {"first_patches", payload.integers(first_patches(s.mesh))},
                {"lines", lines_json(s.mesh, payload)}};
    if (exact) out["areas"] = payload.floats(floats_of(s.mesh.areas().values()));
    return out;
}

std::size_t bytes_of(const CycleRecord& record, bool exact)
{
    const std::size_t index = record.vertices > 0x10000U ? 4 : 2, number = exact ? 4 : 2;
    return record.vertices * 6 * number + record.elements * (3 * index + 4 * number + (exact ? 4 : 0));
}

Json scene_json(const Scene& scene, ReportPayload& payload)
{
    Json views = Json::array(), materials = Json::array(), objects = Json::array();
    for (const View& view : scene.views) {
        views.push_back(json_of(view));
        views.back()["name"] = as_utf8(view.name);
        views.back()["aspect"] = view.aspect;
    }
    for (const Material& m : scene.materials)
        materials.push_back(
            {{"name", as_utf8(m.name)}, {"reflectance", json_of(m.reflectance)}, {"emission", json_of(m.emission)}});
    for (const std::string& object : scene.objects) objects.push_back(as_utf8(object));
    std::vector<std::uint32_t> material_of, object_of;
    for (const Surface& surface : scene.surfaces) {
        material_of.push_back(surface.material.value);
        object_of.push_back(surface.object.value);
    }
    return {{"diameter", scene.diameter},
            {"views", views},
            {"materials", materials},
            {"objects", objects},
            {"surface_material", payload.integers(material_of)},
            {"surface_object", payload.integers(object_of)}};
}

Json line_kinds_json()
{
    Json kinds = Json::array();
    for (const LineKind kind : line_kinds) {
        const Rgb c = 255.0 * line_color(kind);
        kinds.push_back(
            {{"name", name_of(kind)},
             {"color", fmt::format("#{:02x}{:02x}{:02x}", std::lround(c.r), std::lround(c.g), std::lround(c.b))}});
    }
    return kinds;
}

/// Of timing.json what the page shows; the host's name is nobody's business. Null without the file, or where seconds
/// are left out.
Json timing_of(const std::filesystem::path& folder)
{
    if (leaves_out_seconds()) return nullptr;
    try {
        const std::string text = read_bytes(folder / "timing.json");
        if (json_depth(text) > 16) return nullptr;
        const Json stored = Json::parse(text);
        Json out = Json::object();
        for (const char* key : {"cycles", "seconds", "threads", "instruction_set"})
            if (stored.is_object() && stored.contains(key)) out[key] = stored[key];
        return out;
    } catch (const std::exception&) {
        return nullptr;  // Only seconds are missing.
    }
}

/// The progressive solution after so many shots, on the last mesh, where the run kept it.
Json shots_json(const OpenedRun& run, const PatchMesh& last, ReportPayload& payload)
{
    Json shots = Json::array();
    for (const StoredSnapshot& snapshot : read_snapshots(run.folder, last.vertex_count()))
        shots.push_back(
            {{"shots", snapshot.shots}, {"vertex_light", payload.halves(floats_of(snapshot.vertex_B.values()))}});
    return shots;
}

}  // namespace

std::vector<std::size_t> even_choice(const std::vector<std::size_t>& bytes, std::size_t most)
{
    for (std::size_t kept = bytes.size();; --kept) {
        std::vector<std::size_t> chosen;
        std::size_t sum = 0;
        for (std::size_t k = 0; k < kept; ++k) {
            chosen.push_back(kept > 1 ? (k * (bytes.size() - 1) + (kept - 1) / 2) / (kept - 1) : 0);
            sum += bytes[chosen.back()];
        }
        if (kept <= 2 || sum <= most) return chosen;
    }
}

ReportData report_data(const OpenedRun& run, std::size_t payload_bytes)
{
    const auto& records = run.record.cycles;
    ReportData data;
    const StoredSolution last = solution_of(run, {});
    const Json scene = scene_json(last.scene, data.payload);
    const Json shots = shots_json(run, last.mesh, data.payload);

    std::vector<std::size_t> bytes;
    for (std::size_t i = 0; i < records.size(); ++i)
        bytes.push_back(bytes_of(records[i], i == 0 || i + 1 == records.size()));
    Json cycles = Json::array();
    const std::size_t room = payload_bytes - std::min(payload_bytes, data.payload.bytes().size());
    for (const std::size_t i : even_choice(bytes, room)) {
        const int cycle = records[i].cycle;
        const bool is_last = i + 1 == records.size();
        cycles.push_back(
            is_last ? cycle_json(cycle, last, true, data.payload)
                    : cycle_json(cycle, solution_of(run, {WhichCycle::Kind::number, cycle}), i == 0, data.payload));
        data.cycles.push_back(cycle);
    }
    data.description = {{"schema", "patchlight-report/1"},
                        {"run", Json::parse(read_bytes(run.folder / "run.json"))},
                        {"timing", timing_of(run.folder)},
                        {"scene", scene},
                        {"line_kinds", line_kinds_json()},
                        {"cycles", cycles},
                        {"shots", shots}};
    return data;
}

}  // namespace patchlight
