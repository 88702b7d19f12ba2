#pragma once

#include "apps/run/run_record.h"
#include "tests/fuzz/target.h"

#include <string>
#include <vector>

namespace patchlight::testing {

/// A small run that is solved anew in each process: the numbers in its files are of this program.
struct MadeRun {
    Scene scene;
    AdaptiveOptions options;
    RunIdentity identity;
    std::vector<CycleRecord> records;
    std::vector<std::string> cycles;  ///< solution.glb of each
};

/// A lamp over a plate that stands on a floor. Made once.
const MadeRun& made_run();

/// `bytes` with what the choices change in them: spans overwritten by words of 1 to 8 bytes, some of them numbers that
/// like to hurt, cut out, or written twice; at most 16 changes.
std::string damaged(std::string bytes, Choices& choices);

}  // namespace patchlight::testing
