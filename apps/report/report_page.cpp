#include "apps/report/report_page.h"

#include "apps/report/page_files.h"
#include "apps/report/report_data.h"
#include "apps/run/markup_text.h"
#include "apps/run/sha256.h"
#include "apps/run/stored_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace patchlight {

namespace {

std::string_view page_file(std::string_view name)
{
    for (const auto& [file, bytes] : report_page_files())
        if (file == name) return bytes;
    throw std::logic_error("the program holds no " + std::string(name));
}

/// As a content security policy names a script or a style.
std::string policy_hash(std::string_view bytes)
{
    const std::string hex = sha256_hex(bytes);
    std::string digest;
    for (std::size_t i = 0; i < hex.size(); i += 2)
        digest += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    return "'sha256-" + base64(digest) + "'";
}

std::string html_of(const OpenedRun& run, const ReportData& data)
{
    const std::string_view script = page_file("page.js"), style = page_file("page.css"), body = page_file("page.html");
    const std::string policy =
        fmt::format("default-src 'none'; script-src {}; style-src {}; img-src data: blob:; base-uri 'none'; "
                    "form-action 'none'",
                    policy_hash(script), policy_hash(style));
    return fmt::format(R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta name="generator" content="patchlight {}">
<title>{} – Patchlight report</title>
<link rel="icon" href="data:,">
<style>{}</style>
</head>
<body>
{}
<script type="application/json" id="description">{}</script>
<script type="application/octet-stream" id="payload">{}</script>
<script>{}</script>
</body>
</html>
)",
                       policy, markup_text(tool_version()), markup_text(as_utf8(run.record.identity.scene_file)), style,
                       body, script_json(data.description), base64(data.payload.bytes()), script);
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
