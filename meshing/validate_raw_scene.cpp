#include "meshing/raw_scene.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

bool finite(const Vec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string place(const RawScene& raw, std::size_t line)
{
    return line > 0 ? fmt::format("{}:{}", raw.file_name, line) : raw.file_name;
}

std::size_t vertex_line(const RawScene& raw, std::size_t vertex)
{
    return vertex < raw.vertex_lines.size() ? raw.vertex_lines[vertex] : 0;
}

void check_options(const SceneOptions& options)
{
    const auto check = [](bool holds, const char* message) {
        if (!holds) throw std::invalid_argument(message);
    };
    check(std::isfinite(options.unit) && options.unit > 0, "SceneOptions::unit must be > 0");
    check(options.max_reflectance > 0 && options.max_reflectance < 1,
          "SceneOptions::max_reflectance must be in (0, 1)");
    check(options.snap > 0 && options.snap < 1e-2, "SceneOptions::snap must be in (0, 0.01)");
}

std::vector<std::size_t> materials_named(const RawScene& raw, const std::string& name)
{
    std::vector<std::size_t> found;
    std::vector<std::string> names;
    for (std::size_t m = 0; m < raw.materials.size(); ++m) {
        names.push_back(raw.materials[m].name);
        if (raw.materials[m].name == name) found.push_back(m);
    }
    if (found.empty()) {
        std::sort(names.begin(), names.end());
        throw SceneError("material", fmt::format("{}: no material named {}, the scene has: {}", raw.file_name, name,
                                                 fmt::join(names, ", ")));
    }
    return found;
}

void check_reflectance(RawScene& raw, Material& material, double max_reflectance)
{
    bool is_one = false;
    for (int band = 0; band < 3; ++band) {
        double& rho = material.reflectance[band];
        if (!(rho >= 0 && rho <= 1)) {
            throw SceneError("material", fmt::format("{}: material {}: reflectance {} is not in [0, 1)", raw.file_name,
                                                     material.name, rho));
        }
        if (rho > max_reflectance) {
            is_one = is_one || rho == 1;
            // A file may ask for .97; only 1 has no solution.
            if (rho == 1) rho = max_reflectance;
        }
        if (!(material.emission[band] >= 0 && std::isfinite(material.emission[band]))) {
            throw SceneError("material", fmt::format("{}: material {}: exitance {} is not ≥ 0 and finite",
                                                     raw.file_name, material.name, material.emission[band]));
        }
    }
    if (is_one) {
        raw.warnings.push_back(
            fmt::format("material {}: a reflectance of 1 is used as {}", material.name, max_reflectance));
    }
}

std::vector<bool> check_corners(const RawScene& raw)
{
    std::vector<bool> used(raw.vertices.size(), false);
    const auto count = static_cast<std::int64_t>(raw.vertices.size());
    for (const RawFace& face : raw.faces) {
        for (const std::int64_t corner : raw.corners_of(face)) {
            if (corner < 0 || corner >= count) {
                throw SceneError("index", fmt::format("{}: face refers to vertex {} of {}", place(raw, face.line),
                                                      corner + 1, count));
            }
            used[static_cast<std::size_t>(corner)] = true;
        }
    }
    return used;
}

void check_vertices(RawScene& raw, const std::vector<bool>& used)
{
    std::size_t bad_unused = 0;
    for (std::size_t v = 0; v < raw.vertices.size(); ++v) {
        if (finite(raw.vertices[v])) continue;
        if (used[v]) {
            throw SceneError("nonfinite",
                             fmt::format("{}: vertex {} is not finite", place(raw, vertex_line(raw, v)), v + 1));
        }
        if (bad_unused++ == 0) {
            raw.warnings.push_back(fmt::format("{}: vertex {} is not finite, but no face uses it",
                                               place(raw, vertex_line(raw, v)), v + 1));
        }
    }
    if (bad_unused > 1) {
        raw.warnings.push_back(
            fmt::format("{}: {} vertices are not finite, no face uses them", raw.file_name, bad_unused));
    }
}

}  // namespace

void apply_material_options(RawScene& raw, const SceneOptions& options)
{
    for (const auto& [name, exitance] : options.emitters) {
        for (const std::size_t m : materials_named(raw, name)) raw.materials[m].emission = exitance;
    }
    for (const std::string& name : options.two_sided) {
        for (const std::size_t m : materials_named(raw, name)) raw.materials[m].two_sided = true;
    }
    if (options.all_two_sided) {
        for (Material& material : raw.materials) material.two_sided = true;
    }
    std::vector<bool> used(raw.materials.size(), false);
    for (const RawFace& face : raw.faces) used[face.material.value] = true;
    for (std::size_t m = 0; m < raw.materials.size(); ++m) {
        if (used[m]) check_reflectance(raw, raw.materials[m], options.max_reflectance);
    }
}

void validate(RawScene& raw, const SceneOptions& options)
{
    check_options(options);
    if (raw.faces.empty()) throw SceneError("empty", fmt::format("{}: the scene has no faces", raw.file_name));
    check_vertices(raw, check_corners(raw));
    apply_material_options(raw, options);
}

}  // namespace patchlight
