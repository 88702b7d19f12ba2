#include "apps/run/run_options.h"

namespace patchlight {

const ModeNames<Refine>& refine_names()
{
    static const ModeNames<Refine> names{{"none", Refine::none},
                                         {"intensity", Refine::intensity},
                                         {"discontinuity", Refine::discontinuity},
                                         {"both", Refine::both}};
    return names;
}

const ModeNames<Direct>& direct_names()
{
    static const ModeNames<Direct> names{{"exact", Direct::exact}, {"sampled", Direct::sampled}};
    return names;
}

const ModeNames<Elements>& element_names()
{
    static const ModeNames<Elements> names{{"linear", Elements::linear}, {"quadratic", Elements::quadratic}};
    return names;
}

const ModeNames<Solver>& solver_names()
{
    static const ModeNames<Solver> names{{"progressive", Solver::progressive},
                                         {"jacobi", Solver::jacobi},
                                         {"gauss-seidel", Solver::gauss_seidel},
                                         {"conjugate-gradient", Solver::conjugate_gradient},
                                         {"bicgstab", Solver::bicgstab},
                                         {"hierarchical", Solver::hierarchical}};
    return names;
}

const ModeNames<FormFactorMethod>& form_factor_names()
{
    static const ModeNames<FormFactorMethod> names{{"hemicube", FormFactorMethod::hemicube},
                                                   {"hemisphere", FormFactorMethod::hemisphere},
                                                   {"quadrature", FormFactorMethod::quadrature},
                                                   {"exact", FormFactorMethod::exact}};
    return names;
}

const ModeNames<FormFactorMethod>& form_factor_method_names()
{
    static const ModeNames<FormFactorMethod> names{{"closed-form", FormFactorMethod::closed_form},
                                                   {"hemicube", FormFactorMethod::hemicube},
                                                   {"hemisphere", FormFactorMethod::hemisphere},
                                                   {"quadrature", FormFactorMethod::quadrature},
                                                   {"exact", FormFactorMethod::exact},
                                                   {"monte-carlo", FormFactorMethod::monte_carlo}};
    return names;
}

const ModeNames<Indicator>& indicator_names()
{
    static const ModeNames<Indicator> names{{"residual", Indicator::residual},
                                            {"vertex-difference", Indicator::vertex_difference}};
    return names;
}

const ModeNames<Marking>& marking_names()
{
    static const ModeNames<Marking> names{{"doerfler", Marking::doerfler}, {"fixed-fraction", Marking::fixed_fraction}};
    return names;
}

const ModeNames<HemisphereDirections>& direction_names()
{
    static const ModeNames<HemisphereDirections> names{{"stratified", HemisphereDirections::stratified},
                                                       {"regular-grid", HemisphereDirections::regular_grid},
                                                       {"lecture-grid", HemisphereDirections::lecture_grid}};
    return names;
}

const ModeNames<ShootingOrder>& order_names()
{
    static const ModeNames<ShootingOrder> names{{"unshot-power", ShootingOrder::unshot_power},
                                                {"unshot-radiosity", ShootingOrder::unshot_radiosity}};
    return names;
}

const ModeNames<Stage>& stage_names()
{
    static const ModeNames<Stage> names{
        {"uniform", Stage::uniform}, {"rough", Stage::rough}, {"adaptive", Stage::adaptive}, {"final", Stage::final}};
    return names;
}

Json json_of(const Rgb& value)
{
    return Json::array({value.r, value.g, value.b});
}

Json json_of(const View& view)
{
    return {{"name", view.name},
            {"from", json_of(view.from)},
            {"forward", json_of(view.forward)},
            {"up", json_of(view.up)},
            {"vertical_fov", view.vertical_fov}};
}

namespace {

Json json_of(const SolveOptions& options)
{
    return {{"solver", name_of(solver_names(), options.solver)},
            {"tolerance", options.tolerance},
            {"max_sweeps", options.max_sweeps},
            {"order", name_of(order_names(), options.order)},
            {"ambient", options.ambient},
            {"overshoot", options.overshoot}};
}

}  // namespace

Json json_of(const AdaptiveOptions& o)
{
    return {{"refine", name_of(refine_names(), o.refine)},
            {"elements", name_of(element_names(), o.elements)},
            {"direct", name_of(direct_names(), o.direct)},
            {"iterations", o.iterations},
            {"target_error", o.target_error},
            {"max_elements", o.max_elements},
            {"meshing",
             {{"max_edge", o.meshing.max_edge},
              {"min_angle", o.meshing.min_angle},
              {"max_elements", o.meshing.max_elements}}},
            {"form_factors",
             {{"method", name_of(form_factor_names(), o.form_factors.method)},
              {"directions", name_of(direction_names(), o.form_factors.directions)},
              {"rays", o.form_factors.rays},
              {"resolution", o.form_factors.resolution},
              {"shadow_rays", o.form_factors.shadow_rays},
              {"small_source", o.form_factors.small_source},
              {"seed", o.form_factors.seed}}},
            {"final", json_of(o.final)},
            {"gather",
             {{"rays", o.gather.rays},
              {"shadow_rays", o.gather.shadow_rays},
              {"small_source", o.gather.small_source},
              {"crease_angle", o.gather.crease_angle},
              {"seed", o.gather.seed}}},
            {"estimate", {{"indicator", name_of(indicator_names(), o.estimate.indicator)}, {"rays", o.estimate.rays}}},
            {"mark",
             {{"marking", name_of(marking_names(), o.mark.marking)},
              {"share", o.mark.share},
              {"least", o.mark.least},
              {"smallest", o.mark.smallest},
              {"local", o.mark.local}}},
            {"lines",
             {{"least_saving", o.lines.least_saving},
              {"secondary_share", o.lines.secondary_share},
              {"most_secondary", o.lines.most_secondary}}}};
}

Json json_of(const SceneOptions& o)
{
    Json emitters = Json::object();
    for (const auto& [name, value] : o.emitters) {
        emitters[name] = json_of(value);
    }
    return {{"unit", o.unit},           {"max_reflectance", o.max_reflectance},
            {"snap", o.snap},           {"all_two_sided", o.all_two_sided},
            {"two_sided", o.two_sided}, {"emitters", emitters}};
}

}  // namespace patchlight
