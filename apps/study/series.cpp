#include "apps/study/series.h"

#include <algorithm>
#include <filesystem>

namespace patchlight {

namespace {

/// The cell's values without that of `along`, as "axis=value axis=value".
std::string name_without(const StudyResult& study, const CellResult& cell)
{
    std::string name;
    for (std::size_t a = 0; a < study.axes.size(); ++a) {
        if (study.axes[a].name == study.along || a >= cell.cell.values.size()) continue;
        name += (name.empty() ? "" : " ") + study.axes[a].name + "=" + cell.cell.values[a];
    }
    return name.empty() ? study.name : name;
}

}  // namespace

std::vector<StudySeries> series_of(const StudyResult& study)
{
    std::vector<StudySeries> all;
    for (std::size_t c = 0; c < study.cells.size(); ++c) {
        const CellResult& cell = study.cells[c];
        const std::string name = name_without(study, cell), scene = scene_name(study, cell);
        auto series =
            std::ranges::find_if(all, [&](const StudySeries& s) { return s.name == name && s.scene == scene; });
        if (series == all.end()) series = all.insert(all.end(), {name, scene, {}});
        series->cells.push_back(c);
    }
    return all;
}

std::string scene_name(const StudyResult& study, const CellResult& cell)
{
    for (std::size_t a = 0; a < study.axes.size() && a < cell.cell.values.size(); ++a)
        if (study.axes[a].name == "scene") return cell.cell.values[a];
    return std::filesystem::path(cell.cell.scene).filename().string();
}

bool ran_to_its_end(const CellResult& cell)
{
    return (cell.status == CellStatus::done || cell.status == CellStatus::not_converged) && !cell.cycles.empty();
}

bool is_measured(const StudyResult& study)
{
    return study.reference.kind != ReferenceKind::none;
}

std::optional<double> error_of(const StudyResult& study, const CycleResult& cycle)
{
    return is_measured(study) ? cycle.error : cycle.estimated_error;
}

}  // namespace patchlight
