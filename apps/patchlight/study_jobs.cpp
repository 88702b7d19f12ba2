#include "apps/patchlight/study_jobs.h"

#include "solver/progress.h"

#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

namespace patchlight {

namespace {

constexpr std::chrono::milliseconds between_looks{20};
constexpr std::chrono::milliseconds to_stop{600};  // less than Interruption leaves us
constexpr double seconds_to_leave = 2;             // of one that is over its time: it needs less than one

struct Running {
    StudyJob job;
    std::unique_ptr<ChildProcess> child;
    bool over_time = false;
};

/// A child that is over its time is asked to stop, and made to when it doesn't.
void hold_to_time(Running& running)
{
    const double over = running.child->age().count() - running.job.seconds;
    if (running.job.seconds <= 0 || over < 0) return;
    if (!running.over_time) running.child->send(SIGTERM);
    if (over > seconds_to_leave) running.child->send(SIGKILL);
    running.over_time = true;
}

StudyJobEnd end_of(const Running& running, const ChildEnd& end)
{
    StudyJobEnd result{end.exit_code, running.over_time && end.exit_code != 0, error_in(running.child->said()),
                       running.child->age().count()};
    if (result.message.empty() && end.signal != 0) {
        result.message = fmt::format("ended by signal {} ({})", end.signal, ::strsignal(end.signal));
    } else if (result.message.empty() && end.exit_code > 128) {
        result.message = fmt::format("stopped by signal {} from outside", end.exit_code - 128);
    } else if (result.message.empty() && end.exit_code != 0) {
        result.message = fmt::format("ended with exit code {}", end.exit_code);
    }
    return result;
}

[[noreturn]] void leave(std::list<Running>& running)
{
    for (const Running& one : running) one.child->send(SIGTERM);
    const auto deadline = std::chrono::steady_clock::now() + to_stop;
    while (!running.empty() && std::chrono::steady_clock::now() < deadline) {
        std::erase_if(running, [](const Running& one) { return one.child->ended().has_value(); });
        std::this_thread::sleep_for(between_looks);
    }
    throw Interrupted();
}

}  // namespace

void work_through(std::list<StudyJob> jobs, std::size_t at_once, const std::stop_token& stop,
                  const std::function<void(const StudyJob&)>& on_begin,
                  const std::function<void(const StudyJob&, const StudyJobEnd&)>& on_end)
{
    std::list<Running> running;
    while (!jobs.empty() || !running.empty()) {
        if (stop.stop_requested()) leave(running);
        while (!jobs.empty() && running.size() < at_once) {
            on_begin(jobs.front());
            auto child = std::make_unique<ChildProcess>(jobs.front().arguments);
            running.push_back({std::move(jobs.front()), std::move(child)});
            jobs.pop_front();
        }
        for (auto one = running.begin(); one != running.end();) {
            hold_to_time(*one);
            const std::optional<ChildEnd> end = one->child->ended();
            if (end && !stop.stop_requested()) on_end(one->job, end_of(*one, *end));
            one = end ? running.erase(one) : std::next(one);
        }
        std::this_thread::sleep_for(between_looks);
    }
    if (stop.stop_requested()) throw Interrupted();
}

std::string error_in(const std::string& said)
{
    constexpr std::string_view mark = "error[";
    const std::size_t begin = said.rfind(mark);
    const std::size_t close = said.find("]: ", begin);
    if (begin == std::string::npos || close == std::string::npos) return {};
    const std::string kind = said.substr(begin + mark.size(), close - begin - mark.size());
    const std::size_t text = close + 1;  // from the colon on
    return kind + said.substr(text, said.find('\n', text) - text);
}

}  // namespace patchlight
