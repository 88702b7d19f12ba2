#include "apps/patchlight/stored_study.h"

#include "apps/patchlight/study_options.h"
#include "apps/patchlight/study_pictures.h"
#include "apps/run/stored_scene.h"
#include "apps/run/whole_number.h"
#include "meshing/scene_error.h"

namespace patchlight {

namespace {

constexpr std::size_t deepest = 16;

Json json_in(const std::filesystem::path& file)
{
    const std::string text = read_bytes(file);
    if (json_depth(text) > deepest) throw std::runtime_error("is nested too deeply");
    return Json::parse(text);
}

std::optional<double> number_in(const Json& json)
{
    return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

CycleResult cycle_in(const Json& json)
{
    CycleResult c;
    c.cycle = whole_number_in<int>(json.at("cycle"));
    c.elements = whole_number_in<std::size_t>(json.at("elements"));
    c.rays = whole_number_in<std::size_t>(json.at("rays"));
    c.estimated_error = number_in(json.at("estimated_error")).value_or(0);
    c.error = number_in(json.at("error"));
    const Json& range = json.at("error_ci");
    if (range.is_array()) c.error_ci = Interval{range.at(0).get<double>(), range.at(1).get<double>()};
    c.max_error = number_in(json.at("max_error"));
    c.energy_residual = number_in(json.at("energy_residual")).value_or(0);
    return c;
}

CellStatus status_in(const std::string& word)
{
    for (const CellStatus status : {CellStatus::waiting, CellStatus::unfinished, CellStatus::over_time,
                                    CellStatus::failed, CellStatus::not_converged, CellStatus::done})
        if (name_of(status) == word) return status;
    throw std::runtime_error("there is no status \"" + word + "\"");
}

/// The cells of study.toml with what study.json says of them.
std::vector<CellResult> cells_in(const Json& json, const Study& study)
{
    std::vector<CellResult> cells;
    const Json& stored = json.at("cells");
    for (const StudyCell& cell : expand(study)) {
        const Json& own = stored.at(cells.size());
        CellResult result;
        result.cell = cell;
        if (whole_number_in<std::size_t>(own.at("index")) != cell.index)
            throw std::runtime_error("is of another study.toml");
        // Only a name of a folder beside the others.
        result.id = std::filesystem::path(own.at("id").get<std::string>()).filename().string();
        result.status = status_in(own.at("status").get<std::string>());
        result.message = own.at("message").get<std::string>();
        for (const Json& cycle : own.at("cycles")) result.cycles.push_back(cycle_in(cycle));
        cells.push_back(std::move(result));
    }
    return cells;
}

void add_timing(std::vector<CellResult>& cells, const std::filesystem::path& file)
{
    try {
        const Json timing = json_in(file);
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const Json& of_cell = timing.at("cells").at(c);
            for (std::size_t i = 0; i < cells[c].cycles.size(); ++i)
                cells[c].cycles[i].seconds = of_cell.at("seconds").at(i).get<double>();
            cells[c].peak_memory = of_cell.value("peak_memory", 0.0);
        }
    } catch (const std::exception&) {
        // Only what the clock said is missing.
    }
}

std::vector<StudyPicture> pictures_in(const StudyFolder& folder, const Study& study, const StudyResult& result)
{
    std::vector<StudyPicture> pictures;
    for (const std::string& label : view_labels(study.pictures.views)) {
        for (std::size_t c = 0; c < result.cells.size(); ++c) {
            const auto file = picture_file(folder, result.cells[c].cell, label);
            std::error_code error;
            if (std::filesystem::is_regular_file(file, error)) pictures.push_back({c, label, read_bytes(file)});
        }
    }
    return pictures;
}

}  // namespace

bool is_stored_study(const StudyFolder& folder)
{
    std::error_code error;
    return std::filesystem::is_regular_file(folder.root / "study.json", error) &&
           std::filesystem::is_regular_file(folder.root / "study.toml", error);
}

ShownStudy stored_study(const StudyFolder& folder)
{
    const Study study = read_study_file((folder.root / "study.toml").string()).study;
    const std::filesystem::path file = folder.root / "study.json";
    ShownStudy shown{
        {study.name, study.axes, study.along, study.gates, study.comparisons, study.reference, {}}, {}, 1, {}};
    try {
        const Json json = json_in(file);
        shown.sha256 = json.at("study").at("sha256").get<std::string>();
        shown.seed = whole_number_in<std::uint64_t>(json.at("study").at("seed"));
        shown.result.name = json.at("study").at("name").get<std::string>();
        shown.result.cells = cells_in(json, study);
    } catch (const std::exception& problem) {
        throw SceneError("study", file.string() + ": " + problem.what());
    }
    add_timing(shown.result.cells, folder.root / "timing.json");
    shown.pictures = pictures_in(folder, study, shown.result);
    return shown;
}

}  // namespace patchlight
