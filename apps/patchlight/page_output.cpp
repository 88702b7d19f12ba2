#include "apps/patchlight/page_output.h"

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

void write_page(const PageOutput& output, const std::string& html, const Json& more, Session& session)
{
    const std::filesystem::path file = output.file;
    FileWriter::make_folder_of(file);
    session.writer.write(file, html);
    Json told = {{"file", output.file}, {"bytes", html.size()}};
    told.update(more);
    write_result(output.json ? told.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"
                             : fmt::format("wrote   {}\n", output.file));
    if (output.open && !opened(file)) {
        session.messages.warning(fmt::format("xdg-open can't show {}; open it in a browser", output.file));
    }
}

}  // namespace patchlight
