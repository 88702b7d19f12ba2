#include "apps/patchlight/commands.h"
#include "apps/patchlight/page_output.h"
#include "apps/patchlight/stored_study.h"
#include "apps/report/report_page.h"

#include <fmt/format.h>

namespace patchlight {

int run_command(const ReportCommand& command, Session& session)
{
    if (const StudyFolder folder{command.run}; is_stored_study(folder)) {
        const ShownStudy study = stored_study(folder);
        write_page(command.page, study_page(study, folder), {{"pictures", study.pictures.size()}}, session);
        return 0;
    }
    const OpenedRun run = open_run(command.run);
    const ReportPage page = report_page(run);
    session.interruption.check();
    const std::size_t all = run.record.cycles.size();
    if (page.cycles.size() < all) {
        session.messages.note(
            fmt::format("{} of {} cycles are in it; all would be more than 3 MB", page.cycles.size(), all));
    }
    write_page(command.page, page.html, {{"cycles", page.cycles}}, session);
    return 0;
}

}  // namespace patchlight
