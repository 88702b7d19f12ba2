#include "apps/python/long_call.h"

#include "formfactor/work_monitor.h"

#include <pybind11/pybind11.h>

#include <chrono>
#include <thread>
#include <utility>

namespace py = pybind11;

namespace patchlight {

namespace {

// Of looking for signals.
constexpr std::chrono::milliseconds interval{50};

}  // namespace

void LongCall::in_caller(const std::function<void()>& task)
{
    std::unique_lock lock(mutex_);
    if (stop_.stop_requested()) throw Interrupted();
    task_ = &task;
    changed_.notify_all();
    changed_.wait(lock, [&] { return task_ == nullptr; });
    if (stop_.stop_requested()) throw Interrupted();
}

void LongCall::do_task_and_signals(const std::function<void()>* task)
{
    const py::gil_scoped_acquire held;
    try {
        if (task != nullptr && !of_caller_) (*task)();
        if (!of_caller_ && PyErr_CheckSignals() != 0) throw py::error_already_set();
    } catch (...) {
        of_caller_ = std::current_exception();
        stop_.request_stop();
    }
}

void LongCall::wait_for_end()
{
    const py::gil_scoped_release released;
    std::unique_lock lock(mutex_);
    while (!done_) {
        changed_.wait_for(lock, interval, [&] { return done_ || task_ != nullptr; });
        if (done_) return;
        // One that comes meanwhile is for the next round.
        const auto* task = task_;
        lock.unlock();
        do_task_and_signals(task);
        lock.lock();
        if (task != nullptr) {
            task_ = nullptr;
            changed_.notify_all();
        }
    }
}

void LongCall::run(const std::function<void(LongCall&)>& work)
{
    std::exception_ptr of_work;
    {
        const std::jthread worker([&] {
            try {
                work(*this);
            } catch (...) {
                of_work = std::current_exception();
            }
            const std::lock_guard lock(mutex_);
            done_ = true;
            changed_.notify_all();
        });
        wait_for_end();
    }
    if (of_caller_) std::rethrow_exception(std::exchange(of_caller_, nullptr));
    if (of_work) std::rethrow_exception(of_work);
}

}  // namespace patchlight
