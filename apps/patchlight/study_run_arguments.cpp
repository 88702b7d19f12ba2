#include "apps/patchlight/study_run_arguments.h"

#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/scene_arguments.h"

namespace patchlight {

namespace {

void add_study(CLI::App& app, std::string& study, std::string& folder)
{
    app.add_option("study", study, "study file")->required()->type_name("STUDY");
    app.add_option("-o", folder, "the study's folder [the study file's name with -study behind it]")->type_name("DIR");
}

}  // namespace

void add_study_run(CLI::App& app, StudyRunCommand& c)
{
    add_study(app, c.study, c.folder);
    app.add_option("--jobs", c.jobs, "cells at once, which share the threads")
        ->check(whole_between(1, 1024))
        ->type_name("N")
        ->capture_default_str();
    add_machine(app, c.threads, c.quiet, c.json, "print study.json instead of a summary");
    app.footer("Each cell is a process of its own (study cell). Finished cells are kept, an\n"
               "interrupted one goes on from its last cycle. Cells that fail, run over the\n"
               "study's limits or miss their target, and gates that don't hold, are named; the\n"
               "others go on, and the exit code is 4.");
}

void add_study_cell(CLI::App& app, StudyCellCommand& c)
{
    add_study(app, c.study, c.folder);
    CLI::Option* const index = app.add_option("--index", c.index, "cell to solve, as study check numbers them [none]")
                                   ->check(whole_between(0, 1'000'000'000))
                                   ->type_name("I");
    app.add_flag("--reference", c.reference, "the study's reference instead of a cell [off]")->excludes(index);
    add_machine(app, c.threads, c.quiet, c.json, "print the cell's run.json instead of a summary");
    app.footer("Cells depend on nothing but the study's file and its scenes: they may be run in\n"
               "any order, at the same time, on several machines that share DIR.");
}

}  // namespace patchlight
