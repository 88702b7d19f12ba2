#include "apps/report/page_markup.h"

#include "apps/report/page_files.h"
#include "apps/report/report_payload.h"
#include "apps/run/markup_text.h"
#include "apps/run/run_record.h"
#include "apps/run/sha256.h"

#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>

namespace patchlight {

namespace {

/// As a content security policy names a script or a style.
std::string policy_hash(std::string_view bytes)
{
    const std::string hex = sha256_hex(bytes);
    std::string digest;
    for (std::size_t i = 0; i < hex.size(); i += 2)
        digest += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    return "'sha256-" + base64(digest) + "'";
}

/// The bytes as an element of the page.
std::string payload_element(std::string_view payload)
{
    if (payload.empty()) return "";
    return "<script type=\"application/octet-stream\" id=\"payload\">" + base64(payload) + "</script>\n";
}

}  // namespace

std::string_view page_file(std::string_view name)
{
    for (const auto& [file, bytes] : report_page_files())
        if (file == name) return bytes;
    throw std::logic_error("the program holds no " + std::string(name));
}

std::string html_page(const PageParts& parts)
{
    const std::string policy =
        fmt::format("default-src 'none'; script-src {}; style-src {}; img-src data: blob:; base-uri 'none'; "
                    "form-action 'none'",
                    policy_hash(parts.script), policy_hash(parts.style));
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
{}<script>{}</script>
</body>
</html>
)",
                       policy, markup_text(tool_version()), markup_text(parts.title), parts.style, parts.body,
                       script_json(parts.description), payload_element(parts.payload), parts.script);
}

bool leaves_out_seconds()
{
    return std::getenv("SOURCE_DATE_EPOCH") != nullptr;
}

}  // namespace patchlight
