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
    static const ModeNames<Solver> names{
        {"progressive", Solver::progressive},   {"jacobi", Solver::jacobi},
        {"gauss-seidel", Solver::gauss_seidel}, {"conjugate-gradient", Solver::conjugate_gradient},
        {"bicgstab", Solver::bicgstab},         {"hierarchical", Solver::hierarchical}};
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

}  // namespace patchlight
