#include "apps/patchlight/commands.h"
#include "apps/patchlight/page_output.h"
#include "apps/patchlight/study_pictures.h"
#include "apps/patchlight/study_plan.h"
#include "apps/study/tables.h"

#include <map>

namespace patchlight {

int run_command(const StudyTableCommand& command, Session& session)
{
    static const std::map<std::string, TableFormat> formats{{"md", TableFormat::markdown},
                                                            {"csv", TableFormat::csv},
                                                            {"json", TableFormat::json},
                                                            {"tex", TableFormat::latex}};
    const StudyFolder folder = study_folder(command.study, command.folder);
    const StudyPlan plan = StudyPlanner(command.study).plan();
    const StudyResult result = collect(plan, folder, nullptr, session.interruption.token());
    write_result(table_text(result, {formats.at(command.format), command.seconds, command.cycles}));
    return 0;
}

int run_command(const StudyReportCommand& command, Session& session)
{
    const StudyFolder folder = study_folder(command.study, command.folder);
    const StudyPlan plan = StudyPlanner(command.study).plan();
    ShownStudy study{collect(plan, folder, nullptr, session.interruption.token()), plan.sha256, plan.seed, {}};
    study.pictures = study_pictures(plan.study.pictures, study.result, folder, session);
    try {
        write_pictures(study.pictures, study.result, folder, session.writer);
    } catch (const OutputError& problem) {
        session.messages.warning(std::string(problem.what()) + "; the page holds the pictures");
    }
    write_page(command.page, study_page(study, folder),
               {{"cells", study.result.cells.size()}, {"pictures", study.pictures.size()}}, session);
    return 0;
}

}  // namespace patchlight
