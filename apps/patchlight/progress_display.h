#pragma once

#include "apps/patchlight/progress_text.h"
#include "apps/patchlight/terminal.h"
#include "solver/progress.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

namespace patchlight {

/// Shows where a long work stands: a bar below the messages on a terminal, ten times a second at most; nothing
/// elsewhere. The bar goes when the display does.
class ProgressDisplay {
public:
    explicit ProgressDisplay(const Messages& messages);
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    void show(const Progress& progress);
    /// No bar until something is shown again.
    void clear();

private:
    using Clock = std::chrono::steady_clock;

    void draw_until(const std::stop_token& stop);
    ProgressText text_now();

    const Messages& messages_;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::optional<ProgressText> shown_;
    TimeLeft left_;
    Clock::time_point stage_start_{};
    std::size_t rays_ = 0;
    std::jthread drawer_;  ///< last: it uses all of the above
};

}  // namespace patchlight
