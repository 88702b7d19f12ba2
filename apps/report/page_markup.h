#pragma once

#include "apps/run/run_options.h"

#include <string>
#include <string_view>

namespace patchlight {

/// A file of page_files.h. Throws std::logic_error when the program doesn't hold it.
std::string_view page_file(std::string_view name);

/// What a page is made of. `body` and `style` are markup and style sheet as they are; nothing else becomes markup.
struct PageParts {
    std::string title;
    std::string_view body, style, script;
    Json description;          ///< what the script reads
    std::string_view payload;  ///< bytes behind it; empty: none
};

/// One HTML file that asks nothing of the network; its content security policy allows this script and style alone.
std::string html_page(const PageParts& parts);

/// Whether seconds are left out, so that the same results give the same page: SOURCE_DATE_EPOCH is set, as where a
/// build is to be reproducible (reproducible-builds.org).
bool leaves_out_seconds();

}  // namespace patchlight
