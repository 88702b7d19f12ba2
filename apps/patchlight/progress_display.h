#pragma once

#include "apps/patchlight/terminal.h"
#include "solver/progress.h"

#include <chrono>
#include <map>
#include <string>

namespace patchlight {

/// Shows where a solve stands: a bar that is redrawn on a terminal, nothing between the cycles' lines elsewhere.
class ProgressDisplay {
public:
    explicit ProgressDisplay(const Messages& messages);
    ~ProgressDisplay();

    void show(const Progress& progress);
    /// A line that stays, above the bar.
    void line(const std::string& text);
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    const Messages& messages_;
    bool drawn_ = false;
    std::string stage_;
    int cycle_ = -2;
    Clock::time_point stage_start_{};
    Clock::time_point drawn_at_{};
};

}  // namespace patchlight
