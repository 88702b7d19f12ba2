#pragma once

#include <string>
#include <string_view>

namespace patchlight {

/// Text as it may stand in HTML and XML, between tags or in quotes.
std::string markup_text(std::string_view text);

}  // namespace patchlight
