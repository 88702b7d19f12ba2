#pragma once

#include "apps/imaging/picture.h"
#include "apps/imaging/scalar_image.h"

#include <string>
#include <vector>

namespace patchlight {

/// What a map shows, one number a point.
enum class Quantity {
    /// The surface's illuminance, lx: 683 lm/W × the Rec. 709 luminance of its irradiance H. The solution holds
    /// B = E + ρH, so H = (B − E)/ρ in each band; no value where a band is not reflected at all.
    lux,
    irradiance,  ///< H as above, W/m², the bands weighed .2126, .7152, .0722
    radiosity,   ///< B, W/m², weighed alike
    error,       ///< the estimated error of B, √(η²/A) of each element: W/m², three bands together
    size         ///< the area of each element, m²
};

/// Lumens in a watt, by which photometric quantities are told.
inline constexpr double lumens_per_watt = 683;

/// The heading of a legend: the quantity and its unit.
std::string title_of(Quantity quantity);

/// A quantity at each sample of a view: ViewHits::width × samples wide, and so high. NaN: no value.
struct QuantityMap {
    int samples = 1;
    ScalarImage values;
    std::vector<std::uint32_t> surface;  ///< as in HitBatch
    std::vector<std::uint32_t> patch;    ///< empty: no borders to draw
};

/// `eta` as in StoredSolution. `shade` tells whether light is the elements' reconstruction or one value a patch.
QuantityMap quantity_map(const ShownSolution& solution, const PatchField<double>& eta, const ViewHits& hits,
                         Quantity quantity, Shade shade);

/// The values by which a scale is to be chosen: those of what doesn't emit.
std::vector<float> values_for_scale(const Scene& scene, const QuantityMap& map);

}  // namespace patchlight
