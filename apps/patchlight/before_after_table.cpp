#include "apps/patchlight/before_after_table.h"

#include <fmt/format.h>

namespace patchlight {

namespace {

std::string seconds_until(int cycle, const Json& timing)
{
    double sum = 0;
    bool known = false;
    if (timing.is_object() && timing.contains("cycles")) {
        for (const Json& done : timing["cycles"]) {
            if (done.value("cycle", 0) > cycle || !done.contains("seconds")) {
                continue;
            }
            for (const Json& stage : done["seconds"]) {
                sum += stage.is_number() ? stage.get<double>() : 0;
            }
            known = known || done.value("cycle", 0) == cycle;
        }
    }
    return known ? fmt::format("{:.1f}", sum) : "-";
}

std::string row(const char* name, const CycleRecord& cycle, const Json& timing)
{
    return fmt::format("{:<6}  {:>10}  {:>15}  {:>8}  {:>11}\n", name, cycle.elements,
                       fmt::format("{:.3g} %", 100 * cycle.estimated_error), seconds_until(cycle.cycle, timing),
                       fmt::format("{:.2g} %", 100 * cycle.energy.relative_residual));
}

}  // namespace

std::string before_after_table(const RunRecord& record, const Json& timing)
{
    if (record.cycles.empty()) {
        return "";
    }
    std::string table = fmt::format("{:<6}  {:>10}  {:>15}  {:>8}  {:>11}\n", "", "elements", "estimated error",
                                    "seconds", "energy rest");
    if (record.cycles.size() > 1) {
        table += row("before", record.cycles.front(), timing);
    }
    return table + row("after", record.cycles.back(), timing);
}

}  // namespace patchlight
