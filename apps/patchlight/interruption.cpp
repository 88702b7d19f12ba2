#include "apps/patchlight/interruption.h"

#include "solver/progress.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>
#include <pthread.h>
#include <sys/time.h>
#include <unistd.h>
#include <utility>

namespace patchlight {

namespace {

// A run has to be gone within a second of the signal.
constexpr timespec patience{0, 700'000'000};

bool ignored(int signal)
{
    struct sigaction action {};
    return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

Interruption::Interruption(std::function<void()> farewell) : farewell_(std::move(farewell))
{
    // A closed pipe and a file that grows too long are errors of the write, and reported there.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    sigaddset(&signals_, SIGALRM);
    if (!ignored(SIGHUP)) {
        sigaddset(&signals_, SIGHUP);
    }
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    watcher_ = std::thread([this] { watch(); });
}

Interruption::~Interruption()
{
    done_ = true;
    pthread_kill(watcher_.native_handle(), SIGTERM);
    watcher_.join();
}

void Interruption::stop_after(double seconds)
{
    // A timer of no time would never go off.
    const double whole = std::floor(seconds), part = std::max(1.0, 1e6 * (seconds - whole));
    const itimerval timer{{0, 0}, {static_cast<time_t>(whole), std::min<suseconds_t>(999'999, std::lround(part))}};
    setitimer(ITIMER_REAL, &timer, nullptr);
}

void Interruption::check() const
{
    if (stop_.stop_requested()) {
        throw Interrupted();
    }
}

void Interruption::on_deadline(std::function<void()> last_words)
{
    const std::lock_guard lock(mutex_);
    last_words_ = std::move(last_words);
}

void Interruption::watch()
{
    int signal = SIGALRM;
    while (signal == SIGALRM) {
        if (sigwait(&signals_, &signal) != 0 || done_) {
            return;
        }
        if (signal == SIGALRM) {
            expired_ = true;
            stop_.request_stop();
        }
    }
    signal_ = signal;
    stop_.request_stop();
    // A second signal ends the wait; so does the destructor.
    sigtimedwait(&signals_, nullptr, &patience);
    if (!done_) {
        leave();
    }
}

void Interruption::leave()
{
    const std::lock_guard lock(mutex_);
    if (last_words_) {
        last_words_();
    }
    farewell_();
    _exit(exit_code());
}

}  // namespace patchlight
