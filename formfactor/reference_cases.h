#pragma once

#include "meshing/vectors.h"

#include <functional>
#include <string>
#include <vector>

namespace patchlight {

/// A planar polygon, counter-clockwise seen from its front.
using ReferencePolygon = std::vector<Vec3>;

/// How two polygons lie to each other: what can be expected of sampling methods depends on it.
enum class ReferenceKind {
    facing,    ///< no further apart than twice their size
    distant,   ///< further
    touching,  ///< sharing an edge
    occluded,  ///< partly hidden from each other
    sliver     ///< hidden but for a slit: above 0, and no more than the slit's area over the first polygon's
};

/// Two polygon objects, what stands between them, and the form factor from the first to the second.
struct ReferencePair {
    std::string name;
    ReferenceKind kind = ReferenceKind::facing;
    double factor = 0;  ///< sliver: what it can't exceed
    std::vector<ReferencePolygon> from, to;
    std::vector<ReferencePolygon> blockers;  ///< block from both sides
};

/// A configuration without polygons, or one that elementary functions give: only a formula of ours is held to it.
struct ReferenceFormula {
    std::string name;
    double factor = 0;
    std::string by;  ///< what computes it
    std::function<double()> value;
};

/// Known form factors, computed with 25–40 digits from Howell's catalogue (C-11, C-14) or by exact clipping, and
/// checked by an independent Monte Carlo. Metres.
std::vector<ReferencePair> reference_pairs();

/// Discs (C-41), patches of a sphere, small areas, strips by Hottel's crossed strings, and rectangles.
std::vector<ReferenceFormula> reference_formulas();

}  // namespace patchlight
