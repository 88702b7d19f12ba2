#pragma once

#include "apps/patchlight/arguments.h"
#include "formfactor/first_hits.h"
#include "formfactor/ray_caster.h"
#include "meshing/read_scene.h"

#include <string>
#include <vector>

namespace patchlight {

/// A scene with everything a command asks of it.
struct SceneInput {
    Scene scene;
    SceneReport report;
    std::string sha256;  ///< of the file
};

/// Reads the scene and the cameras in STEM.view.json beside it when it has none itself. Throws SceneError,
/// UsageError ("view").
SceneInput load_scene(const SceneArguments& arguments);

/// What the first rays say about the scene, as warnings: mixed winding, a flipped emitter.
std::vector<std::string> first_hit_warnings(const FirstHits& hits);

/// W, three bands together.
double emitted_power(const Scene& scene);
/// m².
double total_area(const Scene& scene);

}  // namespace patchlight
