#pragma once

#include "formfactor/work_monitor.h"
#include "meshing/refinement.h"
#include "meshing/surface_line.h"
#include "solver/estimate.h"

#include <array>
#include <span>
#include <vector>

namespace patchlight {

class DirectLight;

/// A line on a surface and how the light breaks off there: the jumps, from one side to the other, of the direct part of
/// B, of its derivative across the line and of the second one; all bands together.
struct Discontinuity {
    SurfaceLine line;
    double value = 0;   ///< W/m²
    double slope = 0;   ///< W/m³
    double second = 0;  ///< W/m⁴
};

struct LineOptions {
    /// A line is inserted when, left out, it would cost more elements than this on its two sides.
    double least_saving = 4;
    /// Of the light reflected first: the brightest surfaces that hold this share cast shadows with lines, too. Such
    /// wide sources' lines rarely pay, and finding them among many blockers takes long: none unless asked for.
    double secondary_share = 0;
    std::size_t most_secondary = 4;  ///< of these surfaces
};

/// All lines on surfaces that reflect: the scene's contact lines, then those of the emitters' shadows and of secondary
/// sources' (see shadow_lines(), secondary_sources()), with their jumps in `direct`, which must be emitters_light() of
/// the scene. Contact lines are kept also where the direct light happens not to jump. Without `direct`: contact lines
/// alone, jumps unknown (0). Throws Interrupted.
std::vector<Discontinuity> discontinuities(const Scene& scene, const DirectLight* direct, const LineOptions& options,
                                           const WorkMonitor& monitor = {});

/// Measures the jumps in the exact direct light of `exitance` (W/m², one a source of `direct`): a parabola through
/// three points on either side of the line's middle and, where nothing but the second derivative jumps there, of its
/// quarters, the largest. Lines without any jump beyond rounding, and those on a surface's border, are left out.
std::vector<Discontinuity> measure_jumps(const Scene& scene, const DirectLight& direct, std::span<const Rgb> exitance,
                                         std::span<const SurfaceLine> lines, const WorkMonitor& monitor = {});

/// How many elements a line costs when it is left out and the mesh is refined along it until each element's squared
/// error is `element_error` (W²/m²): 2ℓ/h, where an element of size h across a jump J of the k-th derivative has the
/// squared error J² h^(2k+2) / (12, 48, 600), whichever derivative costs most.
double elements_saved(const Discontinuity& line, double element_error);

/// The lines that aren't in the mesh yet and pay, most first; contact lines before all others. What an element's error
/// will be at the end is told from the estimate now, as if the squared error fell like 1/N² up to `max_elements`, or
/// from `target_error` when that is met earlier.
std::vector<SurfaceLine> worthwhile_lines(const Scene& scene, const PatchMesh& mesh, const ErrorEstimate& error,
                                          std::span<const Discontinuity> lines, std::size_t max_elements,
                                          double target_error, const LineOptions& options = {});

/// How many lines of a kind were found, and how many of them the mesh holds.
struct LineCount {
    std::size_t found = 0, inserted = 0;
};

/// By kind.
std::array<LineCount, line_kinds.size()> count_lines(const Scene& scene, const PatchMesh& mesh,
                                                     std::span<const Discontinuity> lines);

}  // namespace patchlight
