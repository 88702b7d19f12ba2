#pragma once

#include "solver/system.h"

#include <cstdint>

namespace patchlight {

/// What rays say of the light that links carry, relative to it.
struct LinkCheck {
    double error = 0;        ///< relative L2 error of ρ H, patch by patch, ≥ 0
    double uncertainty = 0;  ///< standard error of error²
    double bias = 0;  ///< signed: light that links bring too much (+) or too little (−), of all that they bring

    /// √(error² − 2 uncertainty): smaller than this it is by one chance in forty only.
    double at_least() const;
};

/// The a-posteriori, signed estimate of links' errors ([BekaertWillems96] find it by further kernels, this by rays): on
/// patches drawn in proportion to ρ² A, two independent means of X over rays that leave the patch, each less H; their
/// product's mean over patches is the squared error without bias, for noise of the two is independent. X: radiosity
/// that links carry, W/m²; H: what they bring, W/m². The same on any number of threads. Throws Interrupted.
LinkCheck check_links(const Exchange& exchange, const PatchField<Rgb>& rho, const Radiosity& X, const Radiosity& H,
                      std::size_t rays, std::uint64_t seed, const WorkMonitor& monitor = {});

}  // namespace patchlight
