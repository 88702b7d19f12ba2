#pragma once

#include "meshing/scene.h"

namespace patchlight {

/// Whether no light can escape: every region of space that an emitter shines into is enclosed (without emitters:
/// that any front faces). A block's bottom that presses on the floor faces out of the room, but no light gets there.
/// Triangle sides that meet at shared edges, going round the edge, bound the same region of space; a set of sides that
/// bounds a volume from outside closes its region; sides that don't (a plate in the air, a free block) lie in the
/// region that a ray from their outermost vertex meets. Faces that pierce one another without sharing edges are taken
/// as if they didn't. With very many free pieces (more than 5e8 / triangles) the answer is no.
bool is_closed(const Scene& scene);

}  // namespace patchlight
