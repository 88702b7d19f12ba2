#include "apps/imaging/animation.h"
#include "apps/imaging/camera_path.h"
#include "apps/imaging/comparison.h"
#include "apps/patchlight/commands.h"
#include "apps/patchlight/result_folder.h"
#include "apps/patchlight/run_choice.h"
#include "apps/patchlight/run_pictures.h"
#include "apps/patchlight/usage_error.h"
#include "apps/patchlight/view_choice.h"
#include "apps/run/whole_number.h"

#include <fmt/format.h>

namespace patchlight {

namespace {

using Frames = std::vector<std::vector<unsigned char>>;

ShownSolution shown(const StoredSolution& stored, const PatchLocator& locator)
{
    return {stored.scene, stored.mesh, locator, stored.B, stored.vertex_B, &stored.middle_B};
}

/// A cycle after the other up to `last`, seen as `last` is.
Frames frames_of_cycles(const AnimateCommand& command, const ChosenRun& chosen, Session& session)
{
    const CycleRecord& end = record_of(chosen.run, chosen.cycle);
    const StoredSolution last = solution_of(chosen.run, chosen.cycle);
    const PatchLocator last_locator(last.mesh);
    const RayCaster caster(last.scene);
    const View view = command.view.empty() ? chosen_view("", last.scene, caster) : view_named(command.view, last.scene);
    const auto [width, height] = picture_size(command.size, view);
    const RunPictures pictures(last.scene, caster, view, width, height);
    const double exposure = command.exposure ? *command.exposure : pictures.exposure_for(shown(last, last_locator));
    Frames frames;
    for (const CycleRecord& record : chosen.run.record.cycles) {
        if (record.cycle > end.cycle) break;
        session.interruption.check();
        const StoredSolution stored = solution_of(chosen.run, {WhichCycle::Kind::number, record.cycle});
        const PatchLocator locator(stored.mesh);
        const Image picture = pictures.srgb(shown(stored, locator), exposure, command.wireframe);
        const std::string title = caption_title(fmt::format("cycle {}", record.cycle), record);
        frames.push_back(encode_png(in_a_row({{picture, title, caption_detail(record)}})));
    }
    return frames;
}

/// The pictures that --snapshots left in the run's folder.
Frames frames_of_shots(const ChosenRun& chosen, Session& session)
{
    const Json& options = chosen.run.record.identity.options;
    std::vector<int> shots;
    try {
        shots = whole_numbers_in<int>(options.at("pictures").at("snapshots"));
    } catch (const std::exception&) {
        // Told below.
    }
    if (shots.empty()) {
        throw UsageError("animate", chosen.name + " has no pictures of shots; solve with --snapshots 1,2,3,16");
    }
    Frames frames;
    for (const int count : shots) {
        session.interruption.check();
        const std::filesystem::path file = chosen.run.folder / fmt::format("shots-{:02}.png", count);
        try {
            const Image picture = read_image(file).image;
            frames.push_back(
                encode_png(in_a_row({{picture, fmt::format("{} shot{}", count, count == 1 ? "" : "s"), ""}})));
        } catch (const std::runtime_error& problem) {
            throw UsageError("animate", problem.what());
        }
    }
    return frames;
}

Frames frames_of_path(const AnimateCommand& command, const ChosenRun& chosen, Session& session)
{
    const StoredSolution stored = solution_of(chosen.run, chosen.cycle);
    const std::vector<View> keys = read_views(command.path, stored.scene);
    if (keys.size() < 2) throw UsageError("view", command.path + ": a path needs two cameras or more");
    const PatchLocator locator(stored.mesh);
    const RayCaster caster(stored.scene);
    const auto [width, height] = picture_size(command.size, keys.front());
    const double exposure =
        command.exposure
            ? *command.exposure
            : RunPictures(stored.scene, caster, keys.front(), width, height).exposure_for(shown(stored, locator));
    Frames frames;
    for (int i = 0; i < command.frames; ++i) {
        session.interruption.check();
        const double t = static_cast<double>(i) / (command.frames - 1) * static_cast<double>(keys.size() - 1);
        const RunPictures pictures(stored.scene, caster, view_on_path(keys, t), width, height);
        frames.push_back(pictures.png(shown(stored, locator), exposure, command.wireframe));
    }
    return frames;
}

Frames frames_of(const AnimateCommand& command, const ChosenRun& chosen, Session& session)
{
    switch (command.what) {
    case Animated::cycles:
        return frames_of_cycles(command, chosen, session);
    case Animated::shots:
        return frames_of_shots(chosen, session);
    case Animated::path:
        return frames_of_path(command, chosen, session);
    }
    return {};
}

std::string frame_name(int number)
{
    return fmt::format("frame-{:04}.png", number);
}

void write_frames(const std::filesystem::path& path, const Frames& frames, Session& session)
{
    std::vector<std::string> names;
    for (int i = 1; i <= most_frames; ++i) names.push_back(frame_name(i));
    ResultFolder folder(path, names.front(), names, session.writer);
    for (std::size_t i = 0; i < frames.size(); ++i) folder.write(frame_name(static_cast<int>(i) + 1), frames[i]);
}

}  // namespace

int run_command(const AnimateCommand& command, Session& session)
{
    const ChosenRun chosen = chosen_run(command.run);
    const Frames frames = frames_of(command, chosen, session);
    const std::filesystem::path output = command.output;
    if (output.extension() != ".png") {
        write_frames(output, frames, session);
        return 0;
    }
    FileWriter::make_folder_of(output);
    session.writer.write(output, encode_animation(frames, command.delay));
    return 0;
}

}  // namespace patchlight
