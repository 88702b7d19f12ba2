#pragma once

#include "apps/study/reference.h"

#include <filesystem>
#include <vector>

namespace patchlight {

/// Points of a reference in a file of their own. Throws OutputError.
void write_block(const std::filesystem::path& file, const std::vector<ReferencePoint>& points, FileWriter& writer);

/// Those of a file; none when it isn't there or broken.
std::vector<ReferencePoint> read_block(const std::filesystem::path& file);

}  // namespace patchlight
