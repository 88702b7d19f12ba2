#include "apps/imaging/exposure.h"
#include "apps/imaging/image_file.h"
#include "apps/imaging/line_overlay.h"
#include "apps/patchlight/commands.h"
#include "apps/patchlight/false_color_pictures.h"
#include "apps/patchlight/run_pictures.h"
#include "apps/patchlight/usage_error.h"
#include "apps/patchlight/view_choice.h"
#include "apps/run/probing.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {

namespace {

View render_view(const RenderCommand& command, const Scene& scene, const RayCaster& caster)
{
    View view = command.view.empty() ? chosen_view("", scene, caster) : view_named(command.view, scene);
    if (command.from) {
        view.name = "command line";
        view.from = *command.from * scene.unit - scene.center;
        view.forward = glm::normalize(*command.to - *command.from);
        view.up = glm::normalize(command.up);
        view.aspect = 0;
    }
    if (command.vertical_fov) {
        view.vertical_fov = *command.vertical_fov;
    }
    return view;
}

std::string read_input(const std::string& file)
{
    try {
        return read_bytes(file);
    } catch (const std::runtime_error& problem) {
        throw UsageError("points", problem.what());
    }
}

}  // namespace

int run_command(const RenderCommand& command, Session& session)
{
    const OpenedRun run = open_run(command.run);
    const StoredSolution stored = solution_of(run, command.cycle);
    session.interruption.check();
    const RayCaster caster(stored.scene);
    const PatchLocator locator(stored.mesh);
    const ShownSolution shown{stored.scene, stored.mesh, locator, stored.B, stored.vertex_B, &stored.middle_B};
    const View view = render_view(command, stored.scene, caster);
    const auto [width, height] = picture_size(command.size, view);
    if (command.false_color.quantity) {
        const ViewHits hits = trace_view(caster, view, width, height, 2);
        const FalseColorMap map{shown, stored.eta, hits, command.false_color, command.shade};
        session.interruption.check();
        FileWriter::make_folder_of(command.image);
        session.writer.write(command.image,
                             encode_png(map.picture(scale_of({&map}, command.false_color), command.wireframe)));
        return 0;
    }
    PictureOptions options{.width = width, .height = height, .samples = 1, .shade = command.shade};
    const ViewHits centers = trace_view(caster, view, width, height, 1);
    session.interruption.check();
    if (command.image.ends_with(".exr")) {
        options.patch_borders = command.wireframe;
        const Json about = {{"run", run.record.identity.options},
                            {"shade", command.shade == Shade::flat ? "flat" : "gouraud"}};
        FileWriter::make_folder_of(command.image);
        session.writer.write(command.image,
                             encode_exr(shade_view(shown, centers, options), exr_metadata(stored.scene, view, about)));
        return 0;
    }
    const double exposure = command.exposure
                                ? *command.exposure
                                : auto_exposure(stored.scene, centers, shade_view(shown, centers, options));
    options.samples = 2;
    options.patch_borders = command.wireframe;
    options.white = white_at(exposure);
    Image picture = to_srgb(render_picture(shown, caster, view, options), exposure);
    if (command.wireframe) {
        draw_line_legend(stored.mesh, picture);
    }
    session.interruption.check();
    FileWriter::make_folder_of(command.image);
    session.writer.write(command.image, encode_png(picture));
    return 0;
}

int run_command(const ProbeCommand& command, Session& session)
{
    const std::vector<ProbePoint> points = read_points(read_input(command.points), command.points);
    const StoredSolution stored = solution_of(open_run(command.run), command.cycle);
    session.interruption.check();
    const auto answers = SurfaceProbe(stored).at(points);
    const auto missed = std::count_if(answers.begin(), answers.end(), [](const auto& a) { return !a; });
    if (missed > 0) {
        session.messages.warning(fmt::format("{} of {} points are not on a surface that faces their normal, within "
                                             "1e-6 of the scene's diameter: their values are empty",
                                             missed, points.size()));
    }
    const std::string csv = probe_csv(points, answers);
    if (command.output.empty()) {
        write_result(csv);
    } else {
        FileWriter::make_folder_of(command.output);
        session.writer.write(command.output, csv);
    }
    return 0;
}

int run_command(const PrintCommand& command, Session&)
{
    write_result(command.text);
    return 0;
}

}  // namespace patchlight
