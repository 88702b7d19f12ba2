#pragma once

#include "apps/patchlight/commands.h"

#include <string>

namespace patchlight {

/// Writes the page, tells of it on standard output ({file, bytes} and `more`, in JSON), and shows it with xdg-open when
/// asked; where that can't be done, it warns. Throws OutputError.
void write_page(const PageOutput& output, const std::string& html, const Json& more, Session& session);

}  // namespace patchlight
