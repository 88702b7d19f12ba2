#pragma once

#include <atomic>
#include <csignal>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace patchlight {

/// Turns SIGINT, SIGTERM and SIGHUP into a request to stop, and makes sure that the program ends within a second
/// of it, whatever a library is busy with. To be made first in main, before any other thread: it blocks the
/// signals for all that follow.
class Interruption {
public:
    /// `farewell` is called last when the program doesn't end by itself in time, from another thread.
    explicit Interruption(std::function<void()> farewell);
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;
    ~Interruption();

    std::stop_token token() const { return stop_.get_token(); }
    /// Throws Interrupted when a signal has come.
    void check() const;
    /// 128 + the signal; 5 when only the time was over.
    int exit_code() const { return signal_ == 0 && expired_ ? 5 : 128 + signal_; }

    /// Asks to stop after so many seconds, too, > 0 and at most 1e9. What is asked last holds; never ends the program
    /// by force.
    void stop_after(double seconds);
    bool expired() const { return expired_ && signal_ == 0; }

    /// What is still to be done when the program doesn't end by itself in time; called from another thread.
    void on_deadline(std::function<void()> last_words);

private:
    void watch();
    [[noreturn]] void leave();

    std::stop_source stop_;
    std::mutex mutex_;
    std::function<void()> last_words_, farewell_;
    sigset_t signals_{};
    std::atomic<int> signal_ = 0;
    std::atomic<bool> done_ = false, expired_ = false;
    std::thread watcher_;
};

}  // namespace patchlight
