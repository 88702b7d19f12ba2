#pragma once

#include <atomic>
#include <cstddef>

namespace tbb {

class global_control {
public:
    enum parameter { max_allowed_parallelism };
    global_control(parameter, std::size_t value) : before_(allowed().exchange(value)) {}
    global_control(const global_control&) = delete;
    global_control& operator=(const global_control&) = delete;
    ~global_control() { allowed() = before_; }
    static std::size_t active_value(parameter) { return allowed(); }

private:
    // More than cores: threads that wait for each other meet at more moments.
    static std::atomic<std::size_t>& allowed()
    {
        static std::atomic<std::size_t> value = 4;
        return value;
    }
    std::size_t before_;
};

}  // namespace tbb
