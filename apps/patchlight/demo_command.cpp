#include "apps/patchlight/commands.h"
#include "apps/patchlight/demo_scene.h"
#include "apps/patchlight/usage_error.h"

#include <fmt/format.h>

#include <system_error>

namespace patchlight {

namespace {

constexpr std::size_t demo_elements = 8000;

/// Before anything is written: a folder with other things in it isn't ours.
void check_folder(const std::filesystem::path& folder)
{
    std::error_code error;
    if (!std::filesystem::exists(folder, error) || std::filesystem::exists(folder / "run.json", error)) {
        return;
    }
    if (!std::filesystem::is_directory(folder, error)) {
        throw FolderRefused(fmt::format("{} is a file; name a new folder with -o", folder.string()));
    }
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        if (entry->path().filename() != "scene") {
            throw FolderRefused(
                fmt::format("{} is not empty and holds no run; name a new folder with -o", folder.string()));
        }
    }
}

}  // namespace

int run_command(const DemoCommand& command, Session& session)
{
    const std::filesystem::path folder = command.folder;
    check_folder(folder);
    FileWriter::make_folder(folder / "scene");
    SolveCommand solve;
    for (const auto& [name, bytes] : demo_scene_files()) {
        session.writer.write(folder / "scene" / name, bytes);
        if (name.ends_with(".obj")) {
            solve.scene.file = (folder / "scene" / name).string();
        }
    }
    solve.scene.unit_name = "mm";
    solve.scene.options.unit = 0.001;
    solve.run = command.folder;
    solve.options.max_elements = demo_elements;
    solve.pictures.snapshots = {1, 2, 3, 16};  // for the report's slider
    solve.quiet = command.quiet;
    solve.json = command.json;
    solve.threads = command.threads;
    solve.demo = true;
    return run_command(solve, session);
}

}  // namespace patchlight
