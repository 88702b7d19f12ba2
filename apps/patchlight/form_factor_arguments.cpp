#include "apps/patchlight/form_factor_arguments.h"

#include "apps/patchlight/argument_values.h"
#include "apps/patchlight/usage_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace patchlight {

namespace {

using Method = FormFactorMethod;
using Methods = std::vector<Method>;

const Methods matrix_methods{Method::closed_form, Method::hemicube, Method::hemisphere, Method::quadrature,
                             Method::exact};
constexpr int default_resolution_of_pairs = PairOptions{}.resolution;

void add_pair_options(CLI::App& app, FormFactorsCommand& c, FormFactorTexts& t)
{
    t.between_option =
        app.add_option("--between", t.between,
                       "one factor, from object A to object B of the scene's file (their faces together, weighted by "
                       "area), instead of all patches [all patches]")
            ->type_name("A B");
    CLI::Option* origins = app.add_option("--origins", c.pair.origins, "hemicube, --between: half cubes over A")
                               ->check(whole_between(1, 65536))
                               ->type_name("N")
                               ->capture_default_str();
    CLI::Option* relative =
        app.add_option("--relative-error", c.pair.relative_error,
                       "monte-carlo: goes on until its standard error is below this part of the factor")
            ->check(number_between(1e-5, 0.5))
            ->type_name("FRACTION")
            ->capture_default_str();
    t.bound.push_back({origins, {Method::hemicube}, {}});
    t.bound.push_back({relative, {Method::monte_carlo}, {}});
}

void add_method_options(CLI::App& app, FormFactorTexts& t)
{
    app.add_option("--method", t.method,
                   "how factors are found; closed-form looks through what stands between; monte-carlo is for --between")
        ->check(CLI::IsMember(words(form_factor_method_names())))
        ->capture_default_str();
    CLI::Option* resolution =
        app.add_option("--resolution", t.resolution,
                       fmt::format("hemicube: pixels along an edge, even [{} with --between, else {}]",
                                   default_resolution_of_pairs, FormFactorOptions{}.resolution))
            ->check(whole_between(4, 4096))
            ->type_name("N");
    CLI::Option* rays = app.add_option("--rays", t.rays,
                                       fmt::format("hemisphere: per patch, or in all with --between [{} with "
                                                   "--between, else {}]",
                                                   PairOptions{}.rays, FormFactorOptions{}.rays))
                            ->check(whole_between(16, 1LL << 40))
                            ->type_name("N");
    CLI::Option* directions = app.add_option("--directions", t.directions, "hemisphere, all patches: set of directions")
                                  ->check(CLI::IsMember(words(direction_names())))
                                  ->capture_default_str();
    CLI::Option* tolerance =
        app.add_option("--tolerance", t.tolerance,
                       "exact, quadrature, closed-form with --between: error of a factor; of a quadrature row "
                       "[with --between 1e-10, quadrature 1e-4; else exact 2e-5, quadrature 1e-3]")
            ->check(number_between(1e-14, 0.01))
            ->type_name("T");
    t.bound.push_back({resolution, {Method::hemicube}, {Method::hemicube}});
    t.bound.push_back({rays, {Method::hemisphere}, {Method::hemisphere}});
    t.bound.push_back({directions, {}, {Method::hemisphere}});
    t.bound.push_back(
        {tolerance, {Method::closed_form, Method::quadrature, Method::exact}, {Method::quadrature, Method::exact}});
}

void add_matrix_options(CLI::App& app, FormFactorsCommand& c, FormFactorTexts& t)
{
    t.max_elements_option = app.add_option("--max-elements", t.max_elements, "patches of the uniform mesh at most")
                                ->check(whole_between(1, 1'000'000'000))
                                ->type_name("N")
                                ->capture_default_str();
    CLI::Option* max_edge =
        app.add_option("--max-edge", t.max_edge,
                       "longest edge of a patch, in --unit, in place of --max-elements [what that allows]")
            ->check(number_above(0))
            ->excludes(t.max_elements_option)
            ->type_name("LENGTH");
    const std::vector<CLI::Option*> all{
        t.max_elements_option,
        max_edge,
        app.add_option("-o", c.output, "file for the factors, .csv or .bin (see below) [none]")->type_name("FILE"),
        app.add_option("--patches", c.patches, "CSV file for what the rows are: surface, object, area, place [none]")
            ->type_name("FILE"),
        app.add_option("--repair", t.repair,
                       "symmetric: make the matrix reciprocal, and closed in a closed scene, and say what changed")
            ->check(CLI::IsMember({"none", "symmetric"}))
            ->capture_default_str(),
        app.add_option("--memory", t.memory, memory_help)->type_name("SIZE")};
    for (CLI::Option* option : all) {
        t.bound.push_back({option, {}, matrix_methods});
    }
}

std::string listed(const Methods& methods)
{
    std::vector<std::string> names;
    for (const Method method : methods) {
        names.push_back(name_of(form_factor_method_names(), method));
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

void check_bound_options(const FormFactorsCommand& c, const FormFactorTexts& t)
{
    for (const MethodOption& bound : t.bound) {
        if (bound.option->count() == 0) {
            continue;
        }
        const Methods& good = c.between ? bound.between : bound.matrix;
        const std::string name = bound.option->get_name();
        if (good.empty()) {
            throw UsageError("usage", fmt::format("{} {} --between", name,
                                                  c.between ? "is for the whole matrix, without" : "belongs to"));
        }
        if (std::ranges::find(good, c.method) == good.end()) {
            throw UsageError("usage", fmt::format("{} is not for --method {}, but for {}", name,
                                                  name_of(form_factor_method_names(), c.method), listed(good)));
        }
    }
}

void finish_pair(FormFactorsCommand& c, const FormFactorTexts& t)
{
    c.pair.method = c.method;
    c.pair.tolerance = t.tolerance;
    if (t.rays > 0) {
        c.pair.rays = t.rays;
    }
    if (t.resolution > 0) {
        c.pair.resolution = t.resolution;
    }
}

void finish_matrix(FormFactorsCommand& c, const FormFactorTexts& t)
{
    if (c.method == Method::monte_carlo) {
        throw UsageError("usage", "--method monte-carlo checks single pairs, a matrix of them would take days: give "
                                  "--between A B, or take exact or hemisphere for all patches");
    }
    c.matrix.method = c.method;
    c.matrix.tolerance = t.tolerance;
    c.matrix.directions = mode_of(direction_names(), t.directions);
    c.matrix.seed = c.pair.seed;
    if (t.rays > 65536) {
        throw UsageError("usage", "--rays: at most 65536 a patch");
    }
    if (t.rays > 0) {
        c.matrix.rays = static_cast<int>(t.rays);
    }
    if (t.resolution > 0) {
        c.matrix.resolution = t.resolution;
    }
    c.meshing.max_edge = t.max_edge * c.scene.options.unit;
    c.meshing.max_elements = t.max_edge > 0 ? 0 : t.max_elements;
    c.repair = t.repair == "symmetric";
    if (!t.memory.empty()) {
        c.memory = bytes_in("--memory", t.memory);
    }
    if (!c.output.empty() && !c.output.ends_with(".csv") && !c.output.ends_with(".bin")) {
        throw UsageError("usage", "-o: \"" + c.output + "\" ends neither in .csv nor in .bin");
    }
    if (!c.output.empty() && c.output == c.patches) {
        throw UsageError("usage", "-o and --patches name the same file");
    }
}

}  // namespace

void add_form_factors(CLI::App& app, FormFactorsCommand& c, FormFactorTexts& t)
{
    add_scene(app, c.scene, t.scene);
    add_pair_options(app, c, t);
    add_method_options(app, t);
    add_matrix_options(app, c, t);
    app.add_option("--seed", c.pair.seed, "of all random numbers")
        ->check(whole_between(0, 9'000'000'000'000'000'000))
        ->type_name("N")
        ->capture_default_str();
    add_machine(app, c.threads, c.quiet, c.json, "print JSON instead of a summary");
    app.footer("F is the fraction of the power leaving a row's patch that reaches a column's.\n"
               "FILE.csv: row,column,factor, patches counted from 0.\n"
               "FILE.bin, little-endian: \"PLFFCSR1\", uint64 n, uint64 entries,\n"
               "uint64 row_start[n+1], uint32 columns[entries], float64 factors[entries],\n"
               "float64 area[n] in m2.");
}

void finish_form_factors(FormFactorsCommand& c, const FormFactorTexts& t)
{
    finish_scene(c.scene, t.scene);
    c.scene.options.require_emitter = false;
    c.scene.options.join_objects = false;
    c.method = mode_of(form_factor_method_names(), t.method);
    if (t.between_option->count() > 0) {
        c.between = t.between;
    }
    check_bound_options(c, t);
    if (t.resolution % 2 != 0) {
        throw UsageError("usage", fmt::format("--resolution: {} is odd", t.resolution));
    }
    if (c.between) {
        finish_pair(c, t);
    } else {
        finish_matrix(c, t);
    }
}

void add_validate(CLI::App& app, ValidateCommand& c, std::string& method)
{
    app.add_option("--method", method, "only this one [all]")->check(CLI::IsMember(words(form_factor_method_names())));
    app.add_option("--seed", c.seed, "of all random numbers")
        ->check(whole_between(0, 9'000'000'000'000'000'000))
        ->type_name("N")
        ->capture_default_str();
    add_machine(app, c.threads, c.quiet, c.json, "print JSON instead of a table");
    app.footer("Exit code 4 when a bound is missed.");
}

void finish_validate(ValidateCommand& c, const std::string& method)
{
    if (!method.empty()) {
        c.method = mode_of(form_factor_method_names(), method);
    }
}

}  // namespace patchlight
