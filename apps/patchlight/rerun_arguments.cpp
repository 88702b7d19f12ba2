#include "apps/patchlight/rerun_arguments.h"

#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/scene_arguments.h"

namespace patchlight {

void add_rerun(CLI::App& app, RerunCommand& c, std::string& memory)
{
    app.add_option("run", c.run, "folder of a finished run")->required()->type_name("RUN");
    app.add_option("-o", c.output, "new folder, or one to resume")->required()->type_name("NEW");
    app.add_option("--memory", memory, memory_help)->type_name("SIZE");
    add_machine(app, c.threads, c.quiet, c.json, "print JSON instead of a summary");
    app.footer("Solves the scene that the run holds with the run's options; the scene's own file\n"
               "isn't needed. Exit code 0: every file came out the same to the byte; 7: some\n"
               "didn't, and these are named. timing.json isn't compared.");
}

void finish_rerun(RerunCommand& c, const std::string& memory)
{
    if (!memory.empty()) c.memory = bytes_in("--memory", memory);
}

}  // namespace patchlight
