#include "apps/patchlight/arguments.h"

#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/command_description.h"
#include "apps/patchlight/form_factor_arguments.h"
#include "apps/patchlight/scene_arguments.h"
#include "apps/patchlight/solve_arguments.h"
#include "apps/patchlight/usage_error.h"
#include "apps/patchlight/verify_arguments.h"

#include <fmt/format.h>

#include <algorithm>

namespace patchlight {

namespace {

constexpr const char* run_json = "print run.json instead of a summary";

/// Words that are only understood once everything has been read.
struct Texts {
    std::string size, shade = "gouraud", exposure = "auto", cycle = "last", from, to, up = "0,1,0";
    double fov = 0;
};

void add_render(CLI::App& app, RenderCommand& c, Texts& t)
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
}

void finish_render(RenderCommand& c, const Texts& t)
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
}

/// All that CLI11 fills in; lives while it parses.
struct Parser {
    CLI::App app{"Patchlight: radiosity on adaptive meshes.", "patchlight"};
    SolveCommand solve;
    DemoCommand demo;
    InspectCommand inspect;
    RenderCommand render;
    ProbeCommand probe;
    ExportCommand exported;
    VerifyCommand verify;
    FormFactorsCommand form_factors;
    ValidateCommand validate;
    SolveTexts solve_texts;
    Texts render_texts, probe_texts;
    SceneTexts inspect_texts;
    FormFactorTexts form_factor_texts;
    std::string validate_method, verify_cycle = "last", shell;

    Parser()
    {
        app.require_subcommand(1);
        app.set_version_flag("--version", fmt::format("patchlight {} ({})", tool_version(), tool_commit()),
                             "print the version and stop");
        app.set_help_flag("-h,--help", "print this and stop");
        app.footer("Exit codes: 0 done, 1 internal error, 2 usage, 3 bad scene, 4 not converged or a\n"
                   "bound missed, 5 over a limit, 6 output could not be written, 130 or 143\n"
                   "interrupted.");
        add_demo();
        add_inspect();
        add_solve();
        add_render(*app.add_subcommand("render", "A picture of a stored run"), render, render_texts);
        add_probe();
        add_export();
        add_verify(*app.add_subcommand("verify", "The error of a stored run, measured by path tracing"), verify,
                   verify_cycle);
        add_form_factors(*app.add_subcommand("formfactors", "Form factors between two objects, or of all patches"),
                         form_factors, form_factor_texts);
        add_validate(*app.add_subcommand("validate", "Every form-factor method against known answers"), validate,
                     validate_method);
        add_completion();
    }

    void add_demo()
    {
        auto& c = *app.add_subcommand("demo", "The Cornell box: coarse, refined, side by side");
        c.add_option("-o", demo.folder, "folder to write")->type_name("DIR")->capture_default_str();
        add_machine(c, demo.threads, demo.quiet, demo.json, run_json);
    }

    void add_inspect()
    {
        auto& c = *app.add_subcommand("inspect", "What a scene holds, and what was mended or left out");
        add_scene(c, inspect.scene, inspect_texts);
        c.add_flag("--lines", inspect.lines, "also the lines along which light breaks off, the strongest first [off]");
        c.add_flag("--json", inspect.json, "print JSON [off]");
    }

    void add_solve()
    {
        auto& c = *app.add_subcommand("solve", "Mesh, light, error: the whole loop on a scene");
        patchlight::add_solve(c, solve, solve_texts);
        add_machine(c, solve.threads, solve.quiet, solve.json, run_json);
    }

    void add_probe()
    {
        auto& c = *app.add_subcommand("probe", "Radiosity at points of the surfaces");
        c.add_option("run", probe.run, "folder of a run")->required()->type_name("RUN");
        c.add_option("--points", probe.points, "CSV of x,y,z or x,y,z,nx,ny,nz in the scene file's units")
            ->required()
            ->type_name("FILE");
        c.add_option("-o", probe.output, "CSV to write [standard output]")->type_name("FILE");
        c.add_option("--cycle", probe_texts.cycle, "which cycle: a number, first or last")
            ->type_name("N")
            ->capture_default_str();
    }

    void add_export()
    {
        auto& c = *app.add_subcommand("export", "The solution in other programs' formats");
        c.add_option("run", exported.run, "folder of a run")->required()->type_name("RUN");
        c.add_option("--format", exported.format, "of the file")
            ->required()
            ->check(CLI::IsMember({"glb", "ply", "csv"}));
        c.add_option("-o", exported.output, "file to write")->required()->type_name("FILE");
    }

    void add_completion()
    {
        auto& c = *app.add_subcommand("completion", "What a shell reads to complete patchlight's lines");
        c.add_option("shell", shell, "which one")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
        app.add_subcommand("man", "The manual page, as man reads it");
    }

    /// CLI11 would only say that a command is missing.
    void check_command(int argc, const char* const* argv) const
    {
        std::vector<std::string> commands;
        for (const CommandDescription& command : described(app).commands) {
            commands.push_back(command.name);
        }
        const std::string word = argc > 1 ? argv[1] : "";
        if (!word.empty() && word.front() != '-' && std::ranges::find(commands, word) == commands.end()) {
            throw UsageError("usage",
                             fmt::format("there is no command \"{}\"; there are {}", word, fmt::join(commands, ", ")));
        }
    }

    Command chosen()
    {
        if (app.got_subcommand("solve")) {
            finish_solve(solve, solve_texts);
            return solve;
        }
        if (app.got_subcommand("inspect")) {
            finish_scene(inspect.scene, inspect_texts);
            return inspect;
        }
        if (app.got_subcommand("render")) {
            finish_render(render, render_texts);
            return render;
        }
        if (app.got_subcommand("probe")) {
            probe.cycle = cycle_in("--cycle", probe_texts.cycle);
            return probe;
        }
        if (app.got_subcommand("export")) {
            return exported;
        }
        if (app.got_subcommand("verify")) {
            finish_verify(verify, verify_cycle);
            return verify;
        }
        if (app.got_subcommand("formfactors")) {
            finish_form_factors(form_factors, form_factor_texts);
            return form_factors;
        }
        if (app.got_subcommand("validate")) {
            finish_validate(validate, validate_method);
            return validate;
        }
        if (app.got_subcommand("completion")) {
            return PrintCommand{completion_script(described(app), shell)};
        }
        if (app.got_subcommand("man")) {
            return PrintCommand{man_page(described(app), tool_version())};
        }
        return demo;
    }
};

/// What examples begin with: the program as it was called, where that is short enough to be typed again.
std::string program_in(const std::string& called)
{
    return called == "build/patchlight" || called == "./patchlight" ? called : "patchlight";
}

}  // namespace

Command parse_arguments(int argc, const char* const* argv)
{
    Parser parser;
    parser.check_command(argc, argv);
    try {
        parser.app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        for (const CLI::App* command : parser.app.get_subcommands()) {
            return PrintCommand{help_text(described(*command), program_in(argv[0]))};
        }
        return PrintCommand{help_text(described(parser.app), program_in(argv[0]))};
    } catch (const CLI::CallForVersion& version) {
        return PrintCommand{std::string(version.what()) + "\n"};
    } catch (const CLI::ParseError& error) {
        throw UsageError("usage", std::string(error.what()) + " (patchlight --help tells more)");
    }
    return parser.chosen();
}

}  // namespace patchlight
