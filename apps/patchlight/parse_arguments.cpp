#include "apps/patchlight/arguments.h"

#include "apps/patchlight/animate_arguments.h"
#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/command_description.h"
#include "apps/patchlight/compare_arguments.h"
#include "apps/patchlight/export_arguments.h"
#include "apps/patchlight/form_factor_arguments.h"
#include "apps/patchlight/render_arguments.h"
#include "apps/patchlight/report_arguments.h"
#include "apps/patchlight/rerun_arguments.h"
#include "apps/patchlight/scene_arguments.h"
#include "apps/patchlight/solve_arguments.h"
#include "apps/patchlight/study_arguments.h"
#include "apps/patchlight/study_options.h"
#include "apps/patchlight/usage_error.h"
#include "apps/patchlight/verify_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace patchlight {

namespace {

constexpr const char* run_json = "print run.json instead of a summary";

/// All that CLI11 fills in; lives while it parses.
struct Parser {
    CLI::App app{"Patchlight: radiosity on adaptive meshes.", "patchlight"};
    SolveCommand solve;
    DemoCommand demo;
    InspectCommand inspect;
    RenderCommand render;
    ProbeCommand probe;
    ExportCommand exported;
    ExportTexts export_texts;
    VerifyCommand verify;
    FormFactorsCommand form_factors;
    ValidateCommand validate;
    CompareCommand compare;
    AnimateCommand animate;
    ReportCommand report;
    RerunCommand rerun;
    StudyCommands study;
    SolveTexts solve_texts;
    RenderTexts render_texts;
    SceneTexts inspect_texts;
    FormFactorTexts form_factor_texts;
    CompareTexts compare_texts;
    AnimateTexts animate_texts;
    std::string rerun_memory, validate_method, verify_cycle = "last", probe_cycle = "last", shell;

