#pragma once

#include "apps/imaging/flip.h"
#include "apps/patchlight/arguments.h"
#include "apps/run/run_record.h"

#include <optional>
#include <string>
#include <vector>

namespace patchlight {

/// One of two compared solutions.
struct ComparedSide {
    std::string name;
    CycleRecord cycle;
    std::optional<double> seconds;
};

/// What a comparison found.
struct CompareReport {
    ComparedSide a, b;
    View view;  ///< in the scene's recentred metres
    int width = 0, height = 0;
    double exposure = 0;  ///< stops
    double rmse = 0;      ///< of radiance, W/(m²·sr)
    FlipSummary flip{};
    std::optional<double> l2{};  ///< √(Σ|A − B|² / Σ|B − E|²), three bands together; 0/0 = 0
    std::size_t points = 0;
    std::uint64_t seed = 1;
    std::vector<std::string> files{};

    double value(Metric metric) const;
};

/// compare.json: without seconds, which depend on the machine that solved.
Json json_of(const CompareReport& report, bool with_seconds);
/// A table for people.
std::string table_of(const CompareReport& report);
/// A line for each limit that isn't kept. What isn't a number is over every limit.
std::vector<std::string> broken_limits(const CompareReport& report, const std::vector<CompareLimit>& limits);

}  // namespace patchlight
