#pragma once

#include <cstdint>

namespace patchlight {

/// Counter-based random numbers: the same key gives the same numbers on any thread, in any order.
/// A 64-bit mix of key and counter (SplitMix64's finalizer [SteeleLeaFlood14]); good enough for jitter and rotation.
class RandomNumbers {
public:
    RandomNumbers(std::uint64_t seed, std::uint64_t key) : state_(mix(seed ^ mix(key + 0x9e3779b97f4a7c15ULL))) {}

    std::uint64_t bits() { return mix(state_ += 0x9e3779b97f4a7c15ULL); }
    /// In [0, 1).
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
    /// In [0, n).
    std::uint32_t below(std::uint32_t n)
    {
        return static_cast<std::uint32_t>(((bits() >> 32) * static_cast<std::uint64_t>(n)) >> 32);
    }

private:
    static constexpr std::uint64_t mix(std::uint64_t x)
    {
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
        return x ^ (x >> 31);
    }
    std::uint64_t state_;
};

}  // namespace patchlight
