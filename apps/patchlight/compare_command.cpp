#include "apps/imaging/comparison.h"
#include "apps/imaging/exposure.h"
#include "apps/imaging/false_color.h"
#include "apps/patchlight/commands.h"
#include "apps/patchlight/compare_report.h"
#include "apps/patchlight/false_color_pictures.h"
#include "apps/patchlight/result_folder.h"
#include "apps/patchlight/run_choice.h"
#include "apps/patchlight/run_pictures.h"
#include "apps/patchlight/usage_error.h"
#include "apps/patchlight/view_choice.h"
#include "apps/run/stored_scene.h"
#include "apps/verification/surface_sampler.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

/// A stored solution and what is needed to look at it.
struct Side {
    explicit Side(const std::string& text)
        : chosen(chosen_run(text)), record(record_of(chosen.run, chosen.cycle)),
          stored(solution_of(chosen.run, chosen.cycle)), locator(stored.mesh)
    {}

    ShownSolution shown() const
    {
        return {stored.scene, stored.mesh, locator, stored.B, stored.vertex_B, &stored.middle_B};
    }

    ChosenRun chosen;
    CycleRecord record;
    StoredSolution stored;
    PatchLocator locator;
};

/// The scene without its cameras and its file's name: what the light depends on.
std::string content_of(Scene scene)
{
    scene.views.clear();
    scene.name.clear();
    return scene_digest(scene);
}

void check_scenes(const Side& a, const Side& b)
{
    const std::string in_a = content_of(a.stored.scene), in_b = content_of(b.stored.scene);
    if (in_a != in_b) {
        throw UsageError("compare", fmt::format("the scenes differ: {} has {} ({:.12}), {} has {} ({:.12})",
                                                a.chosen.name, a.chosen.run.record.identity.scene_file, in_a,
                                                b.chosen.name, b.chosen.run.record.identity.scene_file, in_b));
    }
}

/// Both runs' camera of that name must be the same one.
View shared_view(const CompareCommand& command, const Side& a, const Side& b, const RayCaster& caster)
{
    const View view =
        command.view.empty() ? chosen_view("", a.stored.scene, caster) : view_named(command.view, a.stored.scene);
    if (!command.view.empty()) (void)view_named(command.view, b.stored.scene);
    for (const View& other : b.stored.scene.views) {
        if (other.name == view.name && json_of(other) != json_of(view)) {
            throw UsageError("compare",
                             fmt::format("the camera \"{}\" differs: {} has {}, {} has {}", view.name, a.chosen.name,
                                         json_of(view).dump(), b.chosen.name, json_of(other).dump()));
        }
    }
    return view;
}

/// Radiance as it was solved, which must be a number everywhere.
Image radiance_of(const Side& side, const ViewHits& hits)
{
    Image radiance = shade_view(side.shown(), hits, {});
    if (!std::ranges::all_of(radiance.rgb, [](float v) { return std::isfinite(v); })) {
        throw SceneError("nonfinite", side.chosen.name + ": its solution is not finite everywhere");
    }
    return radiance;
}

/// Linear, 1 = white.
Image exposed(const Side& side, const ViewHits& hits, double exposure)
{
    PictureOptions options;
    options.white = white_at(exposure);
    Image image = shade_view(side.shown(), hits, options);
    const auto scale = static_cast<float>(std::exp2(exposure));
    for (float& value : image.rgb) value *= scale;
    return image;
}

double l2_error(const Side& a, const Side& b, std::size_t count, std::uint64_t seed)
{
    const Scene& scene = a.stored.scene;
    double difference = 0, whole = 0;
    for (const DrawnPoint& point : draw_points(reflecting_surface(scene), count, seed)) {
        const Vec2 q = scene.surface(point.surface).frame.to_plane(point.position);
        const Rgb in_a = a.shown().light().at(point.surface, q), in_b = b.shown().light().at(point.surface, q);
        const Rgb reflected = in_b - scene.material_of(point.surface).emission;
        difference += glm::dot(in_a - in_b, in_a - in_b);
        whole += glm::dot(reflected, reflected);
    }
    return difference > 0 ? std::sqrt(difference / whole) : 0;
}

Image mapped(const ScalarImage& values, const FalseColor& how, const std::string& title)
{
    const QuantityMap map{1, values, {}, {}};
    return with_legend(false_color(map, how), how, title);
}

/// All pictures of a comparison, by name.
class ComparePictures {
public:
    ComparePictures(const CompareCommand& command, const Side& a, const Side& b, const RunPictures& pictures,
                    double exposure)
        : command_(command), a_(a), b_(b), pictures_(pictures), exposure_(exposure)
    {}

