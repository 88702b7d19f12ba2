#include "apps/patchlight/commands.h"
#include "apps/patchlight/usage_error.h"
#include "apps/run/probing.h"
#include "apps/study/study.h"
#include "meshing/scene_error.h"
#include "solver/invariants.h"
#include "solver/progress.h"

#include <atomic>
#include <csignal>
#include <exception>
#include <new>
#include <string_view>
#include <system_error>
#include <unistd.h>

namespace patchlight {

namespace {

int run(int argc, const char* const* argv, Session& session)
{
    const Command command = parse_arguments(argc, argv);
    return std::visit([&](const auto& chosen) { return run_command(chosen, session); }, command);
}

/// Set once in main, for what is given nothing.
FileWriter* unfinished_files = nullptr;

/// Allocates nothing; whole files stay, temporaries go.
[[noreturn]] void leave_at_once(int code, std::string_view text)
{
    if (unfinished_files != nullptr) unfinished_files->abandon();
    (void)!::write(STDERR_FILENO, text.data(), text.size());
    ::_exit(code);
}

constexpr std::string_view no_memory = "error[memory]: not enough memory; ask for fewer elements or rays\n";

/// Where memory has run out there is no safe way back: libraries jump, assert and end threads when it is thrown through
/// them. Files are whole or not there at any moment, so that nothing is lost by leaving from where we are.
void out_of_memory()
{
    static std::atomic_flag leaving;
    // Another thread is leaving, and may wait for what this one holds.
    if (leaving.test_and_set()) throw std::bad_alloc();
    leave_at_once(5, no_memory);
}

/// Where nothing can be thrown any more, or on a thread that nobody waits for.
[[noreturn]] void last_words()
{
    try {
        if (std::current_exception()) std::rethrow_exception(std::current_exception());
    } catch (const std::bad_alloc&) {
        leave_at_once(5, no_memory);
    } catch (...) {}
    leave_at_once(1, "error[internal]: ended by an error that nothing could take\n");
}

/// Before main: the objects that stand outside functions need memory too.
[[gnu::constructor(101)]] void expect_the_worst()
{
    std::set_new_handler(out_of_memory);
    std::set_terminate(last_words);
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
    } catch (const std::system_error& error) {
        // A thread's stack did not fit, or there are as many threads as may be.
        const bool no_thread = error.code() == std::errc::resource_unavailable_try_again;
        say.error(no_thread ? "memory" : "internal", no_thread ? "not enough memory for another thread" : error.what());
        return no_thread ? 5 : 1;
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
    patchlight::Session session{messages, interruption, writer};
    return patchlight::run_and_report(argc, argv, session);
}
