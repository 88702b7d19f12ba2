#pragma once

#include "formfactor/work_monitor.h"
#include "meshing/scene.h"
#include "meshing/surface_line.h"

#include <cstddef>
#include <span>
#include <vector>

namespace patchlight {

/// Which lines are looked for, besides the EV and VE ones.
struct ShadowLineOptions {
    /// Where the plane of a source, or of a surface seen edge on from one, crosses others, and where two edges of one
    /// plane are seen to pass each other in front of a source.
    bool planes = true;
    /// Where a blocker's corner passes another's edge in front of a source: kind VE.
    bool blockers = true;
    /// Where an edge of a source is seen against two skew edges of blockers: kind EEE, conics as straight pieces.
    bool eee = true;
    /// Pairs of blockers' edges tried for each edge of a source, those first whose middles are closest to each other.
    std::size_t most_eee_pairs = 100'000;
    /// How far the pieces may be off the conic, of the scene's diameter; below 1e-7 merging joins them again.
    double eee_tolerance = 1e-4;
};

/// How much there was to do.
struct ShadowLineCounts {
    std::size_t pencils = 0;    ///< corners with edges that were tried
    std::size_t receivers = 0;  ///< fronts on which light through a pencil ends, summed over pencils
};

/// The lines on surfaces that reflect across which the direct light of the sources breaks off in its first or second
/// derivative [Heckbert92, LischinskiTampieriGreenberg92]: EV (a source's corner seen past an edge), VE (a source's
/// edge seen past a corner), EEE and plane (see LineKind). Each only where light really arrives: what stands between is
/// sorted in the plane of corner and edge, on heights snapped at 1e-8 of the scene's diameter; what touches that plane
/// from one side hides that side only. Edges are those of the surfaces' loops; an edge or corner that isn't on the
/// outline of what it belongs to makes no line. EEE curves, of a source's edge and two skew
/// edges past which light of the source's corners goes, are looked for with rays at nine places of each and bisected
/// where what these meet changes: shorter visible parts may be missed. Not found: contacts; EEE beyond
/// most_eee_pairs, and past edges that only the middle of the source sees; edges where surfaces pierce each other; on a
/// surface whose plane cuts a source, the events of the points where it cuts the source's rim. Missing ones cost
/// convergence, nothing else. Where an edge and a segment of a source lie in one plane and blockers leave little of the
/// segment visible, a line may be cut short: its ends and three places between are tried. A few lines may be there
/// across which the light is smooth. Lines that coincide are one (see merged_lines). Runs in parallel; the result
/// depends on neither the threads nor the order of surfaces. Time grows with sources × (edges + corners) and what
/// stands in the way of each. Throws Interrupted.
std::vector<SurfaceLine> shadow_lines(const Scene& scene, std::span<const SurfaceId> sources,
                                      const ShadowLineOptions& options = {}, ShadowLineCounts* counts = nullptr,
                                      const WorkMonitor& monitor = {});

}  // namespace patchlight
