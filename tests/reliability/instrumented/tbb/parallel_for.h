#pragma once

#include "tbb/global_control.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

/// TBB as far as we use it, in threads that the thread sanitizer can see through: it knows nothing of what orders the
/// tasks of Debian's TBB, which is not instrumented, and would take each loop for a race. Nothing here orders the parts
/// of a loop among each other: what they share without a lock is reported.
namespace tbb {

namespace detail {

/// body(first, last) of parts of [0, count), on threads of their own.
template <class Body>
void in_parts(std::size_t count, std::size_t grain, const Body& body)
{
    const std::size_t parts = (count + grain - 1) / grain;
    std::atomic<std::size_t> next{0};
    std::mutex failing;
    std::exception_ptr failure;
    const auto work = [&] {
        for (std::size_t k = 0; (k = next.fetch_add(1, std::memory_order_relaxed)) < parts;) try {
                body(k * grain, std::min(count, (k + 1) * grain));
            } catch (...) {
                const std::lock_guard lock(failing);
                if (!failure) failure = std::current_exception();
                next.store(parts, std::memory_order_relaxed);
            }
    };
    const std::size_t threads = std::min(parts, global_control::active_value(global_control::max_allowed_parallelism));
    {
        std::vector<std::jthread> others;
        for (std::size_t t = 1; t < threads; ++t) others.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace detail

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body)
{
    if (!(first < last)) return;
    const auto count = static_cast<std::size_t>(last - first);
    detail::in_parts(count, std::max<std::size_t>(1, count / 64), [&](std::size_t a, std::size_t b) {
        for (std::size_t k = a; k < b; ++k) body(static_cast<Index>(first + static_cast<Index>(k)));
    });
}

template <class Range, class Body>
void parallel_for(const Range& range, const Body& body)
{
    using Index = typename Range::const_iterator;
    detail::in_parts(static_cast<std::size_t>(range.end() - range.begin()), range.grainsize(),
                     [&](std::size_t a, std::size_t b) {
                         body(Range(range.begin() + static_cast<Index>(a), range.begin() + static_cast<Index>(b)));
                     });
}

}  // namespace tbb
