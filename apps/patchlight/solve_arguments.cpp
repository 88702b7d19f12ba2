#include "apps/patchlight/solve_arguments.h"

#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/usage_error.h"

#include <fmt/format.h>

namespace patchlight {

namespace {

void add_meshing(CLI::App& app, SolveCommand& c, SolveTexts& t)
{
    AdaptiveOptions& o = c.options;
    app.add_option("--refine", t.refine,
                   "what changes the uniform mesh: the light's intensity, the lines where light and shadow break off, "
                   "both, or nothing")
        ->check(CLI::IsMember(words(refine_names())))
        ->capture_default_str();
    app.add_option(
           "--secondary-sources", o.lines.secondary_share,
           "share of the light reflected first whose surfaces, the brightest four at most, are taken for sources "
           "of shadow lines, too")
        ->check(number_between(0, 1))
        ->type_name("SHARE")
        ->capture_default_str();
    app.add_option("--max-edge", t.max_edge,
                   "longest edge of the first mesh, in --unit [a twelfth of the scene's diameter; none, discontinuity: "
                   "what --max-elements allows]")
        ->check(number_above(0))
        ->type_name("LENGTH");
    app.add_option("--mesh", c.mesh_of,
                   "solve on the last mesh of another run of the same surfaces, as it is: methods compared on one mesh "
                   "[a mesh of its own]")
        ->excludes("--refine")
        ->excludes("--max-edge")
        ->type_name("RUN");
    app.add_flag("--keep-factors", c.keep_factors,
                 "with --refine none or --mesh: keep what is traced in RUN/factors.bin; --mesh RUN then traces nothing "
                 "where only reflectance or emission differ, or the solver [off]");
    t.max_elements_option = app.add_option("--max-elements", o.max_elements, "budget of elements (triangles)")
                                ->check(whole_between(1, 1'000'000'000))
                                ->type_name("N")
                                ->capture_default_str();
    app.add_option("--target-error", o.target_error,
                   "stop when the estimated relative error is below; 0: go on to the budget")
        ->check(number_between(0, 1))
        ->type_name("FRACTION")
        ->capture_default_str();
    app.add_option("--iterations", o.iterations, "adaptive cycles at most")
        ->check(whole_between(1, 1000))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--for-view", c.for_view,
                   "a camera, as --view names it: refine for what it sees, directly or by the light that comes from "
                   "there [everything counts alike]")
        ->type_name("NAME|FILE");
    app.add_option("--indicator", t.indicator, "what is taken for the error of a patch")
        ->check(CLI::IsMember(words(indicator_names())))
        ->capture_default_str();
    app.add_option("--local", o.mark.local,
                   "of what counts as a patch's error, the part that is relative to its own light instead of the whole "
                   "scene's: more elements in dark places")
        ->check(number_between(0, 1))
        ->type_name("SHARE")
        ->capture_default_str();
    app.add_option("--marking", t.marking, "how patches to refine are chosen")
        ->check(CLI::IsMember(words(marking_names())))
        ->capture_default_str();
}

void add_light(CLI::App& app, SolveCommand& c, SolveTexts& t)
{
    AdaptiveOptions& o = c.options;
    app.add_option("--elements", t.elements,
                   "of the final solution: quadratic ones have nodes at the middles of edges, too; the estimated error "
                   "stays that of linear ones")
        ->check(CLI::IsMember(words(element_names())))
        ->capture_default_str();
    app.add_option("--direct", t.direct, "how the emitters' light is found: their visible part exactly, or by rays")
        ->check(CLI::IsMember(words(direct_names())))
        ->capture_default_str();
    app.add_option("--solver", t.solver,
                   "of the final solve; conjugate-gradient makes rows that aren't reciprocal so first, bicgstab takes "
                   "them as they are")
        ->check(CLI::IsMember(words(solver_names())))
        ->capture_default_str();
    t.tolerance_option = app.add_option("--tolerance", o.final.tolerance,
                                        "of the final solve; progressive: 0.01, hierarchical: 0.05 unless given")
                             ->check(number_between(1e-12, 0.5))
                             ->type_name("T")
                             ->capture_default_str();
    app.add_option("--order", t.order, "what progressive shoots first")
        ->check(CLI::IsMember(words(order_names())))
        ->capture_default_str();
    app.add_flag("--overshoot", o.final.overshoot,
                 "progressive shoots what the ambient light will still bring along [off]");
    app.add_option("--form-factors", t.method,
                   "how the rows that are gathered are found; the light at vertices is always gathered by rays")
        ->check(CLI::IsMember(words(form_factor_names())))
        ->capture_default_str();
    app.add_option("--resolution", o.form_factors.resolution, "hemicube: pixels along an edge, even")
        ->check(whole_between(4, 4096))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--rays", o.form_factors.rays, "form-factor rays per patch")
        ->check(whole_between(16, 65536))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--directions", t.directions, "of the rays over the hemisphere")
        ->check(CLI::IsMember(words(direction_names())))
        ->capture_default_str();
    app.add_option("--shadow-rays", o.gather.shadow_rays,
                   "sampled direct light: per vertex, shared among the lamps that are partly hidden from it")
        ->check(whole_between(16, 65536))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--vertex-rays", o.gather.rays,
                   "rays per node where indirect light is gathered; 0: as many as the error asks for, 512 with "
                   "--refine none")
        ->check(whole_between(0, 65536))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--crease-angle", o.gather.crease_angle,
                   "degrees below which facets of one material are shaded as one curved surface")
        ->check(number_between(0, 180))
        ->type_name("DEG")
        ->capture_default_str();
    app.add_option("--seed", o.form_factors.seed, "of all random numbers")
        ->check(whole_between(0, 9'000'000'000'000'000'000))
        ->type_name("N")
        ->capture_default_str();
}

void add_pictures(CLI::App& app, SolveCommand& c, SolveTexts& t)
{
    app.add_option("--pictures", t.pictures, "which pictures are written")
        ->check(CLI::IsMember({"all", "none"}))
        ->capture_default_str();
    app.add_option("--size", t.size, "of the pictures [640 high, as wide as the camera says or 640]")->type_name("WxH");
    app.add_option("--snapshots", t.snapshots,
                   "pictures of the progressive solution after so many shots, as 1,2,3,16 [none]")
        ->type_name("LIST");
    app.add_option("--view", c.scene.view,
                   "a camera of the scene, or a JSON file {name, from, to or forward, up, fov} in the scene's units "
                   "[the scene's first; for an OBJ those of STEM.view.json beside it; or one that is chosen]")
        ->type_name("NAME|FILE");
}

}  // namespace

