#include "apps/run/run_options.h"
#include "meshing/scene_error.h"

#include <gtest/gtest.h>

namespace patchlight {
namespace {

/// Every option another than its default.
AdaptiveOptions others()
{
    AdaptiveOptions o;
    o.meshing = {.max_edge = 0.3, .min_angle = 11, .max_elements = 77};
    o.form_factors = {.method = FormFactorMethod::exact,
                      .directions = HemisphereDirections::lecture_grid,
                      .rays = 99,
                      .shadow_rays = 17,
                      .small_source = 0.1,
                      .resolution = 64,
                      .tolerance = 1e-3,
                      .seed = 9'000'000'000'000'000'000};
    o.final = {.solver = Solver::progressive,
               .tolerance = 0.1,
               .max_sweeps = 3,
               .order = ShootingOrder::unshot_radiosity,
               .ambient = true,
               .overshoot = true};
    o.gather = {.rays = 33, .shadow_rays = 34, .small_source = 1.0 / 3, .crease_angle = 45, .seed = 5};
    o.estimate = {.indicator = Indicator::vertex_difference, .rays = 31};
    o.mark = {.marking = Marking::fixed_fraction, .share = 0.3, .least = 0.01, .smallest = 1e-9, .local = 0.7};
    o.lines = {.least_saving = 5, .secondary_share = 0.9, .most_secondary = 2};
    o.refine = Refine::none;
    o.elements = Elements::quadratic;
    o.direct = Direct::sampled;
    o.iterations = 2;
    o.target_error = 0.01;
    o.max_elements = 1234;
    return o;
}

TEST(OptionsInJson, EveryOneComesBack)
{
    const Json written = json_of(others()), defaults = json_of(AdaptiveOptions{});
    const Json flat = written.flatten(), plain = defaults.flatten();
    ASSERT_EQ(flat.size(), plain.size());
    for (const auto& [name, value] : flat.items()) EXPECT_NE(value, plain.at(name)) << name << " isn't tried here";
    EXPECT_EQ(json_of(adaptive_options_in(Json::parse(written.dump()))), written);
    EXPECT_EQ(json_of(adaptive_options_in(Json::parse(defaults.dump()))), defaults);
    const AdaptiveOptions back = adaptive_options_in(written);
    EXPECT_EQ(back.gather.small_source, 1.0 / 3) << "to the bit";
    EXPECT_EQ(back.form_factors.seed, 9'000'000'000'000'000'000U);
}

TEST(OptionsInJson, WhatIsMissingOrOfAnotherKindIsBroken)
{
    const Json whole = json_of(AdaptiveOptions{});
    for (const auto& [name, value] : whole.items()) {
        Json less = whole;
        less.erase(name);
        EXPECT_THROW(adaptive_options_in(less), SceneError) << name;
        Json other = whole;
        other[name] = nullptr;
        EXPECT_THROW(adaptive_options_in(other), SceneError) << name;
    }
    Json odd = whole;
    odd["refine"] = "sometimes";
    EXPECT_THROW(adaptive_options_in(odd), SceneError);
    odd = whole;
    odd["iterations"] = 2.5;
    EXPECT_THROW(adaptive_options_in(odd), SceneError);
    odd = whole;
    odd["max_elements"] = -1;
    EXPECT_THROW(adaptive_options_in(odd), SceneError);
    EXPECT_THROW(adaptive_options_in(Json()), SceneError);
}

TEST(OptionsInJson, ScenesAndCamerasComeBack)
{
    SceneOptions o;
    o.unit = 0.001;
    o.max_reflectance = 0.9;
    o.snap = 1e-7;
    o.all_two_sided = true;
    o.two_sided = {"leaf", "a \"b\""};
    o.emitters["lamp"] = Rgb(1, 2, 1.0 / 3);
    EXPECT_EQ(json_of(scene_options_in(Json::parse(json_of(o).dump()))), json_of(o));
    const View view{"v", Vec3(1, 2, 3), Vec3(0, 1, 0), Vec3(0, 0, 1), 33, 0};
    EXPECT_EQ(json_of(view_in(json_of(view))), json_of(view));
    EXPECT_THROW(view_in(Json::object()), SceneError);
}

}  // namespace
}  // namespace patchlight
