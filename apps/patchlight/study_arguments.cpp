#include "apps/patchlight/study_arguments.h"

#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/report_arguments.h"
#include "apps/patchlight/study_run_arguments.h"
#include "apps/patchlight/study_table_arguments.h"

namespace patchlight {

namespace {

constexpr int most_jobs = 1024;

void add_study_file(CLI::App& app, std::string& study)
{
    app.add_option("study", study, "TOML file of a study")->required()->type_name("STUDY");
}

void add_check(CLI::App& app, StudyCheckCommand& c)
{
    add_study_file(app, c.study);
    app.add_option("--jobs", c.jobs, "cells at a time: what the totals are for")
        ->check(whole_between(1, most_jobs))
        ->type_name("N")
        ->capture_default_str();
    app.add_flag("--json", c.json, "print JSON [off]");
    app.footer("Elements, memory and processor time are orders of magnitude. Nothing is written.");
}

}  // namespace

void add_study(CLI::App& app, StudyCommands& commands)
{
    app.require_subcommand(1);
    add_check(*app.add_subcommand("check", "What a study would do, cell by cell, and what that needs"), commands.check);
    add_study_run(*app.add_subcommand("run", "All cells and the reference, measured; goes on where it was stopped"),
                  commands.run);
    add_study_table(*app.add_subcommand("table", "What a study came to so far, as a table"), commands.table);
    add_study_report(*app.add_subcommand("report", "What a study came to so far, as one HTML page"), commands.report);
    add_study_cell(*app.add_subcommand("cell", "One cell, or the reference, as a command of its own"), commands.cell);
}

Command chosen_study(const CLI::App& app, const StudyCommands& commands)
{
    if (app.got_subcommand("run")) return commands.run;
    if (app.got_subcommand("cell")) return commands.cell;
    if (app.got_subcommand("table")) return commands.table;
    if (app.got_subcommand("report")) {
        finish_page(commands.report.page);
        return commands.report;
    }
    return commands.check;
}

}  // namespace patchlight
