#include "apps/patchlight/progress_display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace patchlight {

namespace {

constexpr std::chrono::milliseconds between_drawings{100};

std::string bar(double fraction)
{
    constexpr int width = 20;
    const int full = static_cast<int>(std::lround(std::clamp(fraction, 0.0, 1.0) * width));
    return fmt::format("[{}{}]", std::string(static_cast<std::size_t>(full), '#'),
                       std::string(static_cast<std::size_t>(width - full), '.'));
}

}  // namespace

ProgressDisplay::ProgressDisplay(const Messages& messages) : messages_(messages) {}

ProgressDisplay::~ProgressDisplay()
{
    clear();
}

void ProgressDisplay::show(const Progress& progress)
{
    if (messages_.quiet() || !messages_.terminal()) {
        return;
    }
    const Clock::time_point now = Clock::now();
    if (stage_ != progress.stage || cycle_ != progress.cycle) {
        stage_ = progress.stage;
        cycle_ = progress.cycle;
        stage_start_ = now;
    } else if (now - drawn_at_ < between_drawings) {
        return;
    }
    drawn_at_ = now;
    const double seconds = std::chrono::duration<double>(now - stage_start_).count();
    std::string text = fmt::format("\r\x1b[2K{} ", bar(progress.fraction));
    if (progress.cycle >= 0) {
        text += fmt::format("cycle {} ", progress.cycle);
    }
    text += fmt::format("{:<9} {} elements", progress.stage, progress.elements);
    if (progress.rays > 0 && seconds > 0.05) {
        text += fmt::format("  {:.2f} M rays/s", static_cast<double>(progress.rays) / seconds * 1e-6);
    }
    if (progress.unshot >= 0) {
        text += fmt::format("  unshot {:.2f} %", 100 * progress.unshot);
    }
    if (progress.fraction > 0.02 && seconds > 0.3) {
        text += fmt::format("  {:.0f} s left in this stage",
                            std::ceil(seconds * (1 - progress.fraction) / progress.fraction));
    }
    messages_.raw(text);
    drawn_ = true;
}

void ProgressDisplay::line(const std::string& text)
{
    clear();
    messages_.note(text);
}

void ProgressDisplay::clear()
{
    if (drawn_) {
        messages_.raw("\r\x1b[2K");
        drawn_ = false;
    }
}

}  // namespace patchlight
