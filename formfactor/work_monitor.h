#pragma once

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <stop_token>

namespace patchlight {

/// Thrown when the caller's stop token asks to stop: nothing of the running step is kept.
class Interrupted : public std::runtime_error {
public:
    Interrupted() : std::runtime_error("interrupted") {}
};

/// Where a long loop stands.
struct WorkState {
    double fraction = 0;   ///< done, 0 … 1
    std::size_t rays = 0;  ///< traced so far
    double unshot = -1;    ///< share of the emitted power not yet shot; -1 = does not apply
    double residual = -1;  ///< of the linear system, as the solver measures it; -1 = does not apply
};

/// Who watches a long loop, and who may stop it.
struct WorkMonitor {
    std::stop_token stop;
    /// Called from one thread at a time.
    std::function<void(const WorkState&)> tell;
};

/// The watcher of one part of a longer work: what the part tells as 0 … 1 is told as begin … end.
inline WorkMonitor part_of(const WorkMonitor& whole, double begin, double end)
{
    if (!whole.tell) return whole;
    return {whole.stop, [tell = whole.tell, begin, end](WorkState state) {
                state.fraction = begin + (end - begin) * state.fraction;
                tell(state);
            }};
}

/// Calls work(i, scratch) for every i in [0, n) on all threads, with one Scratch a thread, in blocks.
/// Whatever work(i) writes must depend on i alone: then the result doesn't depend on the number of threads.
/// Returns the scratches' sum of `traced`. Throws Interrupted within a block's time of a stop request.
template <class Scratch, class Work>
std::size_t for_each_row(std::size_t n, const WorkMonitor& monitor, const Work& work, std::size_t block = 32)
{
    const std::size_t blocks = (n + block - 1) / block;
    tbb::enumerable_thread_specific<Scratch> scratches;
    std::atomic<std::size_t> done{0}, rays{0};
    std::mutex telling;
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
        if (monitor.stop.stop_requested()) return;
        Scratch& scratch = scratches.local();
        const std::size_t before = scratch.traced;
        for (std::size_t i = b * block; i < std::min(n, (b + 1) * block); ++i) work(i, scratch);
        rays += scratch.traced - before;
        ++done;
        if (!monitor.tell) return;
        // Read under the lock: what is told never falls.
        if (const std::unique_lock lock(telling, std::try_to_lock); lock.owns_lock())
            monitor.tell({.fraction = static_cast<double>(done) / static_cast<double>(blocks), .rays = rays});
    });
    if (monitor.stop.stop_requested()) throw Interrupted();
    return rays;
}

}  // namespace patchlight
