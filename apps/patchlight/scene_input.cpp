#include "apps/patchlight/scene_input.h"

#include "apps/patchlight/usage_error.h"
#include "apps/patchlight/view_choice.h"
#include "apps/run/file_writer.h"
#include "apps/run/sha256.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {

namespace {

void check_material(const Scene& scene, const std::string& option, const std::string& name)
{
    const auto named = [&](const Material& m) { return m.name == name; };
    if (std::any_of(scene.materials.begin(), scene.materials.end(), named)) {
        return;
    }
    std::string known;
    for (const Material& m : scene.materials) {
        known += (known.empty() ? "" : ", ") + m.name;
    }
    throw UsageError("usage", fmt::format("{}: no surface is of a material \"{}\"; there are {}", option, name, known));
}

}  // namespace

SceneInput load_scene(const SceneArguments& arguments)
{
    SceneInput input;
    LoadedScene loaded = read_scene(arguments.file, arguments.options);
    input.scene = std::move(loaded.scene);
    input.report = std::move(loaded.report);
    for (const std::string& name : arguments.options.two_sided) {
        check_material(input.scene, "--two-sided", name);
    }
    for (const auto& [name, value] : arguments.options.emitters) {
        check_material(input.scene, "--emitter", name);
    }
    try {
        input.sha256 = sha256_hex(read_bytes(arguments.file));
    } catch (const std::runtime_error& problem) {
        throw SceneError("file", problem.what());
    }
    if (input.scene.views.empty()) {
        input.scene.views = views_beside(arguments.file, input.scene);
    }
    return input;
}

std::vector<std::string> first_hit_warnings(const FirstHits& hits)
{
    std::vector<std::string> warnings;
    // A floor under standing boxes meets their backs too; in furnished rooms that is below this.
    if (hits.backs > 0.1) {
        warnings.push_back(fmt::format("{:.1f} % of the rays from the surfaces' fronts meet black backs first: "
                                       "the winding may be mixed, or --two-sided is wanted",
                                       100 * hits.backs));
    }
    if (hits.emitted_escaped + hits.emitted_backs > 0.25) {
        warnings.push_back(fmt::format("{:.1f} % of the emitted flux leaves the scene and {:.1f} % meets black backs: "
                                       "an emitter may face the wrong way",
                                       100 * hits.emitted_escaped, 100 * hits.emitted_backs));
    }
    return warnings;
}

double emitted_power(const Scene& scene)
{
    double power = 0;
    for (const Surface& s : scene.surfaces) {
        const Rgb& E = scene.materials[s.material.value].emission;
        power += s.area * (E.r + E.g + E.b);
    }
    return power;
}

double total_area(const Scene& scene)
{
    double area = 0;
    for (const Surface& s : scene.surfaces) {
        area += s.area;
    }
    return area;
}

}  // namespace patchlight
