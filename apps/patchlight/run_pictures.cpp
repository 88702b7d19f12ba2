#include "apps/patchlight/run_pictures.h"

#include "apps/imaging/exposure.h"
#include "apps/imaging/line_overlay.h"
#include "apps/run/stored_scene.h"

#include <fmt/format.h>

namespace patchlight {

namespace {

constexpr int samples_along_a_pixel = 2;

std::string text_of(const Vec3& v)
{
    return fmt::format("{} {} {}", v.x, v.y, v.z);
}

}  // namespace

RunPictures::RunPictures(const Scene& scene, const RayCaster& caster, const View& view, int width, int height)
    : scene_(scene), fine_(trace_view(caster, view, width, height, samples_along_a_pixel)),
      centers_(trace_view(caster, view, width, height, 1))
{}

double RunPictures::exposure_for(const ShownSolution& solution) const
{
    return auto_exposure(scene_, centers_, shade_view(solution, centers_, {}));
}

Image RunPictures::srgb(const ShownSolution& solution, double exposure, bool patch_borders) const
{
    PictureOptions options;
    options.white = white_at(exposure);
    options.patch_borders = patch_borders;
    Image picture = to_srgb(shade_view(solution, fine_, options), exposure);
    if (patch_borders) {
        draw_line_legend(solution.mesh, picture);
    }
    return picture;
}

std::vector<unsigned char> RunPictures::png(const ShownSolution& solution, double exposure, bool patch_borders) const
{
    return encode_png(srgb(solution, exposure, patch_borders));
}

std::vector<unsigned char> RunPictures::exr(const ShownSolution& solution, const Json& options) const
{
    return encode_exr(shade_view(solution, centers_, {}), exr_metadata(scene_, centers_.view, options));
}

ImageMetadata exr_metadata(const Scene& scene, const View& view, const Json& options)
{
    return {{"patchlight:quantity", "radiance B/pi"},
            {"patchlight:unit", "W/(m2 sr), linear Rec. 709"},
            {"patchlight:scene", as_utf8(scene.name)},
            {"patchlight:camera_from", text_of((view.from + scene.center) / scene.unit)},
            {"patchlight:camera_forward", text_of(view.forward)},
            {"patchlight:camera_up", text_of(view.up)},
            {"patchlight:camera_vertical_fov", fmt::format("{}", view.vertical_fov)},
            {"patchlight:metres_per_unit", fmt::format("{}", scene.unit)},
            {"patchlight:options", options.dump(-1, ' ', true, Json::error_handler_t::replace)}};
}

std::string caption_title(const std::string& which, const CycleRecord& record)
{
    return fmt::format("{}: {} elements", which, record.elements);
}

std::string caption_detail(const CycleRecord& record)
{
    return fmt::format("estimated error {:.2g} %", 100 * record.estimated_error);
}

}  // namespace patchlight
