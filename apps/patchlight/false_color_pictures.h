#pragma once

#include "apps/imaging/false_color.h"
#include "apps/patchlight/arguments.h"

#include <initializer_list>

namespace patchlight {

/// What --false-color or --show asks to see of one solution.
class FalseColorMap {
public:
    /// `arguments` must hold a quantity. `solution`'s scene must live as long as this.
    FalseColorMap(const ShownSolution& solution, const PatchField<double>& eta, const ViewHits& hits,
                  const FalseColorArguments& arguments, Shade shade);

    const QuantityMap& map() const { return map_; }
    const Scene& scene() const { return scene_; }

    /// sRGB, with the legend below: a few lines higher than the view.
    Image picture(const ValueScale& scale, bool patch_borders) const;

private:
    const Scene& scene_;
    FalseColorArguments arguments_;
    QuantityMap map_;
};

/// The range that was asked for, or one that fits all of the maps.
ValueScale scale_of(std::initializer_list<const FalseColorMap*> maps, const FalseColorArguments& arguments);

}  // namespace patchlight
