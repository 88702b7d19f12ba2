#include "apps/patchlight/commands.h"
#include "apps/report/report_page.h"

#include <fmt/format.h>

#include <cerrno>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

extern char** environ;

namespace patchlight {

namespace {

/// Whether xdg-open took the file. It hands it to another program and ends; what it says is of no use to anybody.
bool opened(const std::filesystem::path& file)
{
    const std::string path = std::filesystem::absolute(file).string();
    std::string program = "xdg-open", argument = path;
    char* const words[] = {program.data(), argument.data(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int descriptor : {0, 1, 2})
        posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_RDWR, 0);
    pid_t process = 0;
    const int failed = posix_spawnp(&process, program.c_str(), &actions, nullptr, words, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) return false;
    int status = 0;
    while (waitpid(process, &status, 0) < 0)
        if (errno != EINTR) return false;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

int run_command(const ReportCommand& command, Session& session)
{
    const OpenedRun run = open_run(command.run);
    const ReportPage page = report_page(run);
    session.interruption.check();
    const std::filesystem::path file = command.page;
    FileWriter::make_folder_of(file);
    session.writer.write(file, page.html);
    const std::size_t all = run.record.cycles.size();
    if (page.cycles.size() < all) {
        session.messages.note(
            fmt::format("{} of {} cycles are in it; all would be more than 3 MB", page.cycles.size(), all));
    }
    const Json told = {{"file", command.page}, {"bytes", page.html.size()}, {"cycles", page.cycles}};
    write_result(command.json ? told.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"
                              : fmt::format("wrote   {}\n", command.page));
    if (command.open && !opened(file)) {
        session.messages.warning(fmt::format("xdg-open can't show {}; open it in a browser", command.page));
    }
    return 0;
}

}  // namespace patchlight
