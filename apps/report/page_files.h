#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace patchlight {

/// What the build made of page/: page.html (the body's markup), page.css and page.js, by name.
std::vector<std::pair<std::string_view, std::string_view>> report_page_files();

}  // namespace patchlight