    Parser()
    {
        app.require_subcommand(1);
        app.set_version_flag("--version", fmt::format("patchlight {} ({})", tool_version(), tool_commit()),
                             "print the version and stop");
        app.set_help_flag("-h,--help", "print this and stop");
        app.footer("Exit codes: 0 done, 1 internal error, 2 usage, 3 bad scene, 4 not converged or a\n"
                   "bound missed, 5 over a limit, 6 output could not be written, 7 a comparison over\n"
                   "its threshold, 130 or 143 interrupted.");
        add_demo();
        add_inspect();
        add_solve();
        add_render(*app.add_subcommand("render", "A picture of a stored run"), render, render_texts);
        add_compare(*app.add_subcommand("compare", "Two runs seen alike: pictures, differences, numbers"), compare,
                    compare_texts);
        add_animate(*app.add_subcommand("animate", "A run's cycles, shots or a camera's path as an animated picture"),
                    animate, animate_texts);
        add_probe();
        add_export(*app.add_subcommand("export", "The solution in other programs' formats"), exported, export_texts);
        add_verify(*app.add_subcommand("verify", "The error of a stored run, measured by path tracing"), verify,
                   verify_cycle);
        add_rerun(*app.add_subcommand("rerun", "A stored run solved again, and whether it comes out the same"), rerun,
                  rerun_memory);
        add_form_factors(*app.add_subcommand("formfactors", "Form factors between two objects, or of all patches"),
                         form_factors, form_factor_texts);
        add_validate(*app.add_subcommand("validate", "Every form-factor method against known answers"), validate,
                     validate_method);
        add_report(*app.add_subcommand("report", "A stored run as one HTML page, with the scene in 3-D"), report);
        patchlight::add_study(*app.add_subcommand("study", "Many runs from one file, measured alike"), study);
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
        c.add_option("--cycle", probe_cycle, "which cycle: a number, first or last")
            ->type_name("N")
            ->capture_default_str();
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
        CommandDescription group = described(app);
        for (int i = 1; i < argc && !group.commands.empty(); ++i) {
            const std::string word = argv[i];
            std::vector<std::string> names;
            std::ranges::transform(group.commands, std::back_inserter(names), &CommandDescription::name);
            const auto known = std::ranges::find(names, word);
            if (word.empty() || word.front() == '-') return;
            if (known == names.end()) {
                throw UsageError("usage", fmt::format("there is no command \"{}\"; there are {}",
                                                      group.path.empty() ? word : group.path + " " + word,
                                                      fmt::join(names, ", ")));
            }
            group = CommandDescription(group.commands[static_cast<std::size_t>(known - names.begin())]);
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
        if (app.got_subcommand("compare")) {
            finish_compare(compare, compare_texts);
            return compare;
        }
        if (app.got_subcommand("animate")) {
            finish_animate(animate, animate_texts);
            return animate;
        }
        if (app.got_subcommand("probe")) {
            probe.cycle = cycle_in("--cycle", probe_cycle);
            return probe;
        }
        if (app.got_subcommand("export")) {
            finish_export(exported, export_texts);
            return exported;
        }
        if (app.got_subcommand("verify")) {
            finish_verify(verify, verify_cycle);
            return verify;
        }
        if (app.got_subcommand("rerun")) {
            finish_rerun(rerun, rerun_memory);
            return rerun;
        }
        if (app.got_subcommand("formfactors")) {
            finish_form_factors(form_factors, form_factor_texts);
            return form_factors;
        }
        if (app.got_subcommand("validate")) {
            finish_validate(validate, validate_method);
            return validate;
        }
        if (app.got_subcommand("report")) {
            finish_page(report.page);
            return report;
        }
        if (app.got_subcommand("study")) {
            return chosen_study(*app.get_subcommand("study"), study);
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

/// The help of the command that was asked for, however deep it stands.
std::string help_of(const CLI::App& app, const std::string& program)
{
    const CLI::App* asked = &app;
    while (!asked->get_subcommands().empty()) asked = asked->get_subcommands().front();
    return help_text(described(*asked), program);
}

/// The options of solve's configuration file that its command line doesn't decide.
std::vector<OptionText> configured(const CLI::App& solve, const std::string& file)
{
    std::vector<OptionText> options;
    try {
        options = read_configuration(text_of_study(file), file, solve_option_names());
    } catch (const StudyError& error) {
        throw UsageError("configuration", error.what());
    }
    std::erase_if(options, [&](const OptionText& option) {
        const CLI::Option* known = solve.get_option("--" + option.name);
        const auto given = [](const CLI::Option* other) { return other->count() > 0; };
        return given(known) || std::ranges::any_of(known->get_excludes(), given);
    });
    return options;
}

/// What a configuration says, as if it stood on the command line.
Command configured_solve(const Parser& first, int argc, const char* const* argv)
{
    const std::string file = first.solve.configuration;
    const std::vector<OptionText> options = configured(*first.app.get_subcommand("solve"), file);
    std::vector<std::string> words{argv[0], "solve"};
    for (const OptionText& option : options) {
        const std::vector<std::string> more = words_of(option, file);
        words.insert(words.end(), more.begin(), more.end());
    }
    words.insert(words.end(), argv + 2, argv + argc);
    std::vector<const char*> all;
    for (const std::string& word : words) all.push_back(word.c_str());
    Parser parser;
    try {
        parser.app.parse(static_cast<int>(all.size()), all.data());
        return parser.chosen();
    } catch (const CLI::ParseError& error) {
        throw UsageError("usage", with_place(error.what(), options, file));
    } catch (const UsageError& error) {
        throw UsageError(error.code(), with_place(error.what(), options, file));
    }
}

}  // namespace

Command parse_arguments(int argc, const char* const* argv)
{
    Parser parser;
    parser.check_command(argc, argv);
    try {
        parser.app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return PrintCommand{help_of(parser.app, program_in(argv[0]))};
    } catch (const CLI::CallForVersion& version) {
        return PrintCommand{std::string(version.what()) + "\n"};
    } catch (const CLI::ParseError& error) {
        throw UsageError("usage", std::string(error.what()) + " (patchlight --help tells more)");
    }
    return parser.solve.configuration.empty() ? parser.chosen() : configured_solve(parser, argc, argv);
}

}  // namespace patchlight
