#pragma once

#include "apps/run/check_files.h"
#include "apps/study/check_study.h"
#include "apps/verification/verify.h"

#include <string>
#include <vector>

namespace patchlight {

/// A cycle's stored solution beside the light that was found.
struct VerifiedCycle {
    CycleRecord record;
    MeasuredError error;
    EstimateCheck check;
    PointShares within_own;   ///< where twice the patch's estimate is the limit
    PointShares within_mean;  ///< where twice the whole estimate is
};

VerifiedCycle verified_cycle(const CycleRecord& record, const VerifiedSolution& solution);

/// What is printed.
struct VerifyReport {
    std::uint64_t seed = 1;
    std::vector<VerifiedCycle> cycles{};   ///< in order; the last is the one that was asked for
    std::vector<SurfaceError> surfaces{};  ///< of that one
    std::size_t points = 0, rays = 0;
    std::uint32_t paths = 0;
    double seconds = 0, cpu_seconds = 0;  ///< of path tracing
};

/// Infinite numbers become null.
std::string json_text(const VerifyReport& report, const Scene& scene);
/// Of --files-only.
std::string json_text(const OpenedRun& run, const std::vector<FileProblem>& problems);
/// The same of a study's folder.
std::string json_text(const StudyCheck& check);
std::string summary_text(const VerifyReport& report, const Scene& scene);

}  // namespace patchlight
