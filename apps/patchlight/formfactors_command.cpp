#include "apps/patchlight/commands.h"
#include "apps/patchlight/factor_between.h"
#include "apps/patchlight/factor_matrix.h"
#include "solver/progress.h"

#include <tbb/global_control.h>

#include <optional>

namespace patchlight {

int run_command(const FormFactorsCommand& command, Session& session)
{
    session.messages.set_quiet(command.quiet);
    std::optional<tbb::global_control> threads;
    if (command.threads > 0) {
        threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(command.threads));
    }
    session.interruption.on_deadline([&] { session.writer.abandon(); });
    struct Unhook {
        Interruption& interruption;
        ~Unhook() { interruption.on_deadline({}); }
    } const unhook{session.interruption};
    try {
        const SceneInput input = load_scene(command.scene);
        session.interruption.check();
        for (const std::string& warning : input.report.warnings) {
            session.messages.warning(warning);
        }
        return command.between ? report_between(command, input, session) : report_matrix(command, input, session);
    } catch (const Interrupted&) {
        session.messages.note("interrupted; nothing of it is kept");
        return session.interruption.exit_code();
    }
}

}  // namespace patchlight
