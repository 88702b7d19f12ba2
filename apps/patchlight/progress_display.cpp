#include "apps/patchlight/progress_display.h"

namespace patchlight {

namespace {

constexpr std::chrono::milliseconds between_drawings{100};

}  // namespace

ProgressDisplay::ProgressDisplay(const Messages& messages) : messages_(messages)
{
    if (messages.shows_status()) {
        drawer_ = std::jthread([this](const std::stop_token& stop) { draw_until(stop); });
    }
}

ProgressDisplay::~ProgressDisplay()
{
    if (drawer_.joinable()) {
        drawer_.request_stop();
        drawer_.join();
        messages_.status("");
    }
}

void ProgressDisplay::show(const Progress& progress)
{
    if (!drawer_.joinable()) {
        return;
    }
    const std::lock_guard lock(mutex_);
    if (!shown_ || shown_->stage != progress.stage || shown_->cycle != progress.cycle) {
        stage_start_ = Clock::now();
        left_ = {};
    }
    rays_ = progress.rays;
    shown_ = ProgressText{.fraction = progress.fraction,
                          .cycle = progress.cycle,
                          .stage = std::string(progress.stage),
                          .elements = progress.elements,
                          .unshot = progress.unshot,
                          .residual = progress.residual};
}

void ProgressDisplay::clear()
{
    const std::lock_guard lock(mutex_);
    shown_.reset();
    messages_.status("");
}

void ProgressDisplay::draw_until(const std::stop_token& stop)
{
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, stop, between_drawings, [&] { return stop.stop_requested(); })) {
        if (shown_) {
            messages_.status(progress_line(text_now(), terminal_columns() - 1));
        }
    }
}

ProgressText ProgressDisplay::text_now()
{
    ProgressText text = *shown_;
    const double seconds = std::chrono::duration<double>(Clock::now() - stage_start_).count();
    if (seconds > 0.3) {
        text.rays_per_second = static_cast<double>(rays_) / seconds;
    }
    text.seconds_left = left_.after(seconds, text.fraction);
    return text;
}

}  // namespace patchlight
