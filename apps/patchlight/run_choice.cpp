#include "apps/patchlight/run_choice.h"

#include "apps/patchlight/argument_values.h"
#include "apps/run/stored_scene.h"
#include "apps/run/whole_number.h"

namespace patchlight {

ChosenRun chosen_run(const std::string& text)
{
    std::error_code error;
    const auto at = text.rfind('@');
    ChosenRun chosen;
    chosen.name = text;
    if (at == std::string::npos || std::filesystem::exists(text, error)) {
        chosen.run = open_run(text);
    } else {
        chosen.cycle = cycle_in(text, text.substr(at + 1));
        chosen.run = open_run(text.substr(0, at));
    }
    (void)record_of(chosen.run, chosen.cycle);  // throws where there is none
    return chosen;
}

std::optional<double> seconds_until(const OpenedRun& run, const CycleRecord& cycle)
{
    try {
        const std::string text = read_bytes(run.folder / "timing.json");
        if (json_depth(text) > 16) return std::nullopt;
        double sum = 0;
        bool found = false;
        const Json timing = Json::parse(text);
        for (const Json& one : timing.at("cycles")) {
            if (whole_number_in<int>(one.at("cycle")) > cycle.cycle) continue;
            found = found || whole_number_in<int>(one.at("cycle")) == cycle.cycle;
            for (const auto& [stage, seconds] : one.at("seconds").items()) sum += seconds.get<double>();
        }
        return found ? std::optional(sum) : std::nullopt;
    } catch (const std::exception&) {
        return std::nullopt;  // The comparison is whole without it.
    }
}

}  // namespace patchlight
