#include "apps/patchlight/false_color_arguments.h"

#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/usage_error.h"

#include <fmt/format.h>

namespace patchlight {

namespace {

const ModeNames<Quantity>& light_names()
{
    static const ModeNames<Quantity> names{
        {"lux", Quantity::lux}, {"irradiance", Quantity::irradiance}, {"radiosity", Quantity::radiosity}};
    return names;
}

std::pair<double, double> range_in(const std::string& text)
{
    const auto colon = text.find(':');
    if (colon == std::string::npos) {
        throw UsageError("usage", fmt::format("--range: \"{}\" is not LOW:HIGH", text));
    }
    const double low = number_in("--range", text.substr(0, colon)), high = number_in("--range", text.substr(colon + 1));
    if (!(low < high)) {
        throw UsageError("usage", fmt::format("--range: {} is not below {}", low, high));
    }
    return {low, high};
}

void add_all(CLI::App& app, FalseColorArguments& a, FalseColorTexts& t, const std::string& usual_scale)
{
    app.add_option("--false-color", t.quantity,
                   "light as colours with a legend below: lux is 683 lm/W times the luminance of the irradiance "
                   "(B - E)/reflectance; irradiance and radiosity are in W/m2, bands weighed .2126, .7152, .0722 [off]")
        ->check(CLI::IsMember({"lux", "irradiance", "radiosity"}));
    app.add_option("--range", t.range, "values of the first and the last colour [what most of the picture has]")
        ->type_name("LOW:HIGH");
    app.add_option("--scale", t.scale, "of the colours: linear or log [" + usual_scale + "]")
        ->check(CLI::IsMember({"linear", "log"}));
    app.add_option("--isolines", a.isolines, "lines of equal value at round values, so many at most")
        ->check(whole_between(0, 100))
        ->type_name("N")
        ->capture_default_str();
}

}  // namespace

void add_false_color(CLI::App& app, FalseColorArguments& a, FalseColorTexts& t)
{
    add_all(app, a, t, "linear");
}

void add_false_color_and_show(CLI::App& app, FalseColorArguments& a, FalseColorTexts& t)
{
    app.add_option("--show", t.show,
                   "radiosity, the elements' estimated error of it in W/m2, or their size in m2; the latter as colours")
        ->check(CLI::IsMember({"radiosity", "error", "size"}))
        ->capture_default_str();
    add_all(app, a, t, "linear; error and size: log");
}

void finish_false_color(FalseColorArguments& a, const FalseColorTexts& t)
{
    if (!t.quantity.empty()) a.quantity = mode_of(light_names(), t.quantity);
    if (t.show != "radiosity") {
        if (a.quantity) throw UsageError("usage", "--false-color is for light, --show " + t.show + " is not");
        a.quantity = t.show == "error" ? Quantity::error : Quantity::size;
    }
    if (!a.quantity && (!t.range.empty() || !t.scale.empty() || a.isolines > 0)) {
        throw UsageError("usage", "--range, --scale and --isolines are for false colours");
    }
    const bool log = t.scale.empty() ? t.show != "radiosity" : t.scale == "log";
    a.scale = log ? ScaleKind::logarithmic : ScaleKind::linear;
    if (!t.range.empty()) {
        a.range = range_in(t.range);
        if (log && a.range->first <= 0) throw UsageError("usage", "--range: a logarithmic scale begins above 0");
    }
}

}  // namespace patchlight
