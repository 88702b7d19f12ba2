#include "apps/patchlight/report_arguments.h"

#include "apps/patchlight/usage_error.h"

namespace patchlight {

void add_report(CLI::App& app, ReportCommand& c)
{
    app.add_option("run", c.run, "folder of a run, or of a study that was run")->required()->type_name("RUN|DIR");
    app.add_option("-o", c.page, "HTML file to write")->required()->type_name("FILE");
    app.add_flag("--open", c.open, "show it with xdg-open [off]");
    app.add_flag("--json", c.json, "print JSON instead of the file's name [off]");
    app.footer("One file that opens from disk and needs no network: before and after in 3-D,\n"
               "every patch's numbers, plots, energy, options. Cycles that would make it larger\n"
               "than 3 MB are left out; it says which.");
}

void finish_report(const ReportCommand& c)
{
    if (!c.page.ends_with(".html")) throw UsageError("usage", "-o: \"" + c.page + "\" doesn't end in .html");
}

}  // namespace patchlight
