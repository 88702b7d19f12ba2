#pragma once

#include "apps/patchlight/commands.h"
#include "apps/patchlight/scene_input.h"

namespace patchlight {

/// The object of that name. Throws UsageError ("object"), with the names that are nearest to it, and SceneError
/// ("zeroarea") when all its faces have no area or lie under another object's.
ObjectId object_named(const std::string& name, const SceneInput& input);

/// One form factor, from an object to another: computed, and printed as the command asks.
/// Throws SceneError ("geometry") naming the objects whose faces the method can't take.
int report_between(const FormFactorsCommand& command, const SceneInput& input, Session& session);

}  // namespace patchlight
