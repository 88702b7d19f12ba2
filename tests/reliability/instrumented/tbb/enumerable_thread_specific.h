#pragma once

#include <atomic>
#include <cstdint>
#include <list>
#include <map>
#include <mutex>

namespace tbb {

/// A thread asks for the lock at its first call only: else it would order what the threads do between their calls.
template <class T>
class enumerable_thread_specific {
public:
    enumerable_thread_specific() = default;
    enumerable_thread_specific(const enumerable_thread_specific&) = delete;
    enumerable_thread_specific& operator=(const enumerable_thread_specific&) = delete;

    T& local()
    {
        static thread_local std::map<std::uint64_t, T*> own;
        T*& mine = own[number_];
        if (mine == nullptr) {
            const std::lock_guard lock(mutex_);
            mine = &all_.emplace_back();
        }
        return *mine;
    }
    auto begin() { return all_.begin(); }
    auto end() { return all_.end(); }

private:
    static std::uint64_t next_number()
    {
        static std::atomic<std::uint64_t> next = 0;
        return next.fetch_add(1, std::memory_order_relaxed);
    }
    const std::uint64_t number_ = next_number();
    std::mutex mutex_;
    std::list<T> all_;
};

}  // namespace tbb
