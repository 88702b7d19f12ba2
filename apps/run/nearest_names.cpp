#include "apps/run/nearest_names.h"

#include <algorithm>
#include <numeric>

namespace patchlight {

std::size_t edit_distance(std::string_view a, std::string_view b)
{
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, changed});
        }
    }
    return row.back();
}

std::vector<std::string> by_nearness(std::string_view name, std::vector<std::string> names)
{
    std::ranges::stable_sort(names, {}, [&](const std::string& other) { return edit_distance(name, other); });
    return names;
}

std::string did_you_mean(std::string_view name, std::span<const std::string> names)
{
    // A name of a kilobyte is near to nothing, and slow to compare.
    if (names.empty() || name.size() > 64) return {};
    const std::string nearest = by_nearness(name, {names.begin(), names.end()}).front();
    const bool near = edit_distance(name, nearest) <= std::max<std::size_t>(2, name.size() / 3);
    return near && nearest != name ? ", did you mean \"" + nearest + "\"?" : "";
}

}  // namespace patchlight
