#include "apps/patchlight/study_pictures.h"

#include "apps/patchlight/run_pictures.h"
#include "apps/patchlight/usage_error.h"
#include "apps/patchlight/view_choice.h"
#include "apps/study/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

namespace patchlight {

namespace {

/// A scene from the study's views: primary rays are traced once for all cells that are of it.
struct SceneViews {
    SceneViews(Scene its_scene, const StudyPictures& wanted, Session& session)
        : scene(std::move(its_scene)), caster(scene)
    {
        for (const StudyView& view : wanted.views) {
            try {
                pictures.push_back(std::make_unique<RunPictures>(scene, caster, chosen_view(view.view, scene, caster),
                                                                 wanted.size.first, wanted.size.second));
            } catch (const UsageError& problem) {
                session.messages.warning(fmt::format("{}: {}", scene.name, problem.what()));
                pictures.push_back(nullptr);
            }
        }
    }

    Scene scene;
    RayCaster caster;
    std::vector<std::unique_ptr<RunPictures>> pictures;  ///< one a view; null where the scene has no such camera
};

class StudyPainter {
public:
    StudyPainter(const StudyPictures& wanted, Session& session)
        : wanted_(wanted), labels_(view_labels(wanted.views)), session_(session)
    {}

    /// A cell's pictures, one a view that its scene has.
    std::vector<StudyPicture> pictures_of(std::size_t place, const CellResult& cell, const StudyFolder& folder)
    {
        const OpenedRun run = open_run(folder.run(cell.id));
        const StoredSolution stored = solution_of(run, {});
        const SceneViews& views = views_of(run.record.identity.content_sha256, stored.scene);
        const PatchLocator locator(stored.mesh);
        const ShownSolution shown{stored.scene, stored.mesh, locator, stored.B, stored.vertex_B, &stored.middle_B};
        std::vector<StudyPicture> pictures;
        for (std::size_t v = 0; v < labels_.size(); ++v) {
            session_.interruption.check();
            if (!views.pictures[v]) continue;
            const auto png = views.pictures[v]->png(shown, exposure_of(cell, *views.pictures[v], shown));
            pictures.push_back({place, labels_[v], std::string(png.begin(), png.end())});
        }
        return pictures;
    }

private:
    const SceneViews& views_of(const std::string& digest, const Scene& scene)
    {
        std::unique_ptr<SceneViews>& views = scenes_[digest];
        if (!views) views = std::make_unique<SceneViews>(scene, wanted_, session_);
        return *views;
    }

    double exposure_of(const CellResult& cell, const RunPictures& pictures, const ShownSolution& shown)
    {
        if (wanted_.exposure) return *wanted_.exposure;
        const auto known = exposures_.find(cell.cell.scene);
        if (known != exposures_.end()) return known->second;
        return exposures_[cell.cell.scene] = pictures.exposure_for(shown);
    }

    const StudyPictures& wanted_;
    std::vector<std::string> labels_;
    Session& session_;
    std::map<std::string, std::unique_ptr<SceneViews>> scenes_;  ///< by what was read
    std::map<std::string, double> exposures_;                    ///< by scene
};

}  // namespace

std::vector<std::string> view_labels(const std::vector<StudyView>& views)
{
    std::vector<std::string> labels;
    for (const StudyView& view : views) {
        std::string label = view.view;
        if (label.ends_with(".json")) label = std::filesystem::path(label).stem().string();
        if (label.ends_with(".view")) label.resize(label.size() - 5);
        const auto is_plain = [](char c) {
            return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' || c == '_';
        };
        for (char& c : label)
            if (!is_plain(c)) c = '_';
        if (label.empty()) label = "view";
        std::string unique = label;
        for (int k = 2; std::ranges::find(labels, unique) != labels.end(); ++k) unique = fmt::format("{}-{}", label, k);
        labels.push_back(unique);
    }
    return labels;
}

std::filesystem::path picture_file(const StudyFolder& folder, const StudyCell& cell, const std::string& label)
{
    return folder.pictures() / fmt::format("{:03}-{}.png", cell.index, label);
}

std::vector<StudyPicture> study_pictures(const StudyPictures& wanted, const StudyResult& study,
                                         const StudyFolder& folder, Session& session)
{
    StudyPainter painter(wanted, session);
    std::vector<StudyPicture> all;
    for (std::size_t c = 0; c < study.cells.size(); ++c) {
        if (wanted.views.empty() || !ran_to_its_end(study.cells[c])) continue;
        for (StudyPicture& picture : painter.pictures_of(c, study.cells[c], folder)) all.push_back(std::move(picture));
    }
    const std::vector<std::string> labels = view_labels(wanted.views);
    std::ranges::stable_sort(
        all, {}, [&](const StudyPicture& picture) { return std::ranges::find(labels, picture.view) - labels.begin(); });
    return all;
}

void write_pictures(const std::vector<StudyPicture>& pictures, const StudyResult& study, const StudyFolder& folder,
                    FileWriter& writer)
{
    std::set<std::filesystem::path> written;
    if (!pictures.empty()) FileWriter::make_folder(folder.pictures());
    for (const StudyPicture& picture : pictures) {
        const auto file = picture_file(folder, study.cells[picture.cell].cell, picture.view);
        writer.write(file, picture.png);
        written.insert(file);
    }
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder.pictures(), error)) {
        const bool stale = entry.path().extension() == ".png" && !written.contains(entry.path());
        if (stale) std::filesystem::remove(entry.path(), error);
    }
}

}  // namespace patchlight
