#include "apps/patchlight/study_outputs.h"

#include "apps/patchlight/study_pictures.h"
#include "apps/study/gates.h"
#include "apps/study/tables.h"

#include <fmt/format.h>

namespace patchlight {

void write_study_outputs(const StudyPictures& pictures, const StudyResult& study, const StudyFolder& folder,
                         Session& session)
{
    session.writer.write(folder.root / "table.md", table_text(study));
    session.writer.write(folder.root / "table.csv", table_text(study, {TableFormat::csv}));
    write_pictures(study_pictures(pictures, study, folder, session), study, folder, session.writer);
}

std::size_t name_failed_gates(const StudyResult& study, const Session& session)
{
    std::size_t failed = 0;
    for (const GateResult& gate : check_gates(study)) {
        if (gate.passed) continue;
        ++failed;
        const std::string value = gate.value ? fmt::format("{:.4g}", *gate.value) : "couldn't be checked";
        session.messages.error("gate", fmt::format("{} of {}: {}, the bound is {:.4g}{}", gate.gate, gate.of, value,
                                                   gate.bound, gate.message.empty() ? "" : "; " + gate.message));
    }
    return failed;
}

}  // namespace patchlight
