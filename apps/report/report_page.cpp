#include "apps/report/report_page.h"

#include "apps/report/page_markup.h"
#include "apps/report/report_data.h"
#include "apps/run/stored_scene.h"

#include <algorithm>

namespace patchlight {

namespace {

std::string html_of(const OpenedRun& run, const ReportData& data)
{
    return html_page({as_utf8(run.record.identity.scene_file), page_file("page.html"), page_file("page.css"),
                      page_file("page.js"), data.description, data.payload.bytes()});
}

}  // namespace

ReportPage report_page(const OpenedRun& run, const ReportOptions& options)
{
    record_of(run, {});  // Throws without a finished cycle.
    // Three bytes become four characters; the script is most of the rest.
    const std::size_t fixed = page_file("page.js").size();
    std::size_t room = (options.most_bytes - std::min(options.most_bytes, fixed)) / 4 * 3;
    for (;;) {
        const ReportData data = report_data(run, room);
        ReportPage page{html_of(run, data), data.cycles};
        if (page.html.size() <= options.most_bytes || page.cycles.size() <= 2) return page;
        room -= std::min(room, page.html.size() - options.most_bytes);
    }
}

}  // namespace patchlight
