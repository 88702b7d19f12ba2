#pragma once

#include "meshing/ids.h"
#include "meshing/vectors.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace patchlight {

/// What a solution shows at a point of its surfaces, and what an unbiased estimate found there: B − E, W/m².
struct MeasuredPoint {
    SurfaceId surface;
    Rgb shown{0.0};
    double estimated = 0;  ///< the solution's own estimate of its error at this point, W/m², three bands together
    Rgb found{0.0};
    Rgb variance{0.0};  ///< an unbiased estimate of that of `found`, (W/m²)²
};

struct Interval {
    double low = 0, high = 0;
};

/// A solution's error over the surfaces, from area-uniform points. The estimate's own variance is subtracted wherever
/// a difference or a value is squared, so that its noise doesn't count as error.
struct MeasuredError {
    double l2 = 0;       ///< √(Σ|shown − B|² / Σ|B|²), three bands together; 0/0 = 0; infinite over 0
    Interval l2_ci;      ///< of 95 %
    double relrms = 0;   ///< √mean((shown/B − 1)²) over the points' bands that count
    Interval relrms_ci;  ///< of 95 %
    std::size_t relrms_values = 0;  ///< bands that count: B at least a thousandth of its mean over points and bands
    double l2_noise = 0;            ///< standard error of the values found, in the measure of l2
    double relrms_noise = 0;        ///< and of relrms
    double from_paths = 0;          ///< the share of l2²'s variance that comes from `variance`: the rest only more
                                    ///< points can lower
};

/// Intervals are percentiles of 1000 bootstrap samples of the points [Efron79]; the same seed gives the same. What they
/// can't know: that rare places of great error lie between the points. relrms divides by the values found: where these
/// are noisy (relrms_noise above some .05) it is biased upwards by about 6 relrms_noise⁴ of its square.
MeasuredError measured_error(std::span<const MeasuredPoint> points, std::uint64_t seed);

/// A surface's own part.
struct SurfaceError {
    SurfaceId surface;
    std::size_t points = 0;
    double l2 = 0;     ///< relative to this surface's own light
    double share = 0;  ///< of the whole squared error; negative where noise alone is left
};

/// In the order of the surfaces; those without a point are left out.
std::vector<SurfaceError> errors_by_surface(std::span<const MeasuredPoint> points);

/// Shares of the points, which sum to 1. A point is decided where it is three standard errors from the limit: of points
/// far within it, whose noise is larger than the limit, one or two in a hundred are still called beyond.
struct PointShares {
    double within = 0, beyond = 0, undecided = 0;
};

/// Where |shown − B| stands to a limit (W/m²) of each point.
PointShares shares_within(std::span<const MeasuredPoint> points,
                          const std::function<double(const MeasuredPoint&)>& limit);

enum class Verdict {
    holds,      ///< surely between half the measured error and three times it
    too_small,  ///< surely below half of it
    too_large,  ///< surely above three times
    undecided   ///< the measured error isn't known well enough
};

struct EstimateCheck {
    double effectivity = 0;  ///< estimated over measured; 0/0 = 1
    Interval range;          ///< of 95 %; infinite where no error was measured
    Verdict verdict = Verdict::undecided;
};

/// Holds an estimated relative error to a measured one. "Surely" is the 95 % of the measured error's interval.
EstimateCheck check_estimate(double estimated, const MeasuredError& measured);

}  // namespace patchlight
