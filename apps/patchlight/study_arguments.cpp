#include "apps/patchlight/study_arguments.h"

#include "apps/patchlight/argument_values.h"

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
}

Command chosen_study(const CLI::App&, const StudyCommands& commands)
{
    return commands.check;
}

}  // namespace patchlight
