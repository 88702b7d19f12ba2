#include "apps/patchlight/commands.h"
#include "apps/patchlight/usage_error.h"
#include "apps/run/probing.h"
#include "apps/study/study.h"
#include "meshing/scene_error.h"
#include "solver/progress.h"

#include <csignal>
#include <exception>
#include <new>

namespace patchlight {

namespace {

int run(int argc, const char* const* argv, Session& session)
{
    const Command command = parse_arguments(argc, argv);
    return std::visit([&](const auto& chosen) { return run_command(chosen, session); }, command);
}

constexpr const char* interrupted = "interrupted; the same command goes on from the last finished cycle";

/// What went wrong as a message and an exit code.
int run_and_report(int argc, const char* const* argv, Session& session)
{
    const Messages& say = session.messages;
    try {
        return run(argc, argv, session);
    } catch (const UsageError& error) {
        say.error(error.code(), error.what());
        return 2;
    } catch (const FolderRefused& error) {
        say.error("folder", error.what());
        return 2;
    } catch (const PointsError& error) {
        say.error("points", error.what());
        return 2;
    } catch (const StudyError& error) {
        say.error("study", error.what());
        return 2;
    } catch (const StudyLimitError& error) {
        say.error("study", error.what());
        return 5;
    } catch (const SceneError& error) {
        say.error(error.code(), error.what());
        return 3;
    } catch (const LimitError& error) {
        say.error("memory", error.what());
        return 5;
    } catch (const std::bad_alloc&) {
        say.error("memory", "not enough memory; ask for fewer elements or rays");
        return 5;
    } catch (const OutputError& error) {
        say.error("output", error.what());
        return 6;
    } catch (const Interrupted&) {
        say.note(interrupted);
        return session.interruption.exit_code();
    } catch (const PipeClosed&) {
        return 128 + SIGPIPE;
    } catch (const std::exception& error) {
        say.error("internal", error.what());
        return 1;
    }
}

}  // namespace

}  // namespace patchlight

int main(int argc, char** argv)
{
    patchlight::keep_standard_descriptors();
    patchlight::Messages messages;
    patchlight::Interruption interruption([&] { messages.close(patchlight::interrupted); });
    patchlight::FileWriter writer;
    patchlight::Session session{messages, interruption, writer};
    return patchlight::run_and_report(argc, argv, session);
}
