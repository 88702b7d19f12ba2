#include "apps/patchlight/view_choice.h"

#include "apps/imaging/image.h"
#include "apps/imaging/view_rays.h"
#include "apps/patchlight/usage_error.h"
#include "apps/run/camera_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace patchlight {

namespace {

constexpr int usual_height = 640;

/// Cameras that can't be read are a mistake of whoever named the file.
std::vector<View> or_usage_error(const std::function<std::vector<View>()>& read)
{
    try {
        return read();
    } catch (const std::invalid_argument& problem) {
        throw UsageError("view", problem.what());
    }
}

}  // namespace

std::vector<View> read_views(const std::filesystem::path& file, const Scene& scene)
{
    return or_usage_error([&] { return read_cameras(file, scene); });
}

std::vector<View> views_beside(const std::filesystem::path& scene_file, const Scene& scene)
{
    return or_usage_error([&] { return cameras_beside(scene_file, scene); });
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
