#pragma once

#include "solver/adaptive_options.h"
#include "solver/light_stages.h"

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace patchlight {

/// How far from its invariants a method may be: what it promises, with room for meshes as coarse as can be asked for.
struct InvariantTolerances {
    double row_sum = 1e-4;  ///< |Σ_j F_ij + backs + escaped − 1| of any row; single precision and swapped sources
    double factor = 1e-6;   ///< F_ij − 1 of any factor
    double closure = 1e-3;  ///< of all light in a closed scene, what escapes
    double reciprocity = std::numeric_limits<double>::infinity();  ///< as ReciprocityDefect; not promised: infinite
    double energy = 0.02;  ///< of all light that is exchanged, what is made or lost, beside the noise of sampled rows
    double rays = 0;       ///< of each row, independent and spread over its patch; 0: the rows have no noise
};

/// Those of the method that options.form_factors names.
InvariantTolerances invariant_tolerances(const AdaptiveOptions& options);

/// One law that a solution breaks, where it is broken worst. Plain data.
struct BrokenInvariant {
    std::string law;        ///< "a factor is not finite", …
    std::size_t count = 0;  ///< of patches or pairs that break it
    double value = 0;       ///< the worst
    PatchId patch, other;   ///< where that is; invalid: nowhere in particular
};

/// What must hold of rows and of light on them, whatever the scene: areas, E and factors finite, E ≥ 0, 0 ≤ F ≤ 1, rows
/// that sum to 1 with backs and what escapes, no light that escapes from a closed scene, reciprocity where it is
/// promised, B finite, B ≥ E, and no light made or lost in the exchange: with X = B, or B − E where direct light is
/// exact, |Σ A X − Σ A (F X) − Σ A X (backs + escaped)| ≤ energy · Σ A X + noise. Rows of n rays carry noise of
/// variance v ≤ 2 (max A / n) Σ A X² in steps of b = max A max X / n: by Bernstein's inequality more than √(2 t v) + t
/// b / 3 comes once in e^t / 2, t = 21. The exact direct light is not in it: what it misses between the points of a
/// patch is the mesh's error. A system without rows is looked at as far as it goes. Nothing is changed. Empty: all
/// holds.
std::vector<BrokenInvariant> broken_invariants(const RadiositySystem& system, const Radiosity& B, bool closed,
                                               const InvariantTolerances& tolerances);

/// The same of a reconstruction: finite and ≥ 0 at every node, and B ≥ E in the mean of every patch.
std::vector<BrokenInvariant> broken_invariants(const Scene& scene, const PatchMesh& mesh, const Radiosity& B,
                                               const Reconstruction& nodes);

/// A solution that can't be right. what() names the laws, patches and surfaces, and what to do.
class InvariantError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Throws InvariantError when there are any.
void require_none(const std::vector<BrokenInvariant>& broken, const Scene& scene, const PatchMesh& mesh);

}  // namespace patchlight
