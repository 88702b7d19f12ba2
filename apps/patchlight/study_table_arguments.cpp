#include "apps/patchlight/study_table_arguments.h"

#include "apps/patchlight/report_arguments.h"

namespace patchlight {

void add_study_table(CLI::App& app, StudyTableCommand& c)
{
    app.add_option("study", c.study, "study file")->required()->type_name("STUDY");
    app.add_option("-o", c.folder, "the study's folder [the study file's name with -study behind it]")
        ->type_name("DIR");
    app.add_option("--format", c.format, "notation of the table")
        ->check(CLI::IsMember({"md", "csv", "json", "tex"}))
        ->capture_default_str();
    app.add_flag("--seconds", c.seconds, "also what the clock said: other numbers on each machine [off]");
    app.add_flag("--cycles", c.cycles, "a row each cycle of a cell, not its last alone [off]");
    app.footer("On standard output, also of a study that isn't finished. md and tex hold a few\n"
               "digits and errors in per cent, csv and json all digits and fractions. Below the\n"
               "cells md has the rates at which errors fall along the study's axis, comparisons\n"
               "and gates; json has them, too.");
}

void add_study_report(CLI::App& app, StudyReportCommand& c)
{
    app.add_option("study", c.study, "study file")->required()->type_name("STUDY");
    app.add_option("--dir", c.folder, "the study's folder [the study file's name with -study behind it]")
        ->type_name("DIR");
    add_page(app, c.page);
    app.footer("One file that opens from disk and needs no network: error against elements and\n"
               "seconds, all cells and their pictures at one exposure, comparisons, gates. The\n"
               "pictures are also left in DIR/pictures.");
}

}  // namespace patchlight
