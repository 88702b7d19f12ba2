#include "apps/patchlight/study_options.h"
#include "apps/patchlight/usage_error.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace patchlight {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

SolveCommand command_of(const std::vector<OptionText>& options, const std::string& scene = "room.obj")
{
    return solve_command_of(scene, "run", options, "some/study.toml");
}

std::string refusal_of(const std::vector<OptionText>& options)
{
    try {
        command_of(options);
        return "taken";
    } catch (const UsageError& error) {
        EXPECT_EQ(error.code(), "usage");
        return error.what();
    }
}

TEST(StudyOptions, AreNamedAsOnTheCommandLine)
{
    const OptionNames names = solve_option_names();
    for (const char* name : {"refine", "max-elements", "unit", "memory", "overshoot", "threads", "json", "seed"})
        EXPECT_THAT(names, Contains(name));
    for (const char* name : {"help", "config", "o", "scene"}) EXPECT_THAT(names, Not(Contains(name)));
}

TEST(StudyOptions, MeanWhatTheyMeanOnTheCommandLine)
{
    const SolveCommand c = command_of({{"refine", "none", {}},
                                       {"max-elements", "300", {}},
                                       {"emitter", "lamp=1,2,3\nsky=4", {}},
                                       {"two-sided", "all", {}},
                                       {"solver", "progressive", {}},
                                       {"overshoot", "true", {}},
                                       {"unit", "mm", {}},
                                       {"memory", "1GB", {}}},
                                      "-odd name.obj");
    EXPECT_EQ(c.scene.file, "-odd name.obj");
    EXPECT_EQ(c.run, "run");
    EXPECT_EQ(c.options.refine, Refine::none);
    EXPECT_EQ(c.options.meshing.max_elements, 300U) << "finish_solve() has seen it";
    EXPECT_EQ(c.scene.options.emitters.size(), 2U);
    EXPECT_TRUE(c.scene.options.all_two_sided);
    EXPECT_TRUE(c.options.final.overshoot);
    EXPECT_EQ(c.options.final.tolerance, 0.01) << "progressive's own default: nobody gave one";
    EXPECT_EQ(c.scene.options.unit, 0.001);
    EXPECT_EQ(c.memory, 1e9);
    EXPECT_FALSE(command_of({{"overshoot", "false", {}}}).options.final.overshoot);
    EXPECT_EQ(command_of({{"seed", "9000000000000000000", {}}}).options.form_factors.seed, 9'000'000'000'000'000'000U);
}

TEST(StudyOptions, PathsAreRelativeToTheFile)
{
    EXPECT_EQ(command_of({{"mesh", "box", {}}}).mesh_of, "some/box");
    EXPECT_EQ(command_of({{"mesh", "/runs/box", {}}}).mesh_of, "/runs/box");
    EXPECT_EQ(command_of({{"view", "a.view.json", {}}}).scene.view, "some/a.view.json");
    EXPECT_EQ(command_of({{"view", "front", {}}}).scene.view, "front") << "a name";
    EXPECT_EQ(command_of({{"for-view", "a.json", {}}}).for_view, "some/a.json");
}

TEST(StudyOptions, RefusalsBeginWithThePlace)
{
    EXPECT_THAT(refusal_of({{"seed", "1", {2, 1}}, {"rays", "3", {9, 4}}}),
                StartsWith("some/study.toml:9:4: --rays: \"3\" is not a whole number from 16 to 65536"));
    EXPECT_THAT(refusal_of({{"vertex-rays", "15", {3, 1}}, {"rays", "32", {9, 4}}}),
                StartsWith("some/study.toml:3:1: --vertex-rays: "))
        << "--rays is but a part of the name";
    EXPECT_THAT(refusal_of({{"refine", "lines", {4, 10}}}), StartsWith("some/study.toml:4:10: --refine: "));
    EXPECT_THAT(refusal_of({{"overshoot", "true", {5, 1}}}), StartsWith("some/study.toml:5:1: --overshoot is for"));
    EXPECT_THAT(refusal_of({{"overshoot", "perhaps", {5, 1}}}), HasSubstr("some/study.toml:5:1: "));
    EXPECT_THAT(refusal_of({{"mesh", "box", {6, 1}}, {"refine", "both", {7, 1}}}), HasSubstr("some/study.toml:"));
    EXPECT_THAT(refusal_of({{"max-elements", "1\n2", {8, 1}}}), StartsWith("some/study.toml:8:1: "));
    EXPECT_THAT(refusal_of({{"unit", "parsec", {1, 1}}}), StartsWith("some/study.toml:1:1: --unit"));
    EXPECT_THAT(refusal_of({{"memory", "8", {1, 2}}}), StartsWith("some/study.toml:1:2: --memory"));
    EXPECT_THAT(refusal_of({{"size", "9", {1, 3}}}), StartsWith("some/study.toml:1:3: --size"));
}

}  // namespace
}  // namespace patchlight
