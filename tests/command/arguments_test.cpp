#include "apps/patchlight/arguments.h"
#include "apps/patchlight/usage_error.h"

#include <gtest/gtest.h>

namespace patchlight {
namespace {

/// Command lines that mean nothing.
class RefusedArguments : public ::testing::TestWithParam<std::vector<std::string>> {};

Command parse(std::vector<std::string> words)
{
    words.insert(words.begin(), "patchlight");
    std::vector<const char*> argv;
    for (const std::string& word : words) {
        argv.push_back(word.c_str());
    }
    return parse_arguments(static_cast<int>(argv.size()), argv.data());
}

TEST_P(RefusedArguments, AreAUsageError)
{
    try {
        parse(GetParam());
        ADD_FAILURE() << "taken";
    } catch (const UsageError& error) {
        EXPECT_EQ(error.code(), "usage");
        EXPECT_GT(std::string(error.what()).size(), 10U);
    }
}

std::vector<std::string> solving(std::vector<std::string> words)
{
    words.insert(words.begin(), {"solve", "room.obj", "-o", "run"});
    return words;
}

INSTANTIATE_TEST_SUITE_P(Threads, RefusedArguments,
                         ::testing::Values(solving({"--threads", "0"}), solving({"--threads", "-1"}),
                                           solving({"--threads", "1e9"}), solving({"--threads", "abc"}),
                                           solving({"--threads", "1.5"}), solving({"--threads", ""}),
                                           solving({"--threads", "1000000000"})));

INSTANTIATE_TEST_SUITE_P(NotBuiltYet, RefusedArguments,
                         ::testing::Values(std::vector<std::string>{"compare", "a", "b", "-o", "c"},
                                           std::vector<std::string>{"verify", "a"},
                                           std::vector<std::string>{"formfactors", "a"},
                                           std::vector<std::string>{"report", "a", "-o", "b"},
                                           std::vector<std::string>{"study", "run", "a"},
                                           solving({"--refine", "both"}), solving({"--solver", "hierarchical"}),
                                           solving({"--form-factors", "exact"}), solving({"--mesh", "a"}),
                                           std::vector<std::string>{"export", "a", "--format", "vtu", "-o", "b"}));

INSTANTIATE_TEST_SUITE_P(
    Values, RefusedArguments,
    ::testing::Values(std::vector<std::string>{}, std::vector<std::string>{"--nonsense"},
                      std::vector<std::string>{"solve"}, std::vector<std::string>{"solve", "room.obj"},
                      solving({"more.obj"}), solving({"--size", "10"}), solving({"--size", "0x10"}),
                      solving({"--size", "10x9000"}), solving({"--size", "1e2x10"}), solving({"--max-elements", "0"}),
                      solving({"--max-elements", "1e4"}), solving({"--max-edge", "0"}), solving({"--max-edge", "nan"}),
                      solving({"--max-edge", "inf"}), solving({"--target-error", "2"}),
                      solving({"--target-error", "-0.1"}), solving({"--iterations", "0"}), solving({"--rays", "15"}),
                      solving({"--rays", "65537"}), solving({"--tolerance", "0"}), solving({"--snapshots", "3,1"}),
                      solving({"--snapshots", "1,,3"}), solving({"--snapshots", "1", "--pictures", "none"}),
                      solving({"--emitter", "lamp"}), solving({"--emitter", "lamp=-1"}),
                      solving({"--emitter", "lamp=1,2"}), solving({"--emitter", "lamp=nan"}),
                      solving({"--emitter", "lamp=1", "--emitter", "lamp=2"}), solving({"--unit", "parsec"}),
                      solving({"--max-reflectance", "1"}), solving({"--seed", "-1"}),
                      solving({"--crease-angle", "181"}), solving({"--marking", "all"}),
                      std::vector<std::string>{"render", "run", "-o", "a.jpg"},
                      std::vector<std::string>{"render", "run", "-o", "a.png", "--from", "1,2,3"},
                      std::vector<std::string>{"render", "run", "-o", "a.png", "--from", "1,2,3", "--to", "1,2,3"},
                      std::vector<std::string>{"render", "run", "-o", "a.png", "--cycle", "-1"},
                      std::vector<std::string>{"render", "run", "-o", "a.png", "--exposure", "bright"},
                      std::vector<std::string>{"render", "run", "-o", "a.png", "--fov", "0"}));


TEST(Arguments, OptionsArriveWhereTheyBelong)
{
    const auto command = std::get<SolveCommand>(parse(
        solving({"--refine", "none", "--max-elements", "3000", "--unit", "mm", "--emitter", "a=b=1,2,3", "--two-sided",
                 "all", "--two-sided", "leaf", "--rays", "64", "--seed", "7", "--size", "20x10", "--threads", "2"})));
    EXPECT_EQ(command.options.refine, Refine::none);
    EXPECT_EQ(command.options.meshing.max_elements, 3000U) << "the uniform mesh is made for the budget";
    EXPECT_EQ(command.options.meshing.max_edge, 0);
    EXPECT_EQ(command.scene.options.unit, 0.001);
    EXPECT_EQ(command.scene.options.emitters.at("a=b"), Rgb(1, 2, 3)) << "only the last = divides";
    EXPECT_TRUE(command.scene.options.all_two_sided);
    EXPECT_EQ(command.scene.options.two_sided, std::vector<std::string>{"leaf"});
    EXPECT_EQ(command.options.form_factors.rays, 64);
    EXPECT_EQ(command.options.form_factors.seed, 7U);
    EXPECT_EQ(command.options.gather.seed, 7U);
    EXPECT_EQ(command.pictures.size, std::pair(20, 10));
    EXPECT_EQ(command.threads, 2);
}

TEST(Arguments, MaxEdgeIsInTheUnitAndLeavesTheBudgetAlone)
{
    const auto uniform = std::get<SolveCommand>(parse(solving({"--refine", "none", "--max-edge", "50", "--unit", "cm"})));
    EXPECT_DOUBLE_EQ(uniform.options.meshing.max_edge, 0.5);
    EXPECT_EQ(uniform.options.meshing.max_elements, 0U);
    const auto adaptive = std::get<SolveCommand>(parse(solving({"--max-edge", "2", "--max-elements", "500"})));
    EXPECT_EQ(adaptive.options.meshing.max_elements, 0U);
    EXPECT_EQ(adaptive.options.max_elements, 500U);
    EXPECT_EQ(adaptive.options.refine, Refine::intensity);
}

TEST(Arguments, ALeadingDashIsAFileNameAfterTwo)
{
    EXPECT_EQ(std::get<InspectCommand>(parse({"inspect", "--", "-x.obj"})).scene.file, "-x.obj");
    EXPECT_EQ(std::get<RenderCommand>(parse({"render", "r", "-o", "a.png", "--from", "-1,2,3", "--to=-.5,0,0"})).from,
              Vec3(-1, 2, 3));
}

}  // namespace
}  // namespace patchlight
