#include "apps/study/reference_file.h"

#include "apps/run/file_writer.h"
#include "apps/run/whole_number.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

namespace patchlight {

namespace {

constexpr const char* schema = "patchlight-reference/1";

/// surface, x, y, z (relative to the scene's centre, metres), B − E, variance: three bands each.
Json json_of(const std::vector<ReferencePoint>& points)
{
    Json rows = Json::array();
    for (const ReferencePoint& p : points) {
        const auto &x = p.at.position, &b = p.reflected, &v = p.variance;
        rows.push_back(Json::array({p.at.surface.value, x.x, x.y, x.z, b.r, b.g, b.b, v.r, v.g, v.b}));
    }
    return rows;
}

std::vector<ReferencePoint> points_in(const Json& rows)
{
    std::vector<ReferencePoint> points;
    for (const Json& row : rows) {
        const auto three = [&](std::size_t k) {
            return Vec3(row.at(k).get<double>(), row.at(k + 1).get<double>(), row.at(k + 2).get<double>());
        };
        points.push_back({{SurfaceId(whole_number_in<std::size_t>(row.at(0))), three(1)}, three(4), three(7)});
    }
    return points;
}

}  // namespace

void write_block(const std::filesystem::path& file, const std::vector<ReferencePoint>& points, FileWriter& writer)
{
    writer.write(file, json_of(points).dump() + "\n");
}

std::vector<ReferencePoint> read_block(const std::filesystem::path& file)
{
    try {
        return points_in(Json::parse(read_bytes(file)));
    } catch (const std::exception&) {
        return {};
    }
}

void write_reference(const std::filesystem::path& folder, const Json& key, const std::vector<ReferencePoint>& points,
                     FileWriter& writer)
{
    // One row a point, for readers' sake.
    std::string rows;
    for (const Json& row : json_of(points)) rows += (rows.empty() ? "  " : ",\n  ") + row.dump();
    writer.write(
        folder / "reference.json",
        fmt::format("{{\"schema\": \"{}\",\n \"key\": {},\n \"columns\": [\"surface\", \"x\", \"y\", \"z\", "
                    "\"Br-Er\", \"Bg-Eg\", \"Bb-Eb\", \"var_r\", \"var_g\", \"var_b\"],\n \"points\": [\n{}]}}\n",
                    schema, key.dump(), rows));
}

std::optional<std::vector<ReferencePoint>> read_reference(const std::filesystem::path& folder)
{
    const std::filesystem::path file = folder / "reference.json";
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return std::nullopt;
    try {
        const Json json = Json::parse(read_bytes(file));
        if (json.at("schema") != schema) {
            throw std::runtime_error("is of another schema than " + std::string(schema));
        }
        return points_in(json.at("points"));
    } catch (const std::exception& problem) {
        throw SceneError("reference", fmt::format("{}: {}", file.string(), problem.what()));
    }
}

}  // namespace patchlight
