#include "apps/patchlight/false_color_pictures.h"

namespace patchlight {

namespace {

/// Brightness of light in one map, sizes and errors in another, so that nobody takes the one for the other.
const char* table_name(Quantity quantity)
{
    return quantity == Quantity::error || quantity == Quantity::size ? "viridis" : "inferno";
}

}  // namespace

FalseColorMap::FalseColorMap(const ShownSolution& solution, const PatchField<double>& eta, const ViewHits& hits,
                             const FalseColorArguments& arguments, Shade shade)
    : scene_(solution.scene), arguments_(arguments), map_(quantity_map(solution, eta, hits, *arguments.quantity, shade))
{}

Image FalseColorMap::picture(const ValueScale& scale, bool patch_borders) const
{
    const FalseColor how{color_table(table_name(*arguments_.quantity)), scale, round_values(scale, arguments_.isolines),
                         patch_borders};
    return with_legend(false_color(map_, how), how, title_of(*arguments_.quantity), note_on(map_));
}

ValueScale scale_of(std::initializer_list<const FalseColorMap*> maps, const FalseColorArguments& arguments)
{
    if (arguments.range) return {arguments.scale, arguments.range->first, arguments.range->second};
    std::vector<float> values;
    for (const FalseColorMap* map : maps) {
        const std::vector<float> more = values_for_scale(map->scene(), map->map());
        values.insert(values.end(), more.begin(), more.end());
    }
    return fitting_scale(std::move(values), arguments.scale);
}

}  // namespace patchlight
