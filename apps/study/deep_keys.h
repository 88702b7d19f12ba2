#pragma once

#include "apps/study/study.h"

#include <string_view>

namespace patchlight {

/// Where a TOML text has a key of more than 16 parts, as a.b.c has three: the parser makes a table of each, one in the
/// other, and a hundred thousand of them are more than a stack can take down again. Nowhere: line 0.
TextPlace place_of_deep_key(std::string_view toml);

}  // namespace patchlight
