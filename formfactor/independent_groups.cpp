#include "formfactor/independent_groups.h"

#include <cmath>

namespace patchlight {

PairFactor combine(std::span<const GroupSum> groups)
{
    PairFactor result;
    std::size_t count = 0;
    for (const GroupSum& group : groups) {
        result.value += group.sum;
        count += group.count;
        result.samples += group.samples;
    }
    if (count == 0) return result;
    const double n = static_cast<double>(count), size = static_cast<double>(groups.size());
    result.value /= n;
    double squares = 0;
    for (const GroupSum& group : groups) {
        const double difference = (group.sum - static_cast<double>(group.count) * result.value) / n;
        squares += difference * difference;
    }
    if (groups.size() > 1) result.error = std::sqrt(squares * size / (size - 1));
    return result;
}

}  // namespace patchlight
