#pragma once

#include "formfactor/pair_factor.h"

#include <cstddef>
#include <span>

namespace patchlight {

/// What one of several independent estimates of a factor added up.
struct GroupSum {
    double sum = 0;
    std::size_t count = 0;    ///< of what was added up: sum / count estimates the factor
    std::size_t samples = 0;  ///< rays or pixels spent on it
};

/// Of `total` items the number that go to a group: they differ by one at most.
constexpr std::size_t share_of_group(std::size_t total, std::size_t groups, std::size_t group)
{
    return total / groups + (group < total % groups ? 1 : 0);
}

/// The mean over the groups, and its standard error from how much they differ: unbiased when they are independent and
/// of one size, 0 for a single group.
PairFactor combine(std::span<const GroupSum> groups);

}  // namespace patchlight
