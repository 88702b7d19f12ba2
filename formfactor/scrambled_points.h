#pragma once

#include "formfactor/random_numbers.h"

#include <array>
#include <cstdint>

namespace patchlight {

/// The first two dimensions of Sobol's sequence [Sobol67], scrambled at random [Owen95] by hashing [Burley20]: each
/// point is uniform in the unit square, any 2^k first ones have one in each of 2^k boxes of every shape that
/// halving makes. Different keys give independent sequences. Coordinates are at least 2⁻²¹ from 0 and 1.
class ScrambledPoints {
public:
    ScrambledPoints(std::uint64_t seed, std::uint64_t key)
    {
        RandomNumbers random(seed, key);
        first_ = static_cast<std::uint32_t>(random.bits());
        second_ = static_cast<std::uint32_t>(random.bits());
    }

    std::array<double, 2> operator()(std::uint32_t index) const
    {
        std::uint32_t v = 0x80000000U, sobol = 0;
        for (std::uint32_t i = index; i != 0; i >>= 1, v ^= v >> 1)
            if ((i & 1U) != 0) sobol ^= v;
        return {unit(scrambled(index, first_)), unit(scrambled(reversed(sobol), second_))};
    }

private:
    static constexpr std::uint32_t reversed(std::uint32_t x)
    {
        x = (x << 16) | (x >> 16);
        x = ((x & 0x00ff00ffU) << 8) | ((x & 0xff00ff00U) >> 8);
        x = ((x & 0x0f0f0f0fU) << 4) | ((x & 0xf0f0f0f0U) >> 4);
        x = ((x & 0x33333333U) << 2) | ((x & 0xccccccccU) >> 2);
        return ((x & 0x55555555U) << 1) | ((x & 0xaaaaaaaaU) >> 1);
    }
    /// Each bit is flipped by a hash of the lower ones; so of the higher ones after reversal [LaineKarras11].
    static constexpr std::uint32_t scrambled(std::uint32_t reversed_bits, std::uint32_t seed)
    {
        std::uint32_t x = reversed_bits;
        x ^= x * 0x3d20adeaU;
        x += seed;
        x *= (seed >> 16) | 1U;
        x ^= x * 0x05526c56U;
        x ^= x * 0x53a22864U;
        return reversed(x);
    }
    static constexpr double unit(std::uint32_t bits) { return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-20; }

    std::uint32_t first_, second_;
};

}  // namespace patchlight
