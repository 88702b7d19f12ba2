#include "apps/patchlight/commands.h"
#include "apps/patchlight/progress_display.h"
#include "apps/patchlight/reference_scene.h"
#include "apps/patchlight/usage_error.h"
#include "formfactor/reference_cases.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>

namespace patchlight {

namespace {

using Clock = std::chrono::steady_clock;
using Method = FormFactorMethod;

/// What elementary functions must reach.
constexpr double formula_bound = 1e-12;
/// Monte Carlo: in standard errors, and what that itself must come down to as part of the factor.
constexpr double most_sigmas = 4, relative_standard_error = 0.005;

/// How far a value may be off: absolutely, or as part of the reference.
struct Bound {
    double value = 0;
    bool relative = false;
};

struct Checked {
    std::string method, name;
    double reference = 0;
    PairFactor found;
    Bound bound;
    bool only_bounded = false;  ///< nothing is known but that it is above 0, and at most the reference
    double seconds = 0;
    bool passed = false;
    std::string problem;  ///< what was thrown
};

Bound bound_of(Method method, ReferenceKind kind)
{
    switch (method) {
    case Method::closed_form:
        return {1e-10};
    case Method::exact:
        return {1e-9};
    case Method::quadrature:
        return {1e-4};
    case Method::monte_carlo:
        return {};
    case Method::hemicube:
    case Method::hemisphere:
        break;
    }
    return {kind == ReferenceKind::distant ? 0.02 : kind == ReferenceKind::touching ? 0.015 : 0.005, true};
}

bool within(const Checked& c, Method method)
{
    const double off = std::abs(c.found.value - c.reference);
    if (!std::isfinite(c.found.value)) {
        return false;
    }
    if (c.only_bounded) {
        return c.found.value > 0 && c.found.value <= c.reference;
    }
    if (method == Method::monte_carlo) {
        return off <= most_sigmas * c.found.error &&
               c.found.error <= relative_standard_error * c.found.value * (1 + 1e-9);
    }
    return off <= (c.bound.relative ? c.bound.value * c.reference : c.bound.value);
}

double seconds_since(Clock::time_point begin)
{
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A value and what is said of it, whatever is thrown on the way.
template <class Compute>
void compute(Checked& result, const Compute& value)
{
    const auto begin = Clock::now();
    try {
        result.found = value();
    } catch (const std::exception& problem) {
        result.problem = problem.what();
    }
    result.seconds = seconds_since(begin);
}

Checked check(Method method, const ReferencePair& pair, std::uint64_t seed)
{
    Checked result;
    result.method = name_of(form_factor_method_names(), method);
    result.name = pair.name;
    result.reference = pair.factor;
    result.bound = bound_of(method, pair.kind);
    result.only_bounded = pair.kind == ReferenceKind::sliver;
    const Scene scene = reference_scene(pair);
    const RayCaster caster(scene);
    const std::vector<Facet> from = facets_of(scene, reference_object(scene, "from"));
    const std::vector<Facet> to = facets_of(scene, reference_object(scene, "to"));
    PairOptions options;
    options.method = method;
    options.relative_error = relative_standard_error;
    options.seed = seed;
    compute(result, [&] { return pair_factor(scene, caster, from, to, options); });
    result.passed = result.problem.empty() && within(result, method);
    return result;
}

Checked check(const ReferenceFormula& formula)
{
    Checked result;
    result.method = "formula " + formula.by;
    result.name = formula.name;
    result.reference = formula.factor;
    result.bound = {formula_bound};
    compute(result, [&] { return PairFactor{formula.value(), 0, 1}; });
    result.passed = result.problem.empty() && within(result, Method::closed_form);
    return result;
}

bool sees_blockers(Method method)
{
    return method != Method::closed_form;
}

/// All that is to be checked, to be run in any order.
std::vector<std::function<Checked()>> checks_of(const ValidateCommand& command)
{
    std::vector<std::function<Checked()>> checks;
    if (!command.method || *command.method == Method::closed_form) {
        for (const ReferenceFormula& formula : reference_formulas()) {
            checks.emplace_back([formula] { return check(formula); });
        }
    }
    for (const auto& entry : form_factor_method_names()) {
        const Method method = entry.second;
        if (command.method && *command.method != method) {
            continue;
        }
        for (const ReferencePair& pair : reference_pairs()) {
            if (pair.blockers.empty() || sees_blockers(method)) {
                checks.emplace_back([=, seed = command.seed] { return check(method, pair, seed); });
            }
        }
    }
    return checks;
}

/// Each check on one thread, several at a time.
std::vector<Checked> run(const std::vector<std::function<Checked()>>& checks, Session& session)
{
    std::vector<Checked> results(checks.size());
    ProgressDisplay display(session.messages);
    std::mutex telling;
    std::size_t done = 0;
    tbb::parallel_for(std::size_t{0}, checks.size(), [&](std::size_t i) {
        if (session.interruption.token().stop_requested()) {
            return;
        }
        results[i] = checks[i]();
        const std::lock_guard lock(telling);
        ++done;
        display.show({.stage = "validate",
                      .cycle = -1,
                      .fraction = static_cast<double>(done) / static_cast<double>(checks.size()),
                      .elements = done});
    });
    session.interruption.check();
    return results;
}

std::string bound_text(const Checked& c)
{
    if (c.only_bounded) {
        return "above 0";
    }
    if (c.bound.value == 0) {
        return fmt::format("{:.0f} sigma", most_sigmas);
    }
    return c.bound.relative ? fmt::format("{:g} %", 100 * c.bound.value) : fmt::format("{:.0e}", c.bound.value);
}

/// Relative where the bound is.
std::string off_text(const Checked& c)
{
    const double off = std::abs(c.found.value - c.reference);
    if (c.only_bounded) {
        return "";
    }
    if (c.bound.value == 0) {
        return fmt::format("{:.2f} sigma", off / c.found.error);
    }
    return c.bound.relative ? fmt::format("{:.3f} %", 100 * off / c.reference) : fmt::format("{:.1e}", off);
}

std::string reference_text(const Checked& c)
{
    return c.only_bounded ? fmt::format("at most {:g}", c.reference) : fmt::format("{:.15f}", c.reference);
}

std::string table_of(const std::vector<Checked>& results)
{
    std::string out = fmt::format("{:<19} {:<42} {:>18} {:>18} {:>11} {:>8} {:>8}\n", "method", "case", "value",
                                  "reference", "error", "bound", "seconds");
    for (const Checked& c : results) {
        out += fmt::format("{:<19} {:<42} {:>18.15f} {:>18} {:>11} {:>8} {:>8.3f}  {}\n", c.method, c.name,
                           c.found.value, reference_text(c), off_text(c), bound_text(c), c.seconds,
                           c.passed            ? "ok"
                           : c.problem.empty() ? "MISSED"
                                               : "FAILED: " + c.problem);
    }
    return out;
}

Json json_of(const Checked& c)
{
    Json one{{"method", c.method},
             {"case", c.name},
             {"value", c.found.value},
             {"reference", c.reference},
             {"error", c.only_bounded ? Json() : Json(std::abs(c.found.value - c.reference))},
             {"bound", bound_text(c)},
             {"estimated_error", c.found.error},
             {"samples", c.found.samples},
             {"seconds", c.seconds},
             {"passed", c.passed}};
    if (!c.problem.empty()) {
        one["problem"] = c.problem;
    }
    return one;
}

int report(const std::vector<Checked>& results, double seconds, const ValidateCommand& command, Session& session)
{
    const auto missed = static_cast<std::size_t>(std::ranges::count(results, false, &Checked::passed));
    if (command.json) {
        Json all{{"schema", "patchlight-validate/1"}, {"seed", command.seed}, {"cases", Json::array()}};
        for (const Checked& c : results) {
            all["cases"].push_back(json_of(c));
        }
        all["passed"] = results.size() - missed;
        all["failed"] = missed;
        all["seconds"] = seconds;
        write_result(all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    } else {
        write_result(table_of(results) + fmt::format("{} of {} within their bounds, {:.1f} s\n",
                                                     results.size() - missed, results.size(), seconds));
    }
    if (missed == 0) {
        return 0;
    }
    session.messages.error("gate", fmt::format("{} of {} form factors miss their bounds", missed, results.size()));
    return 4;
}

}  // namespace

int run_command(const ValidateCommand& command, Session& session)
{
    session.messages.set_quiet(command.quiet);
    std::optional<tbb::global_control> threads;
    if (command.threads > 0) {
        threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(command.threads));
    }
    const auto begin = Clock::now();
    try {
        const std::vector<Checked> results = run(checks_of(command), session);
        return report(results, seconds_since(begin), command, session);
    } catch (const Interrupted&) {
        session.messages.note("interrupted");
        return session.interruption.exit_code();
    }
}

}  // namespace patchlight
