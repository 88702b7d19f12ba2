#pragma once

#include "meshing/scene.h"

namespace patchlight {

/// Whether no ray that leaves the front of a surface can escape. Triangle sides that meet at shared edges, going
/// round the edge, bound the same region of space; a set of sides that bounds a volume from outside closes its region;
/// sides that don't (a plate in the air, a free block) lie in the region that a ray from their outermost vertex meets.
/// Faces that pierce one another without sharing edges are taken as if they didn't. With very many free
/// pieces (more than 5e8 / triangles) the answer is no.
bool is_closed(const Scene& scene);

}  // namespace patchlight
