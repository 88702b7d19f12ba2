#include "apps/patchlight/inspect_lines.h"

#include "apps/patchlight/scene_input.h"
#include "apps/run/stored_scene.h"
#include "solver/system.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace patchlight {

namespace {

constexpr std::size_t rows_shown = 20;

std::string object_of(const Scene& scene, SurfaceId id)
{
    const ObjectId object = scene.surface(id).object;
    const bool named = object.valid() && object.value < scene.objects.size() && !scene.objects[object.value].empty();
    return as_utf8(named ? scene.objects[object.value] : scene.material_of(id).name);
}

Vec3 in_file(const Scene& scene, SurfaceId surface, const Vec2& q)
{
    return (scene.surface(surface).frame.lift(q) + scene.center) / scene.unit;
}

std::string place_text(const Scene& scene, const SurfaceLine& line, const Vec2& q)
{
    const Vec3 p = in_file(scene, line.surface, q);
    // What rounding leaves of a zero is not worth a column's width.
    const double least = 1e-9 * scene.diameter / scene.unit;
    const auto tidy = [&](double x) { return std::abs(x) < least ? 0.0 : x; };
    return fmt::format("{:.5g} {:.5g} {:.5g}", tidy(p.x), tidy(p.y), tidy(p.z));
}

}  // namespace

std::vector<Discontinuity> strongest_lines(const Scene& scene)
{
    const std::optional<DirectLight> direct = emitters_light(scene);
    std::vector<Discontinuity> lines = discontinuities(scene, direct ? &*direct : nullptr, {});
    // An element's share of an error of 1 % on 8,000 elements, if the emitters' light were spread evenly.
    const double area = total_area(scene), level = 0.01 * emitted_power(scene) / area;
    const double element_error = level * level * area / 8000;
    std::ranges::stable_sort(lines, [&](const auto& a, const auto& b) {
        return elements_saved(a, element_error) > elements_saved(b, element_error);
    });
    return lines;
}

Json json_of(const Scene& scene, const std::vector<Discontinuity>& lines)
{
    Json list = Json::array();
    for (const Discontinuity& d : lines) {
        const SurfaceId s = d.line.surface;
        list.push_back({{"kind", name_of(d.line.kind)},
                        {"surface", s.value},
                        {"object", object_of(scene, s)},
                        {"from", json_of(in_file(scene, s, d.line.start))},
                        {"to", json_of(in_file(scene, s, d.line.end))},
                        {"value", d.value},
                        {"slope", d.slope},
                        {"second", d.second}});
    }
    return list;
}

std::string table_of(const Scene& scene, const std::vector<Discontinuity>& lines)
{
    std::array<std::size_t, line_kinds.size()> count{};
    std::array<double, line_kinds.size()> length{};
    for (const Discontinuity& d : lines) {
        ++count[static_cast<std::size_t>(d.line.kind)];
        length[static_cast<std::size_t>(d.line.kind)] += glm::distance(d.line.start, d.line.end);
    }
    std::string out = "\ndiscontinuity lines    count      length\n";
    for (const LineKind kind : line_kinds) {
        const auto k = static_cast<std::size_t>(kind);
        out += fmt::format("  {:<16} {:>9} {:>9.4g} m\n", name_of(kind), count[k], length[k]);
    }
    if (lines.empty()) {
        return out;
    }
    out += fmt::format("\nthe strongest, with their jumps (W/m2, W/m3, W/m4); ends in file units\n"
                       "{:<8} {:>7}  {:<16} {:>9} {:>9} {:>9}  {:<26} {}\n",
                       "kind", "surface", "object", "value", "slope", "second", "from", "to");
    for (std::size_t i = 0; i < std::min(rows_shown, lines.size()); ++i) {
        const Discontinuity& d = lines[i];
        const SurfaceId s = d.line.surface;
        out += fmt::format("{:<8} {:>7}  {:<16} {:>9.3g} {:>9.3g} {:>9.3g}  {:<26} {}\n", name_of(d.line.kind), s.value,
                           object_of(scene, s), d.value, d.slope, d.second, place_text(scene, d.line, d.line.start),
                           place_text(scene, d.line, d.line.end));
    }
    if (lines.size() > rows_shown) {
        out += fmt::format("and {} more; --json lists all\n", lines.size() - rows_shown);
    }
    return out;
}

}  // namespace patchlight
