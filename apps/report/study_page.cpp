#include "apps/report/study_page.h"

#include "apps/report/page_markup.h"
#include "apps/report/report_payload.h"
#include "apps/run/run_folder.h"
#include "apps/run/stored_scene.h"
#include "apps/study/tables.h"

namespace patchlight {

namespace {

/// What a cell's run says of its origin; null where there is none to read.
Json origin_of(const CellResult& cell, const StudyFolder& folder)
{
    if (cell.cycles.empty()) return nullptr;
    try {
        const RunRecord record = open_run(folder.run(cell.id)).record;
        return {{"scene", as_utf8(record.identity.scene_file)},
                {"scene_sha256", record.identity.scene_sha256},
                {"content_sha256", record.identity.content_sha256},
                {"seed", record.identity.seed},
                {"solution_sha256", record.cycles.empty() ? "" : record.cycles.back().solution_sha256}};
    } catch (const std::exception&) {
        return nullptr;  // Its results were read; the page says that the rest is missing.
    }
}

Json reference_json(const StudyReference& reference)
{
    Json out = {{"kind", name_of(reference.kind)}};
    if (reference.kind == ReferenceKind::none) return out;
    if (reference.kind != ReferenceKind::points) out["points"] = reference.points;
    if (reference.kind == ReferenceKind::path_traced) out["paths"] = reference.paths;
    return out;
}

}  // namespace

std::string study_page(const ShownStudy& study, const StudyFolder& folder)
{
    TableOptions all;
    all.seconds = !leaves_out_seconds();
    all.cycles = true;
    Json table = table_json(study.result, all);
    for (std::size_t c = 0; c < study.result.cells.size(); ++c)
        table["cells"][c]["origin"] = origin_of(study.result.cells[c], folder);
    Json pictures = Json::array();
    for (const StudyPicture& picture : study.pictures)
        pictures.push_back({{"cell", picture.cell}, {"view", picture.view}, {"png", base64(picture.png)}});
    const Json description = {
        {"schema", "patchlight-study-report/1"},
        {"tool", {{"version", tool_version()}, {"commit", tool_commit()}, {"numeric", numeric_version()}}},
        {"study_sha256", study.sha256},
        {"seed", study.seed},
        {"reference", reference_json(study.result.reference)},
        {"table", table},
        {"pictures", pictures}};
    return html_page({as_utf8(study.result.name),
                      page_file("study.html"),
                      page_file("study.css"),
                      page_file("study.js"),
                      description,
                      {}});
}

}  // namespace patchlight
