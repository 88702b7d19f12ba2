#include "apps/patchlight/compare_arguments.h"

#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/usage_error.h"

#include <fmt/format.h>

namespace patchlight {

namespace {

const ModeNames<Metric>& metric_names()
{
    static const ModeNames<Metric> names{{"flip", Metric::flip},
                                         {"flip-p95", Metric::flip_p95},
                                         {"flip-max", Metric::flip_max},
                                         {"rmse", Metric::rmse},
                                         {"l2", Metric::l2}};
    return names;
}

CompareLimit limit_in(const std::string& text)
{
    const auto equals = text.find('=');
    const std::string name = text.substr(0, equals);
    for (const auto& [known, metric] : metric_names()) {
        if (name != known || equals == std::string::npos) continue;
        const double value = number_in("--fail-above " + name, text.substr(equals + 1));
        if (value < 0) throw UsageError("usage", fmt::format("--fail-above: {} is never below 0", name));
        return {metric, name, value};
    }
    throw UsageError("usage", fmt::format("--fail-above: \"{}\" is not METRIC=VALUE with flip, flip-p95, flip-max, "
                                          "rmse or l2",
                                          text));
}

}  // namespace

void add_compare(CLI::App& app, CompareCommand& c, CompareTexts& t)
{
    app.add_option("a", c.a, "folder of a run; RUN@N, RUN@first: one of its cycles instead of the last")
        ->required()
        ->type_name("RUN_A");
    app.add_option("b", c.b, "the run to hold it to, of the same scene")->required()->type_name("RUN_B");
    app.add_option("-o", c.folder, "folder for pictures and compare.json: new, empty, or of an earlier comparison")
        ->required()
        ->type_name("DIR");
    app.add_option("--view", c.view, "a camera that both runs have [the first of A]")->type_name("NAME");
    app.add_option("--size", t.size, "of each picture [640 high, as wide as the camera says or 640]")->type_name("WxH");
    app.add_option("--exposure", t.exposure, "of both, in stops; auto: what shows A well")
        ->type_name("EV|auto")
        ->capture_default_str();
    app.add_option("--points", c.points,
                   "relative L2 error of A against B over so many points of the surfaces; 0: none")
        ->check(whole_between(0, 10'000'000))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--seed", c.seed, "of the points")
        ->check(whole_between(0, 9'000'000'000'000'000'000))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--fail-above", t.limits,
                   "exit code 7 when a metric is over its value: flip (its mean), flip-p95, flip-max, rmse, l2; may be "
                   "given again [none]")
        ->type_name("METRIC=VALUE")
        ->allow_extra_args(false);
    add_false_color(app, c.false_color, t.false_color);
    app.add_flag("--json", c.json, "print JSON instead of a table [off]");
    app.footer("Both are seen by the same camera, at one size and exposure. RMSE is of linear\n"
               "radiance B/pi, in W/(m2 sr), over pixels and bands. FLIP is LDR-FLIP at 67\n"
               "pixels per degree. L2 is relative to B's reflected light over all surface that\n"
               "reflects.");
}

void finish_compare(CompareCommand& c, const CompareTexts& t)
{
    if (!t.size.empty()) c.size = size_in("--size", t.size);
    if (t.exposure != "auto") c.exposure = number_in("--exposure", t.exposure);
    for (const std::string& text : t.limits) c.limits.push_back(limit_in(text));
    for (const CompareLimit& limit : c.limits) {
        if (limit.metric == Metric::l2 && c.points == 0) {
            throw UsageError("usage", "--fail-above l2 needs --points");
        }
    }
    finish_false_color(c.false_color, t.false_color);
}

}  // namespace patchlight
