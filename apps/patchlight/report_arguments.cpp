#include "apps/patchlight/report_arguments.h"

#include "apps/patchlight/usage_error.h"

namespace patchlight {

void add_page(CLI::App& app, PageOutput& page)
{
    app.add_option("-o", page.file, "HTML file to write")->required()->type_name("FILE");
    app.add_flag("--open", page.open, "show it with xdg-open [off]");
    app.add_flag("--json", page.json, "print JSON instead of the file's name [off]");
}

void finish_page(const PageOutput& page)
{
    if (!page.file.ends_with(".html")) throw UsageError("usage", "-o: \"" + page.file + "\" doesn't end in .html");
}

void add_report(CLI::App& app, ReportCommand& c)
{
    app.add_option("run", c.run, "folder of a run, or of a study that was run")->required()->type_name("RUN|DIR");
    add_page(app, c.page);
    app.footer("One file that opens from disk and needs no network: before and after in 3-D,\n"
               "every patch's numbers, plots, energy, options. Cycles that would make it larger\n"
               "than 3 MB are left out; it says which.");
}

}  // namespace patchlight
