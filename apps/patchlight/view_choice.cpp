#include "apps/patchlight/view_choice.h"

#include "apps/imaging/image.h"
#include "apps/imaging/view_rays.h"
#include "apps/patchlight/usage_error.h"
#include "apps/run/file_writer.h"
#include "apps/run/stored_scene.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

using Json = nlohmann::json;
constexpr int usual_height = 640;

Vec3 vector_in(const Json& view, const char* key)
{
    const Json& value = view.at(key);
    if (!value.is_array() || value.size() != 3) {
        throw std::invalid_argument(fmt::format("\"{}\" is not an array of three numbers", key));
    }
    const Vec3 v{value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) {
        throw std::invalid_argument(fmt::format("\"{}\" is not finite", key));
    }
    return v;
}

void check_keys(const Json& view)
{
    if (!view.is_object()) {
        throw std::invalid_argument("a camera is an object {name, from, to or forward, up, fov}");
    }
    for (const auto& [key, value] : view.items()) {
        if (key != "name" && key != "from" && key != "to" && key != "forward" && key != "up" && key != "fov") {
            throw std::invalid_argument(
                fmt::format("unknown key \"{}\"; there are name, from, to, forward, up, fov", key));
        }
    }
    if (view.contains("to") == view.contains("forward")) {
        throw std::invalid_argument("a camera has either \"to\" or \"forward\"");
    }
}

View view_in(const Json& json, const Scene& scene)
{
    check_keys(json);
    View view;
    view.name = json.value("name", std::string("view"));
    const Vec3 from = vector_in(json, "from");
    const Vec3 forward = json.contains("to") ? vector_in(json, "to") - from : vector_in(json, "forward");
    view.up = json.contains("up") ? vector_in(json, "up") : Vec3{0, 1, 0};
    view.vertical_fov = json.value("fov", view.vertical_fov);
    if (!(glm::length(forward) > 0) || !(glm::length(view.up) > 0)) {
        throw std::invalid_argument("the direction of view or \"up\" has no length");
    }
    if (!(view.vertical_fov >= 0.1 && view.vertical_fov <= 170)) {
        throw std::invalid_argument("\"fov\" is not between 0.1 and 170 degrees");
    }
    view.from = from * scene.unit - scene.center;
    view.forward = glm::normalize(forward);
    view.up = glm::normalize(view.up);
    return view;
}

}  // namespace

std::vector<View> read_views(const std::filesystem::path& file, const Scene& scene)
{
    try {
        const std::string text = read_bytes(file);
        if (json_depth(text) > 8) {
            throw std::invalid_argument("is nested too deeply");
        }
        const Json json = Json::parse(text);
        std::vector<View> views;
        if (!json.is_array()) {
            views.push_back(view_in(json, scene));
            return views;
        }
        for (const Json& one : json) {
            views.push_back(view_in(one, scene));
        }
        if (views.empty()) {
            throw std::invalid_argument("holds no camera");
        }
        return views;
    } catch (const nlohmann::json::exception& error) {
        throw UsageError("view", fmt::format("{}: {}", file.string(), error.what()));
    } catch (const std::invalid_argument& error) {
        throw UsageError("view", fmt::format("{}: {}", file.string(), error.what()));
    } catch (const std::runtime_error& error) {
        throw UsageError("view", error.what());
    }
}

std::vector<View> views_beside(const std::filesystem::path& scene_file, const Scene& scene)
{
    std::filesystem::path beside = scene_file;
    beside.replace_extension(".view.json");
    std::error_code error;
    if (!std::filesystem::is_regular_file(beside, error)) {
        return {};
    }
    return read_views(beside, scene);
}

View view_named(const std::string& name, const Scene& scene)
{
    std::string known;
    for (const View& view : scene.views) {
        if (view.name == name) {
            return view;
        }
        known += (known.empty() ? "" : ", ") + view.name;
    }
    throw UsageError("view", fmt::format("no camera \"{}\"; {}", name,
                                         known.empty() ? "the scene has none" : "the scene has " + known));
}

View chosen_view(const std::string& wanted, const Scene& scene, const RayCaster& caster)
{
    if (wanted.empty()) {
        return scene.views.empty() ? default_view(scene, caster) : scene.views.front();
    }
    const auto named = [&](const View& view) { return view.name == wanted; };
    const auto found = std::find_if(scene.views.begin(), scene.views.end(), named);
    if (found != scene.views.end()) {
        return *found;
    }
    std::error_code error;
    if (std::filesystem::exists(wanted, error)) {
        return read_views(wanted, scene).front();
    }
    return view_named(wanted, scene);
}

std::pair<int, int> picture_size(const std::optional<std::pair<int, int>>& asked, const View& view)
{
    if (asked) {
        return *asked;
    }
    const double aspect = view.aspect > 0 ? std::clamp(view.aspect, 0.1, 10.0) : 1;
    return {static_cast<int>(std::lround(usual_height * aspect)), usual_height};
}

}  // namespace patchlight
