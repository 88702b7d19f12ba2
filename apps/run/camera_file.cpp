#include "apps/run/camera_file.h"

#include "apps/run/file_writer.h"
#include "apps/run/stored_scene.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <stdexcept>
#include <system_error>

namespace patchlight {

namespace {

using Json = nlohmann::json;

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

std::vector<View> read_cameras(const std::filesystem::path& file, const Scene& scene)
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
        throw std::invalid_argument(fmt::format("{}: {}", file.string(), error.what()));
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(fmt::format("{}: {}", file.string(), error.what()));
    } catch (const std::runtime_error& error) {
        throw std::invalid_argument(error.what());
    }
}

std::vector<View> cameras_beside(const std::filesystem::path& scene_file, const Scene& scene)
{
    std::filesystem::path beside = scene_file;
    beside.replace_extension(".view.json");
    std::error_code error;
    if (!std::filesystem::is_regular_file(beside, error)) {
        return {};
    }
    return read_cameras(beside, scene);
}

}  // namespace patchlight
