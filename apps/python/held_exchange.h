#pragma once

#include "solver/light_stages.h"

#include <mutex>
#include <stdexcept>
#include <utility>

namespace patchlight {

/// An Exchange and the locator of its mesh; what else it refers to, Python keeps.
struct HeldExchange {
    HeldExchange(const Scene& scene, const RayCaster& caster, const PatchMesh& mesh, const Emitted& emitted)
        : locator(mesh), exchange{scene, caster, mesh, locator, emitted.direct()}
    {}
    HeldExchange(const HeldExchange&) = delete;
    HeldExchange& operator=(const HeldExchange&) = delete;

    PatchLocator locator;
    Exchange exchange;
};

/// A lighting, and the scene it is of: its surfaces' numbers mean nothing in another.
struct HeldLighting {
    const Scene& scene;
    Lighting lighting;

    /// For meshes of that scene. Throws std::invalid_argument.
    void check(const Exchange& exchange) const
    {
        if (&exchange.scene != &scene) throw std::invalid_argument("the lighting is that of another scene");
    }
};

/// A system; solving it changes it for a while, so that one thread at a time may.
struct HeldSystem {
    explicit HeldSystem(RadiositySystem given) : system(std::move(given)) {}

    RadiositySystem system;
    std::mutex solving;
};

}  // namespace patchlight
