#include "apps/patchlight/scene_arguments.h"

#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/usage_error.h"

#include <map>

namespace patchlight {

namespace {

const std::map<std::string, double> units{{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}};
constexpr int most_threads = 1024;

}  // namespace

void add_scene(CLI::App& app, SceneArguments& scene, SceneTexts& texts)
{
    app.add_option("scene", scene.file, "OBJ, glTF or GLB file")->required()->type_name("SCENE");
    app.add_option("--unit", scene.unit_name, "unit of the file's coordinates")
        ->check(CLI::IsMember({"m", "cm", "mm", "in", "ft"}))
        ->capture_default_str();
    app.add_option("--two-sided", texts.two_sided, "a material with two sides, or all; may be given again [none]")
        ->type_name("MATERIAL|all")
        ->allow_extra_args(false);
    app.add_option("--emitter", texts.emitters,
                   "exitance in W/m2 of a material, one number or r,g,b; may be given again [the file's]")
        ->type_name("MATERIAL=W")
        ->allow_extra_args(false);
    app.add_option("--max-reflectance", scene.options.max_reflectance, "used where a file says exactly 1")
        ->check(number_between(1e-6, 0.999999))
        ->type_name("RHO")
        ->capture_default_str();
}

void add_machine(CLI::App& app, int& threads, bool& quiet, bool& json, const std::string& json_text)
{
    app.add_option("--threads", threads, "threads to work with [all]")
        ->check(whole_between(1, most_threads))
        ->type_name("N");
    app.add_flag("--quiet", quiet, "no progress; warnings and errors only [off]");
    app.add_flag("--json", json, json_text + " [off]");
}

void finish_scene(SceneArguments& scene, const SceneTexts& texts)
{
    scene.options.unit = metres_per(scene.unit_name);
    for (const std::string& name : texts.two_sided) {
        if (name == "all") {
            scene.options.all_two_sided = true;
        } else {
            scene.options.two_sided.push_back(name);
        }
    }
    for (const std::string& text : texts.emitters) {
        if (!scene.options.emitters.insert(emitter_in("--emitter", text)).second) {
            throw UsageError("usage", "--emitter: \"" + text + "\" names a material for the second time");
        }
    }
}

double metres_per(const std::string& unit)
{
    const auto found = units.find(unit);
    if (found == units.end()) {
        throw UsageError("usage", "--unit: \"" + unit + "\" is none of m, cm, mm, in, ft");
    }
    return found->second;
}

}  // namespace patchlight
