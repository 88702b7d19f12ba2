#include "apps/study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace patchlight {

namespace {

/// `option` in the place of another of its name, or behind all.
void put(std::vector<OptionText>& options, const OptionText& option)
{
    const auto same = std::ranges::find(options, option.name, &OptionText::name);
    if (same == options.end()) {
        options.push_back(option);
    } else {
        *same = option;
    }
}

bool skipped(const Study& study, const std::vector<std::string>& values)
{
    const auto holds = [&](const OptionText& condition) {
        const auto axis = std::ranges::find(study.axes, condition.name, &StudyAxis::name);
        return axis != study.axes.end() &&
               values[static_cast<std::size_t>(axis - study.axes.begin())] == condition.value;
    };
    return std::ranges::any_of(study.skips,
                               [&](const StudySkip& skip) { return std::ranges::all_of(skip.all, holds); });
}

/// The cell of an index; it may be one that is skipped.
StudyCell cell_at(const Study& study, std::size_t index)
{
    std::vector<std::size_t> at(study.axes.size());
    for (std::size_t axis = study.axes.size(), rest = index; axis-- > 0;) {
        at[axis] = rest % study.axes[axis].values.size();
        rest /= study.axes[axis].values.size();
    }
    StudyCell cell{index, {}, {}, study.scenes.front().value, study.options};
    for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
        const OptionText& option = study.axes[axis].values[at[axis]];
        cell.values.push_back(option.value);
        cell.name += fmt::format("{}{}={}", cell.name.empty() ? "" : " ", option.name, option.value);
        if (study.axes[axis].name == "scene") {
            cell.scene = study.scenes[at[axis]].value;
        } else if (option.value.empty()) {
            std::erase_if(cell.options, [&](const OptionText& other) { return other.name == option.name; });
        } else {
            put(cell.options, option);
        }
    }
    if (cell.name.empty()) cell.name = study.name;
    return cell;
}

}  // namespace

std::uint64_t grid_size(const Study& study)
{
    std::uint64_t cells = 1;
    for (const StudyAxis& axis : study.axes) {
        const std::uint64_t values = axis.values.size();
        if (values != 0 && cells > std::numeric_limits<std::uint64_t>::max() / values) {
            return std::numeric_limits<std::uint64_t>::max();
        }
        cells *= values;
    }
    return cells;
}

std::vector<StudyCell> expand(const Study& study)
{
    const std::uint64_t size = grid_size(study);
    if (size > study.limits.cells) {
        throw StudyLimitError(fmt::format("{}: {} cells, limit {}; vary less, or raise cells in [limits]",
                                          study.file.string(), size, study.limits.cells));
    }
    std::vector<StudyCell> cells;
    for (std::size_t index = 0; index < size; ++index) {
        StudyCell cell = cell_at(study, index);
        if (!skipped(study, cell.values)) cells.push_back(std::move(cell));
    }
    if (cells.empty()) throw StudyError(study.file.string() + ": all cells are skipped");
    return cells;
}

std::vector<OptionText> reference_options(const Study& study)
{
    std::vector<OptionText> options = study.options;
    for (const OptionText& option : study.reference.options) put(options, option);
    return options;
}

std::vector<OptionText> reference_options(const Study& study, const StudyCell& cell)
{
    static constexpr std::array<std::string_view, 4> of_scene{"unit", "two-sided", "emitter", "max-reflectance"};
    std::vector<OptionText> options = reference_options(study);
    for (const OptionText& option : cell.options)
        if (std::ranges::find(of_scene, option.name) != of_scene.end()) put(options, option);
    return options;
}

}  // namespace patchlight
