#pragma once

namespace patchlight {

/// max(x, 0), for sums that rounding may leave below 0. What is not a number stays that: it must not pass for darkness.
inline double positive_part(double x)
{
    return x <= 0 ? 0 : x;
}

}  // namespace patchlight
