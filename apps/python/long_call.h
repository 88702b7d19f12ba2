#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <type_traits>

namespace patchlight {

/// Work that takes long, called from Python: it runs on a thread of its own without the interpreter's lock, while the
/// calling thread waits, looks for signals some times a second, and does what the work hands back to it. So other
/// Python threads go on, Ctrl-C stops the work, and observers are called on the thread that asked for it.
class LongCall {
public:
    /// Whether the work is to stop. Work that doesn't look at it runs to its end before the signal is answered.
    std::stop_token stop() const { return stop_.get_token(); }

    /// From the work: `task` is done by the calling thread, under the interpreter's lock. Throws Interrupted when the
    /// task throws, which run() then throws again, or when a signal came.
    void in_caller(const std::function<void()>& task);

    /// Throws what the work throws; error_already_set (KeyboardInterrupt) when a signal's handler raised something.
    void run(const std::function<void(LongCall&)>& work);

private:
    void wait_for_end();
    void do_task_and_signals(const std::function<void()>* task);

    std::mutex mutex_;
    std::condition_variable changed_;
    const std::function<void()>* task_ = nullptr;  ///< what the calling thread is to do
    bool done_ = false;
    std::stop_source stop_;
    std::exception_ptr of_caller_;  ///< from signals and tasks; made and dropped under the interpreter's lock
};

/// What work(call) returns, as LongCall says.
template <class Work>
auto long_call(const Work& work)
{
    std::optional<std::invoke_result_t<Work, LongCall&>> result;
    LongCall().run([&](LongCall& call) { result.emplace(work(call)); });
    return std::move(*result);
}

}  // namespace patchlight
