#pragma once

#include "solver/emitted_light.h"
#include "solver/estimate.h"
#include "solver/indirect_light.h"

#include <memory>
#include <optional>

namespace patchlight {

struct CarrierOptions {
    double target_error = 0;          ///< refined until it leaves less, relative …
    std::size_t max_elements = 4000;  ///< … or has so many elements
    GatherOptions gather;
    MarkOptions mark;
};

/// The light that rays meet: quadratic on a mesh refined for the emitters' light. Keeps references to scene and caster.
class LightCarrier {
public:
    /// Refines `start.mesh` for emitters' light and `indirect` together. Throws Interrupted.
    LightCarrier(const Exchange& start, const EmittedLight& emitted, const IndirectLight& indirect,
                 const CarrierOptions& options, const WorkMonitor& monitor = {});

    const Exchange& exchange() const { return *exchange_; }

    /// ρ(H_emitters + H_indirect) at its nodes, W/m²; with E where the emitters' light isn't apart.
    QuadraticRadiosity leaving(const IndirectLight& indirect) const;

    /// B − E at a place, from leaving().
    Rgb reflected(SurfaceId surface, const Vec3& place, const QuadraticRadiosity& leaving) const;

    /// √∫|B − E|² dA over all that reflects, W/m²·m.
    double norm(const QuadraticRadiosity& leaving) const;

private:
    void hold(const Exchange& start, PatchMesh mesh);

    const Scene& scene_;
    bool apart_;
    std::unique_ptr<const PatchMesh> mesh_;
    std::unique_ptr<const PatchLocator> locator_;
    std::optional<Exchange> exchange_;
    ElementPoints nodes_;
    std::vector<Rgb> direct_;
};

}  // namespace patchlight
