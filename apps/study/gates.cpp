#include "apps/study/gates.h"

#include <cmath>
#include <functional>
#include <limits>

namespace patchlight {

namespace {

constexpr const char* no_reference = "nothing is measured: the study has no reference";

/// A value, or why there is none.
struct Checked {
    std::optional<double> value;
    std::string why_not;
};

using Quantity = std::function<Checked(const CycleResult&)>;

Checked measured_error_of(const CycleResult& cycle)
{
    if (cycle.error) return {cycle.error, {}};
    return {std::nullopt, "its error wasn't measured"};
}

Checked effectivity_of(const CycleResult& cycle)
{
    if (!cycle.error) return measured_error_of(cycle);
    if (*cycle.error > 0) return {cycle.estimated_error / *cycle.error, {}};
    return {cycle.estimated_error > 0 ? std::numeric_limits<double>::infinity() : 1.0, {}};
}

enum class Bound { most, least };

GateResult result_of(const std::string& gate, const std::string& of, Bound kind, double bound, const Checked& checked)
{
    GateResult result{gate, of, checked.value, bound, false, checked.why_not};
    if (result.value && std::isnan(*result.value)) {
        result.value.reset();
        result.message = "not a number";
    }
    // Written so that what can't be compared fails.
    if (result.value) result.passed = kind == Bound::most ? *result.value <= bound : *result.value >= bound;
    return result;
}

Checked checked_in(const StudyResult& study, const CellResult& cell, bool needs_reference, const Quantity& quantity)
{
    if (!ran_to_its_end(cell))
        return {std::nullopt, name_of(cell.status) + (cell.message.empty() ? "" : ": " + cell.message)};
    if (needs_reference && !is_measured(study)) return {std::nullopt, no_reference};
    return quantity(cell.cycles.back());
}

}  // namespace

std::vector<GateResult> check_gates(const StudyResult& study)
{
    std::vector<GateResult> results;
    const StudyGates& gates = study.gates;
    if (gates.min_rate) {
        for (const SeriesRates& rates : rates_of(study)) {
            Checked checked{rates.by_elements.order, rates.by_elements.note};
            if (!is_measured(study)) checked = {std::nullopt, no_reference};
            results.push_back(result_of("min_rate", rates.series.name, Bound::least, *gates.min_rate, checked));
        }
    }
    const auto each_cell = [&](const char* gate, Bound kind, std::optional<double> bound, bool needs_reference,
                               const Quantity& quantity) {
        if (!bound) return;
        for (const CellResult& cell : study.cells)
            results.push_back(
                result_of(gate, cell.cell.name, kind, *bound, checked_in(study, cell, needs_reference, quantity)));
    };
    each_cell("max_error", Bound::most, gates.max_error, true, measured_error_of);
    each_cell("max_energy_residual", Bound::most, gates.max_energy_residual, false, [](const CycleResult& c) {
        return Checked{std::abs(c.energy_residual), {}};
    });
    each_cell("min_effectivity", Bound::least, gates.min_effectivity, true, effectivity_of);
    each_cell("max_effectivity", Bound::most, gates.max_effectivity, true, effectivity_of);
    return results;
}

}  // namespace patchlight
