#pragma once

#include "solver/link_check.h"
#include "solver/links.h"
#include "solver/solve.h"
#include "solver/system.h"

namespace patchlight {

struct HierarchicalOptions {
    double tolerance = 0.05;  ///< on the estimated relative L2 error that links add to the reflected light, > 0
    int max_sweeps = 1000;    ///< of the linear solve on the finest links, ≥ 1
    std::size_t max_links = 400'000'000;  ///< 36 bytes each while solving; over it refinement ends, unconverged
    std::uint64_t seed = 1;
};

struct HierarchicalSolution {
    SolveReport report;     ///< residual: the largest of the links' errors and the linear solve's bound
    EnergyBalance energy;   ///< what is lost to backs and outside is found by rays, see lost_light()
    double link_error = 0;  ///< relative, of ρ H, from LinkOperator::squared_error(): an estimate, not a bound
    LinkCheck check;        ///< of the last links, by rays of their own
    double imbalance = 0;   ///< |light that links make or lose|, of the light they start from (E, or reflected once),
                            ///< beyond what rays leave open; what B is off by in the mean over all that absorbs
    std::size_t nodes = 0;  ///< of the tree
    std::size_t rays = 0;
    std::size_t bytes = 0;  ///< of tree and links at the end
};

/// Radiosity on a patch mesh over links instead of n² factors: hierarchical radiosity with clusters. Links are refined
/// from the root down where what they carry now may be wrong, for 16, 8, 4, 2 and 1 times the tolerance, with the light
/// solved in between (multigridding), until their estimated error meets that; each may have the same share of it. At
/// the end rays of their own measure it (check_links()): where that is surely more, links are refined further; and
/// where so much light is made or lost, for what one exchange is off by comes round 1/(1 − ρ) times in bright rooms. As
/// the tolerance goes to 0 the links become those between patches, and B the dense system's. `system`: unassembled() or
/// assembled, its F is not used. With exact direct light in it, links carry reflected light only: R = ρ H_direct + ρ F
/// R, B = E + R. `B` holds the start (E, or a coarser solution) and gets the answer. Not converging is a report. The
/// same bytes on any number of threads. Throws Interrupted.
HierarchicalSolution solve_hierarchical(const Exchange& exchange, const RadiositySystem& system, Radiosity& B,
                                        const HierarchicalOptions& options = {}, const WorkMonitor& monitor = {});

}  // namespace patchlight