    /// RMSE and FLIP, and what the pictures of differences show.
    void measure(CompareReport& report)
    {
        const ViewHits& hits = pictures_.samples();
        const Image in_a = radiance_of(a_, hits), in_b = radiance_of(b_, hits);
        report.rmse = root_mean_square(in_a, in_b);
        absolute_ = absolute_difference(in_a, in_b);
        signed_ = signed_difference(in_a, in_b);
        flip_ = flip_map(exposed(a_, hits, exposure_), exposed(b_, hits, exposure_));
        report.flip = summary_of(flip_);
    }

    std::vector<std::pair<std::string, Image>> made() const
    {
        const Image left = pictures_.srgb(a_.shown(), exposure_), right = pictures_.srgb(b_.shown(), exposure_);
        std::vector<std::pair<std::string, Image>> files;
        files.emplace_back("side-by-side.png", row_of(left, right));
        files.emplace_back("wipe.png", wiped(left, right));
        files.emplace_back("difference-absolute.png", absolute());
        files.emplace_back("difference-signed.png", with_sign());
        files.emplace_back("flip.png", mapped(flip_, {color_table("magma"), {ScaleKind::linear, 0, 1}}, "FLIP"));
        files.emplace_back("mesh-a.png", pictures_.srgb(a_.shown(), exposure_, true));
        files.emplace_back("mesh-b.png", pictures_.srgb(b_.shown(), exposure_, true));
        if (command_.false_color.quantity) files.emplace_back("false-color.png", in_false_colors());
        return files;
    }

private:
    Image row_of(const Image& left, const Image& right) const
    {
        return side_by_side({left, caption_title("A", a_.record), caption_detail(a_.record)},
                            {right, caption_title("B", b_.record), caption_detail(b_.record)});
    }

    ValueScale difference_scale() const { return fitting_scale(absolute_.values, ScaleKind::linear); }

    Image absolute() const
    {
        return mapped(absolute_, {color_table("inferno"), difference_scale()}, "|A - B|, W/(m² sr)");
    }

    Image with_sign() const
    {
        const double most = difference_scale().high;
        return mapped(signed_, {diverging_colors(), {ScaleKind::linear, -most, most}},
                      "A - B, W/(m² sr); red: A is brighter");
    }

    Image in_false_colors() const
    {
        const FalseColorArguments& how = command_.false_color;
        const FalseColorMap left(a_.shown(), a_.stored.eta, pictures_.samples(), how, Shade::gouraud);
        const FalseColorMap right(b_.shown(), b_.stored.eta, pictures_.samples(), how, Shade::gouraud);
        const ValueScale scale = scale_of({&left, &right}, how);
        return row_of(left.picture(scale, false), right.picture(scale, false));
    }

    const CompareCommand& command_;
    const Side& a_;
    const Side& b_;
    const RunPictures& pictures_;
    double exposure_;
    ScalarImage absolute_, signed_, flip_;
};

/// Whatever a comparison writes.
const std::vector<std::string>& compare_files()
{
    static const std::vector<std::string> names{
        "compare.json", "side-by-side.png", "wipe.png",   "difference-absolute.png", "difference-signed.png",
        "flip.png",     "mesh-a.png",       "mesh-b.png", "false-color.png"};
    return names;
}

}  // namespace

int run_command(const CompareCommand& command, Session& session)
{
    const Side a(command.a), b(command.b);
    session.interruption.check();
    check_scenes(a, b);
    const RayCaster caster(a.stored.scene);
    const View view = shared_view(command, a, b, caster);
    const auto [width, height] = picture_size(command.size, view);
    const RunPictures pictures(a.stored.scene, caster, view, width, height);
    CompareReport report{.a = {a.chosen.name, a.record, seconds_until(a.chosen.run, a.record)},
                         .b = {b.chosen.name, b.record, seconds_until(b.chosen.run, b.record)},
                         .view = view,
                         .width = width,
                         .height = height};
    report.exposure = command.exposure ? *command.exposure : pictures.exposure_for(a.shown());
    session.interruption.check();
    ComparePictures shown(command, a, b, pictures, report.exposure);
    shown.measure(report);
    report.points = command.points;
    report.seed = command.seed;
    if (command.points > 0) report.l2 = l2_error(a, b, command.points, command.seed);
    session.interruption.check();

    const auto files = shown.made();
    for (const auto& [name, image] : files) report.files.push_back(name);
    ResultFolder folder(command.folder, "compare.json", compare_files(), session.writer);
    // First: a folder that an interrupted comparison leaves behind is known as ours.
    folder.write("compare.json", json_of(report, false).dump(2) + "\n");
    for (const auto& [name, image] : files) {
        session.interruption.check();
        folder.write(name, encode_png(image));
    }
    write_result(command.json ? json_of(report, true).dump(2) + "\n" : table_of(report));
    const auto broken = broken_limits(report, command.limits);
    for (const std::string& line : broken) session.messages.error("over", line);
    return broken.empty() ? 0 : 7;
}

}  // namespace patchlight
