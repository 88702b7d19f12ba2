#include "apps/patchlight/scene_input.h"

#include "apps/patchlight/view_choice.h"
#include "apps/run/file_writer.h"
#include "apps/run/sha256.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

namespace patchlight {

SceneInput load_scene(const SceneArguments& arguments)
{
    SceneInput input;
    LoadedScene loaded = read_scene(arguments.file, arguments.options);
    input.scene = std::move(loaded.scene);
    input.report = std::move(loaded.report);
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
    // Covered floor isn't counted: what is left should be nothing but slits.
    if (hits.backs > 0.01) {
        warnings.push_back(fmt::format("{:.1f} % of the rays from the surfaces' fronts meet black backs first: "
                                       "the winding may be mixed, or --two-sided is wanted",
                                       100 * hits.backs));
    }
    if (hits.emitted_escaped + hits.emitted_backs > 0.5) {
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
