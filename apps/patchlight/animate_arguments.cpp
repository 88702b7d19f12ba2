#include "apps/patchlight/animate_arguments.h"

#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/usage_error.h"

namespace patchlight {

void add_animate(CLI::App& app, AnimateCommand& c, AnimateTexts& t)
{
    app.add_option("run", c.run, "folder of a run; RUN@N: as if N were its last cycle")->required()->type_name("RUN");
    app.add_option("-o", c.output, "a .png to write, animated, or a folder for frame-0001.png and so on")
        ->required()
        ->type_name("FILE.png|DIR");
    app.add_option("--what", t.what,
                   "the run's cycles; the pictures that solve --snapshots left there; or a camera's path through the "
                   "last cycle")
        ->check(CLI::IsMember({"cycles", "shots", "path"}))
        ->capture_default_str();
    app.add_option("--path", c.path,
                   "for --what path: JSON array of cameras {name, from, to or forward, up, fov} in the scene's units, "
                   "which a smooth curve joins [none]")
        ->type_name("FILE");
    t.frames = app.add_option("--frames", c.frames, "of a path, from the first camera to the last")
                   ->check(whole_between(2, most_frames))
                   ->type_name("N")
                   ->capture_default_str();
    app.add_option("--view", c.view, "of cycles: a camera of the run [the first]")->type_name("NAME");
    app.add_option("--size", t.size, "of cycles and paths [640 high, as wide as the camera says or 640]")
        ->type_name("WxH");
    app.add_option("--exposure", t.exposure, "of all frames, in stops; auto: what shows the last cycle well")
        ->type_name("EV|auto")
        ->capture_default_str();
    app.add_flag("--wireframe", c.wireframe, "draw the patches' edges [off]");
    t.delay =
        app.add_option("--delay", c.delay, "milliseconds a frame stays, the last three times as long [800; path: 40]")
            ->check(whole_between(1, 65535))
            ->type_name("MS");
}

void finish_animate(AnimateCommand& c, const AnimateTexts& t)
{
    c.what = t.what == "cycles" ? Animated::cycles : t.what == "shots" ? Animated::shots : Animated::path;
    if (!t.size.empty()) c.size = size_in("--size", t.size);
    if (t.exposure != "auto") c.exposure = number_in("--exposure", t.exposure);
    const bool path = c.what == Animated::path;
    if (t.delay->count() == 0) c.delay = path ? 40 : 800;
    if (path == c.path.empty() || (!path && t.frames->count() > 0)) {
        throw UsageError("usage", "--what path needs --path, and what isn't a path has neither --path nor --frames");
    }
    if (!c.view.empty() && c.what != Animated::cycles) throw UsageError("usage", "--view is for --what cycles");
    if (c.what == Animated::shots && (c.size || c.exposure || c.wireframe)) {
        throw UsageError("usage", "shots are shown as solve left them: without --size, --exposure and --wireframe");
    }
    const std::filesystem::path extension = std::filesystem::path(c.output).extension();
    if (!extension.empty() && extension != ".png") {
        throw UsageError("usage", "-o: \"" + c.output + "\" is neither a .png nor a folder without an extension");
    }
}

}  // namespace patchlight
