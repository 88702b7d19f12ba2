#include "apps/patchlight/commands.h"
#include "apps/patchlight/usage_error.h"
#include "apps/run/probing.h"
#include "apps/study/study.h"
#include "meshing/scene_error.h"
#include "solver/invariants.h"
#include "solver/progress.h"

#include <csignal>
#include <exception>
#include <new>
#include <string_view>
#include <unistd.h>

namespace patchlight {

namespace {

int run(int argc, const char* const* argv, Session& session)
{
    const Command command = parse_arguments(argc, argv);
    return std::visit([&](const auto& chosen) { return run_command(chosen, session); }, command);
}

/// Set once in main, for last_words() alone: a terminate handler is given nothing.
FileWriter* unfinished_files = nullptr;

/// Where nothing can be thrown any more: no memory even for that, or on a thread that nobody waits for. Allocates
/// nothing; whole files stay, temporaries go.
[[noreturn]] void last_words()
{
    static constexpr std::string_view memory = "error[memory]: not enough memory; ask for fewer elements or rays\n";
    static constexpr std::string_view other = "error[internal]: ended by an error that nothing could take\n";
    int code = 1;
    std::string_view text = other;
    try {
        if (std::current_exception()) std::rethrow_exception(std::current_exception());
    } catch (const std::bad_alloc&) {
        code = 5;
        text = memory;
    } catch (...) {}
    if (unfinished_files != nullptr) unfinished_files->abandon();
    (void)!::write(STDERR_FILENO, text.data(), text.size());
    ::_exit(code);
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
    } catch (const InvariantError& error) {
        say.error("invariant", error.what());
        return 4;
    } catch (const std::bad_alloc&) {
        say.error("memory", "not enough memory; ask for fewer elements or rays");
        return 5;
    } catch (const OutputError& error) {
        say.error("output", error.what());
        return 6;
    } catch (const Interrupted&) {
        if (session.interruption.expired())
            say.error("time", "--time is over; the same command goes on from the last finished cycle, with a longer "
                              "--time or without one");
        else
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
    patchlight::unfinished_files = &writer;
    std::set_terminate(patchlight::last_words);
    patchlight::Session session{messages, interruption, writer};
    return patchlight::run_and_report(argc, argv, session);
}
