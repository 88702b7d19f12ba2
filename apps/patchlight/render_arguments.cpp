#include "apps/patchlight/render_arguments.h"

#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/usage_error.h"

namespace patchlight {

void add_render(CLI::App& app, RenderCommand& c, RenderTexts& t)
{
    app.add_option("run", c.run, "folder of a run")->required()->type_name("RUN");
    app.add_option("-o", c.image, ".png or .exr file to write")->required()->type_name("IMAGE");
    app.add_option("--cycle", t.cycle, "which cycle: a number, first or last")->type_name("N")->capture_default_str();
    auto* view = app.add_option("--view", c.view, "a camera of the run [the first]")->type_name("NAME");
    app.add_option("--from", t.from, "where the camera is, in the scene file's units [the view's]")
        ->type_name("x,y,z")
        ->excludes(view);
    app.add_option("--to", t.to, "what it looks at [what the view looks at]")->type_name("x,y,z")->excludes(view);
    app.add_option("--up", t.up, "what is up with --from and --to")->type_name("x,y,z")->capture_default_str();
    app.add_option("--fov", t.fov, "vertical field of view, degrees [the view's]")
        ->check(number_between(0.1, 170))
        ->type_name("DEG");
    app.add_option("--size", t.size, "of the picture [640 high, as wide as the camera says or 640]")->type_name("WxH");
    app.add_option("--shade", t.shade, "the elements' reconstruction, or one value a patch")
        ->check(CLI::IsMember({"gouraud", "flat"}))
        ->capture_default_str();
    app.add_flag("--wireframe", c.wireframe,
                 "draw the patches' edges, those on lines where light breaks off in colours [off]");
    app.add_option("--exposure", t.exposure, "stops, or auto; an .exr is always linear")
        ->type_name("EV|auto")
        ->capture_default_str();
    add_false_color_and_show(app, c.false_color, t.false_color);
}

void finish_render(RenderCommand& c, const RenderTexts& t)
{
    c.cycle = cycle_in("--cycle", t.cycle);
    c.shade = t.shade == "flat" ? Shade::flat : Shade::gouraud;
    if (t.from.empty() != t.to.empty()) {
        throw UsageError("usage", "--from and --to belong together");
    }
    if (!t.from.empty()) {
        c.from = vector_in("--from", t.from);
        c.to = vector_in("--to", t.to);
    }
    c.up = vector_in("--up", t.up);
    if (c.from && (*c.from == *c.to || c.up == Vec3(0.0))) {
        throw UsageError("usage", "--from and --to are one point, or --up has no length");
    }
    if (t.fov > 0) {
        c.vertical_fov = t.fov;
    }
    if (!t.size.empty()) {
        c.size = size_in("--size", t.size);
    }
    if (t.exposure != "auto") {
        c.exposure = number_in("--exposure", t.exposure);
    }
    if (!c.image.ends_with(".png") && !c.image.ends_with(".exr")) {
        throw UsageError("usage", "-o: \"" + c.image + "\" ends neither in .png nor in .exr");
    }
    finish_false_color(c.false_color, t.false_color);
    if (c.false_color.quantity && (c.image.ends_with(".exr") || c.exposure)) {
        throw UsageError("usage", "false colours are for a .png and have no --exposure");
    }
}

}  // namespace patchlight
