#pragma once

#include "apps/imaging/picture.h"
#include "meshing/surface_line.h"

#include <cstdint>
#include <vector>

namespace patchlight {

/// The colour of a kind of line, sRGB between 0 and 1: five that readers with any colour vision tell apart
/// [OkabeIto08]: contact vermilion, EV sky blue, VE bluish green, EEE yellow, plane reddish purple.
Rgb line_color(LineKind kind);

/// For each sample of a view what line of the mesh it shows: 1 + the LineKind, 0 where there is none. Edges that go on
/// beyond a line's end aren't drawn. A line is 1.8 pixels wide and seen on its own surface only, so that what
/// stands before it hides it; where lines cross, the kind that comes first in LineKind is on top.
std::vector<std::uint8_t> line_samples(const PatchMesh& mesh, const ViewHits& hits);

/// Names the kinds of line that the mesh holds, each in its colour, in the lower left corner of a picture of sRGB
/// values. Does nothing when there are none.
void draw_line_legend(const PatchMesh& mesh, Image& srgb);

}  // namespace patchlight
