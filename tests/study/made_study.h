#pragma once

#include "apps/study/study_result.h"

#include <fmt/format.h>

#include <cmath>

namespace patchlight::testing {

inline CycleResult made_cycle(int cycle, std::size_t elements, double error)
{
    CycleResult c;
    c.cycle = cycle;
    c.elements = elements;
    c.estimated_error = 2 * error;
    c.error = error;
    c.error_ci = Interval{0.9 * error, 1.1 * error};
    c.max_error = 10 * error;
    c.energy_residual = 1e-6;
    c.seconds = static_cast<double>(elements) / 1000;
    return c;
}

/// 2 refinements × 4 sizes, measured: intensity falls as elements^−½, both as elements^−1; both start at 0.1 with 500.
/// Each cell has one cycle at a fifth of its elements before its last.
inline StudyResult made_study()
{
    StudyResult study;
    study.name = "made";
    study.axes = {{"refine", {{"refine", "intensity", {}}, {"refine", "both", {}}}}, {"max-elements", {}}};
    for (const int n : {500, 1000, 2000, 4000}) study.axes[1].values.push_back({"max-elements", std::to_string(n), {}});
    study.along = "max-elements";
    study.reference.kind = ReferenceKind::path_traced;
    for (std::size_t r = 0; r < 2; ++r) {
        for (std::size_t k = 0; k < 4; ++k) {
            const auto n = static_cast<std::size_t>(500U << k);
            const double order = r == 0 ? 0.5 : 1.0;
            CellResult cell;
            cell.cell.index = 4 * r + k;
            cell.cell.values = {study.axes[0].values[r].value, study.axes[1].values[k].value};
            cell.cell.name = fmt::format("refine={} max-elements={}", cell.cell.values[0], cell.cell.values[1]);
            cell.cell.scene = "room.obj";
            cell.id = fmt::format("{:016x}", cell.cell.index);
            cell.status = CellStatus::done;
            const auto error_with = [&](double elements) { return 0.1 * std::pow(elements / 500, -order); };
            for (const std::size_t elements : {n / 5, n})
                cell.cycles.push_back(
                    made_cycle(elements == n ? 1 : 0, elements, error_with(static_cast<double>(elements))));
            study.cells.push_back(cell);
        }
    }
    return study;
}

}  // namespace patchlight::testing