void add_solve(CLI::App& app, SolveCommand& c, SolveTexts& t)
{
    add_scene(app, c.scene, t.scene);
    app.add_option("-o", c.run, "new folder, or one to resume")->required()->type_name("RUN");
    add_meshing(app, c, t);
    add_light(app, c, t);
    add_pictures(app, c, t);
    app.add_option("--memory", t.memory, memory_help)->type_name("SIZE");
    app.add_option("--time", t.time,
                   "stop after so long, as 90s, 10min or 2h, with exit code 5; the same command goes on from the last "
                   "finished cycle [no limit]")
        ->type_name("LIMIT");
    app.add_option("--config", c.configuration,
                   "a TOML file of these options, as max_elements = 4000; what stands here wins [none]")
        ->type_name("FILE");
}

void finish_solve(SolveCommand& c, const SolveTexts& t)
{
    finish_scene(c.scene, t.scene);
    AdaptiveOptions& o = c.options;
    o.refine = c.mesh_of.empty() ? mode_of(refine_names(), t.refine) : Refine::none;
    o.elements = mode_of(element_names(), t.elements);
    o.direct = mode_of(direct_names(), t.direct);
    o.final.solver = mode_of(solver_names(), t.solver);
    // Shots are dear: a sweep of gathering costs what a few of them do.
    if (o.final.solver == Solver::progressive && t.tolerance_option->count() == 0) o.final.tolerance = 0.01;
    // What links carry may be wrong by this, not only the linear solve.
    if (o.final.solver == Solver::hierarchical && t.tolerance_option->count() == 0) o.final.tolerance = 0.05;
    o.final.order = mode_of(order_names(), t.order);
    o.form_factors.method = mode_of(form_factor_names(), t.method);
    if (o.gather.rays > 0 && o.gather.rays < 16) {
        throw UsageError("usage", fmt::format("--vertex-rays: {} is neither 0 nor 16 or more", o.gather.rays));
    }
    if (o.form_factors.resolution % 2 != 0) {
        throw UsageError("usage", fmt::format("--resolution: {} is odd", o.form_factors.resolution));
    }
    if (o.final.overshoot && o.final.solver != Solver::progressive) {
        throw UsageError("usage", "--overshoot is for --solver progressive");
    }
    o.form_factors.directions = mode_of(direction_names(), t.directions);
    o.estimate.indicator = mode_of(indicator_names(), t.indicator);
    o.mark.marking = mode_of(marking_names(), t.marking);
    o.gather.seed = o.form_factors.seed;
    o.meshing.max_edge = t.max_edge * c.scene.options.unit;
    if (!c.mesh_of.empty() && t.max_elements_option->count() > 0) {
        throw UsageError("usage", "--max-elements: the mesh of --mesh is solved as it is");
    }
    if (c.keep_factors && o.refine != Refine::none) {
        throw UsageError("usage", "--keep-factors is for --refine none and --mesh, where light is gathered from the "
                                  "mesh's own patches");
    }
    const bool uniform = o.refine == Refine::none || o.refine == Refine::discontinuity;
    if (uniform && (t.max_edge <= 0 || t.max_elements_option->count() > 0)) {
        o.meshing.max_elements = o.max_elements;
    }
    if (!t.memory.empty()) {
        c.memory = bytes_in("--memory", t.memory);
    }
    if (!t.time.empty()) {
        c.time = seconds_in("--time", t.time);
    }
    c.pictures.pictures = t.pictures == "all";
    if (!t.size.empty()) {
        c.pictures.size = size_in("--size", t.size);
    }
    if (!t.snapshots.empty()) {
        c.pictures.snapshots = shots_in("--snapshots", t.snapshots);
    }
    if (!c.pictures.pictures && !c.pictures.snapshots.empty()) {
        throw UsageError("usage", "--snapshots are pictures, and --pictures none wants none");
    }
}

}  // namespace patchlight
