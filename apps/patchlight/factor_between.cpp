#include "apps/patchlight/factor_between.h"

#include "apps/patchlight/usage_error.h"
#include "apps/run/nearest_names.h"
#include "apps/run/stored_scene.h"
#include "formfactor/blockers.h"
#include "meshing/scene_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace patchlight {

namespace {

constexpr std::size_t most_listed = 8;
/// Pairs of facets looked at for something in between; a scan of more would take longer than the factor.
constexpr std::size_t most_looked_at = 20'000;

std::string nearest_names(const std::string& name, std::vector<std::string> names)
{
    const std::size_t all = names.size();
    names = by_nearness(name, std::move(names));
    names.resize(std::min(all, most_listed));
    for (std::string& other : names) {
        other = "\"" + other + "\"";
    }
    return fmt::format("{}{}", fmt::join(names, ", "),
                       all > names.size() ? fmt::format(", and {} more", all - names.size()) : "");
}

/// Where the closed form, which looks through everything, may be wrong.
bool may_be_blocked(const Scene& scene, std::span<const Facet> from, std::span<const Facet> to)
{
    if (from.size() * to.size() > most_looked_at) {
        return true;
    }
    const Blockers blockers(scene);
    std::vector<Blocker> found;
    for (const Facet& a : from) {
        for (const Facet& b : to) {
            found.clear();
            (void)blockers.between(a.corners, a.normal, b.corners, b.normal, found);
            if (!found.empty()) {
                return true;
            }
        }
    }
    return false;
}

Json options_of(const PairOptions& o)
{
    switch (o.method) {
    case FormFactorMethod::hemicube:
        return {{"origins", o.origins}, {"resolution", o.resolution}, {"seed", o.seed}};
    case FormFactorMethod::hemisphere:
        return {{"rays", o.rays}, {"seed", o.seed}};
    case FormFactorMethod::monte_carlo:
        return {{"relative_error", o.relative_error}, {"seed", o.seed}};
    case FormFactorMethod::closed_form:
    case FormFactorMethod::exact:
    case FormFactorMethod::quadrature:
        break;
    }
    Json options;
    options["tolerance"] = o.tolerance > 0 ? Json(o.tolerance) : Json("default");
    return options;
}

const char* samples_are(FormFactorMethod method)
{
    switch (method) {
    case FormFactorMethod::closed_form:
        return "pairs of edges";
    case FormFactorMethod::hemicube:
        return "pixels";
    case FormFactorMethod::hemisphere:
    case FormFactorMethod::monte_carlo:
        return "rays";
    case FormFactorMethod::quadrature:
    case FormFactorMethod::exact:
        break;
    }
    return "nodes";
}

struct Between {
    std::vector<Facet> from, to;
    PairFactor factor;
    double seconds = 0;
    bool looked_through = false;

    /// A1 F12 = A2 F21.
    double reverse() const { return factor.value * total_area(from) / total_area(to); }
};

PairFactor computed(const SceneInput& input, const Between& between, const FormFactorsCommand& command)
{
    const RayCaster caster(input.scene);
    try {
        return pair_factor(input.scene, caster, between.from, between.to, command.pair);
    } catch (const std::invalid_argument& problem) {
        throw SceneError("geometry", fmt::format("{}: from \"{}\" to \"{}\": {}; see what inspect says of these faces",
                                                 input.scene.name, command.between->first, command.between->second,
                                                 problem.what()));
    }
}

Json json_of(const Between& b, const FormFactorsCommand& command, const SceneInput& input)
{
    const auto& [from, to] = *command.between;
    Json all{{"from", as_utf8(from)},
             {"to", as_utf8(to)},
             {"method", name_of(form_factor_method_names(), command.method)},
             {"value", b.factor.value},
             {"error", b.factor.error},
             {"samples", b.factor.samples},
             {"seconds", b.seconds},
             {"reverse", b.reverse()},
             {"areas", {{"from", total_area(b.from)}, {"to", total_area(b.to)}}},
             {"facets", {{"from", b.from.size()}, {"to", b.to.size()}}},
             {"scene", as_utf8(input.scene.name)},
             {"sha256", input.sha256},
             {"options", options_of(command.pair)}};
    if (command.method == FormFactorMethod::closed_form) {
        all["unoccluded"] = b.looked_through;
    }
    return all;
}

std::string text_of(const Between& b, const FormFactorsCommand& command)
{
    const auto& [from, to] = *command.between;
    const bool sampled = command.method == FormFactorMethod::hemicube ||
                         command.method == FormFactorMethod::hemisphere ||
                         command.method == FormFactorMethod::monte_carlo;
    std::string out =
        fmt::format("F        {:.{}g} from \"{}\" to \"{}\"\n", b.factor.value, sampled ? 7 : 15, from, to);
    out += fmt::format("error    {:.2g} ({}, estimated)\n", b.factor.error, sampled ? "standard error" : "absolute");
    out += fmt::format("reverse  {:.{}g}\n", b.reverse(), sampled ? 7 : 15);
    out += fmt::format("areas    {:.10g} m2 in {} facets, {:.10g} m2 in {}\n", total_area(b.from), b.from.size(),
                       total_area(b.to), b.to.size());
    out += fmt::format("method   {}, {} {}, {:.3g} s\n", name_of(form_factor_method_names(), command.method),
                       b.factor.samples, samples_are(command.method), b.seconds);
    return out;
}

}  // namespace

ObjectId object_named(const std::string& name, const SceneInput& input)
{
    const Scene& scene = input.scene;
    const auto found = std::ranges::find(scene.objects, name);
    const bool empty = std::ranges::find(input.report.empty_objects, name) != input.report.empty_objects.end();
    if (found == scene.objects.end() && !empty) {
        throw UsageError("object",
                         fmt::format("{}: there is no object \"{}\"; there {} {}", scene.name, name,
                                     scene.objects.size() == 1 ? "is" : "are", nearest_names(name, scene.objects)));
    }
    const ObjectId id(static_cast<std::size_t>(found - scene.objects.begin()));
    if (empty && found == scene.objects.end()) {
        throw SceneError("zeroarea", fmt::format("{}: all faces of object \"{}\" have no area; give it a face with one",
                                                 scene.name, name));
    }
    if (std::ranges::none_of(scene.surfaces, [&](const Surface& s) { return s.object == id; })) {
        throw SceneError("zeroarea", fmt::format("{}: object \"{}\" has no surface of its own: faces of other objects "
                                                 "lie on all of it, or it is covered; take one of them away",
                                                 scene.name, name));
    }
    return id;
}

int report_between(const FormFactorsCommand& command, const SceneInput& input, Session& session)
{
    Between between;
    between.from = facets_of(input.scene, object_named(command.between->first, input));
    between.to = facets_of(input.scene, object_named(command.between->second, input));
    session.interruption.check();
    const auto begin = std::chrono::steady_clock::now();
    between.factor = computed(input, between, command);
    between.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    session.interruption.check();
    if (command.method == FormFactorMethod::closed_form && may_be_blocked(input.scene, between.from, between.to)) {
        between.looked_through = true;
        session.messages.warning("closed-form looks through what stands between, and something may; --method exact "
                                 "doesn't");
    }
    write_result(command.json
                     ? json_of(between, command, input).dump(2, ' ', false, Json::error_handler_t::replace) + "\n"
                     : text_of(between, command));
    return 0;
}

}  // namespace patchlight
