#include "apps/patchlight/verify_arguments.h"

#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/scene_arguments.h"

namespace patchlight {

void add_verify(CLI::App& app, VerifyCommand& c, std::string& cycle)
{
    app.add_option("run", c.run, "folder of a run, or of a study")->required()->type_name("RUN|DIR");
    app.add_option("--points", c.points, "at random over all surface that reflects")
        ->check(whole_between(1, 1'000'000))
        ->each([&c](const std::string&) { c.traces_study = true; })
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--paths", c.most_paths, "from each point at most; fewer where the error is known well enough")
        ->check(whole_between(8, 100'000'000))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--cycle", cycle, "which cycle: a number, first, last, or all by the same paths")
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--seed", c.seed, "of all random numbers")
        ->check(whole_between(0, 9'000'000'000'000'000'000))
        ->type_name("N")
        ->capture_default_str();
    app.add_flag("--files-only", c.files_only, "trace nothing: are the run's files what it wrote? [off]");
    add_machine(app, c.threads, c.quiet, c.json, "print JSON instead of a summary");
    app.footer("First every file of the run is held against its SHA-256 in run.json: exit code 3\n"
               "where one was changed. Of a study that is done for all its runs, and paths are\n"
               "traced only with --points.\n"
               "Paths are traced against the scene's polygons alone, with nothing of the\n"
               "solver's. Intervals are of 95 %; the paths' own noise is not counted as error.\n"
               "L2 is relative to the reflected light of all surface; RMS to that of each point,\n"
               "where it is at least a thousandth of the mean.\n"
               "The estimate holds when it is between half the measured error and three times\n"
               "that.");
}

void finish_verify(VerifyCommand& c, const std::string& cycle)
{
    c.all_cycles = cycle == "all";
    if (!c.all_cycles) c.cycle = cycle_in("--cycle", cycle);
}

}  // namespace patchlight
