#pragma once

#include "solver/progress.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <stop_token>
#include <string_view>
#include <utility>

namespace patchlight {

/// Wall seconds of one cycle, for timing.json only.
struct StageSeconds {
    double mesh = 0, assemble = 0, solve = 0, gather = 0, estimate = 0;
};

/// Runs the stages of a computation: tells who watches, adds up the seconds. Used from one thread.
class Stages {
public:
    explicit Stages(ProgressObserver on_progress = {}, std::stop_token stop = {})
        : on_progress_(std::move(on_progress)), stop_(std::move(stop))
    {}
    Stages(const Stages&) = delete;
    Stages& operator=(const Stages&) = delete;

    /// What work(monitor) returns; its seconds are added to `spent`. Throws Interrupted when asked to stop before.
    template <class Work>
    auto run(std::string_view name, double StageSeconds::*spent, std::size_t elements, const Work& work)
    {
        if (stop_.stop_requested()) throw Interrupted();
        WorkMonitor monitor{stop_, {}};
        progress_ = {name, cycle, 0, elements};
        rays_of_loop_ = 0;
        if (on_progress_) monitor.tell = [this](const WorkState& state) { tell(state); };
        if (monitor.tell) monitor.tell({});
        const auto begin = std::chrono::steady_clock::now();
        auto result = work(monitor);
        seconds.*spent += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        return result;
    }

    int cycle = 0;  ///< that is told
    StageSeconds seconds;

private:
    /// A stage may be several loops, each of which counts its own rays.
    void tell(const WorkState& state)
    {
        progress_.fraction = std::max(progress_.fraction, state.fraction);
        progress_.rays += state.rays < rays_of_loop_ ? state.rays : state.rays - rays_of_loop_;
        rays_of_loop_ = state.rays;
        progress_.unshot = state.unshot;
        progress_.residual = state.residual;
        on_progress_(progress_);
    }

    ProgressObserver on_progress_;
    std::stop_token stop_;
    Progress progress_;
    std::size_t rays_of_loop_ = 0;
};

}  // namespace patchlight
