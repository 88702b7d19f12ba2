#pragma once

#include "meshing/scene.h"
#include "meshing/surface_line.h"

#include <cstddef>
#include <span>
#include <vector>

namespace patchlight {

/// Which lines are looked for, besides the EV and VE ones.
struct ShadowLineOptions {
    bool planes = true;  ///< where the plane of a source, or of a surface seen edge on from a source, crosses others
    bool blockers = true;  ///< where a blocker's corner passes another's edge in front of a source
};

/// How much there was to do.
struct ShadowLineCounts {
    std::size_t pencils = 0;    ///< (apex, base) in front of a source, both in view of it or not
    std::size_t receivers = 0;  ///< (pencil, facet) where light through a pencil ends on a facet's front
};

/// The lines on surfaces that reflect across which the direct light of the sources breaks off in its first or second
/// derivative [Heckbert92, LischinskiTampieriGreenberg92]: EV (a source's corner seen past an edge), VE (a source's
/// edge seen past a corner) and plane (see LineKind; contacts are not among them, nor EEE: the curves where a source's
/// edge is seen past two skew edges). Each line only where light from the source's corner or edge really arrives: what
/// stands in between is sorted in the plane of corner and edge, exactly, on heights snapped at 1e-8 of the scene's
/// diameter, so that what touches the plane from one side hides that side only. Corners and edges are those of the
/// surfaces' loops; edges between coplanar surfaces and those not on an outline count as hidden by what they belong to.
/// Lines that coincide are one (see merged_lines). A few lines may be there across which the light is smooth: where
/// something else hides just the side that would have changed.
/// Runs in parallel; the result depends on neither threads nor the order of surfaces.
std::vector<SurfaceLine> shadow_lines(const Scene& scene, std::span<const SurfaceId> sources,
                                      const ShadowLineOptions& options = {}, ShadowLineCounts* counts = nullptr);

}  // namespace patchlight
