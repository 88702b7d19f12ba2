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
                         ::testing::Values(std::vector<std::string>{"study", "submit", "a"},
                                           solving({"--refine", "quadratic"}),
                                           solving({"--form-factors", "monte-carlo"}),
                                           solving({"--form-factors", "closed-form"}), solving({"--overshoot"}),
                                           solving({"--resolution", "127"})));

INSTANTIATE_TEST_SUITE_P(
    Values, RefusedArguments,
    ::testing::Values(std::vector<std::string>{}, std::vector<std::string>{"--nonsense"},
                      std::vector<std::string>{"solve"}, std::vector<std::string>{"solve", "room.obj"},
                      solving({"more.obj"}), solving({"--size", "10"}), solving({"--size", "0x10"}),
                      solving({"--size", "10x9000"}), solving({"--size", "1e2x10"}), solving({"--max-elements", "0"}),
                      solving({"--max-elements", "1e4"}), solving({"--max-edge", "0"}), solving({"--max-edge", "nan"}),
                      solving({"--max-edge", "inf"}), solving({"--target-error", "2"}),
                      solving({"--target-error", "-0.1"}), solving({"--iterations", "0"}), solving({"--rays", "15"}),
                      solving({"--rays", "65537"}), solving({"--vertex-rays", "15"}), solving({"--tolerance", "0"}),
                      solving({"--snapshots", "3,1"}), solving({"--snapshots", "1,,3"}),
                      solving({"--snapshots", "1", "--pictures", "none"}), solving({"--emitter", "lamp"}),
                      solving({"--emitter", "lamp=-1"}), solving({"--emitter", "lamp=1,2"}),
                      solving({"--emitter", "lamp=nan"}), solving({"--emitter", "lamp=1", "--emitter", "lamp=2"}),
                      solving({"--unit", "parsec"}), solving({"--max-reflectance", "1"}), solving({"--seed", "-1"}),
                      solving({"--memory", "8"}), solving({"--memory", "-1GB"}), solving({"--memory", "0MiB"}),
                      solving({"--time", "0"}), solving({"--time", "-5s"}), solving({"--time", "soon"}),
                      solving({"--time", "1e10"}), solving({"--time", "nan"}), solving({"--time", "5d"}),
                      solving({"--crease-angle", "181"}), solving({"--marking", "all"}), solving({"--direct", "none"}),
                      solving({"--direct", "exactly"}), solving({"--refine", "lines"}), solving({"--refine", ""}),
                      std::vector<std::string>{"render", "run", "-o", "a.jpg"},
                      std::vector<std::string>{"render", "run", "-o", "a.png", "--from", "1,2,3"},
                      std::vector<std::string>{"render", "run", "-o", "a.png", "--from", "1,2,3", "--to", "1,2,3"},
                      std::vector<std::string>{"render", "run", "-o", "a.png", "--cycle", "-1"},
                      std::vector<std::string>{"render", "run", "-o", "a.png", "--exposure", "bright"},
                      std::vector<std::string>{"render", "run", "-o", "a.png", "--fov", "0"}));

std::vector<std::string> comparing(std::vector<std::string> words)
{
    words.insert(words.begin(), {"compare", "a", "b", "-o", "c"});
    return words;
}

INSTANTIATE_TEST_SUITE_P(
    Compare, RefusedArguments,
    ::testing::Values(std::vector<std::string>{"compare"}, std::vector<std::string>{"compare", "a", "-o", "c"},
                      std::vector<std::string>{"compare", "a", "b"}, comparing({"d"}), comparing({"--size", "10"}),
                      comparing({"--exposure", "bright"}), comparing({"--points", "-1"}),
                      comparing({"--fail-above", "flip"}), comparing({"--fail-above", "ssim=1"}),
                      comparing({"--fail-above", "flip=nan"}), comparing({"--fail-above", "flip=-1"}),
                      comparing({"--fail-above", "l2=0.1"}), comparing({"--range", "0:1"}),
                      comparing({"--false-color", "lux", "--range", "1:1"}),
                      comparing({"--false-color", "lux", "--range", "1"}),
                      comparing({"--false-color", "lux", "--range", "0:1", "--scale", "log"}),
                      comparing({"--false-color", "lumen"}), comparing({"--show", "error"})));

std::vector<std::string> rendering(std::vector<std::string> words)
{
    words.insert(words.begin(), {"render", "a", "-o", "b.png"});
    return words;
}

INSTANTIATE_TEST_SUITE_P(
    FalseColor, RefusedArguments,
    ::testing::Values(rendering({"--show", "flux"}), rendering({"--show", "error", "--false-color", "lux"}),
                      rendering({"--isolines", "4"}), rendering({"--scale", "log"}),
                      rendering({"--false-color", "lux", "--isolines", "-1"}),
                      rendering({"--false-color", "lux", "--exposure", "1"}),
                      std::vector<std::string>{"render", "a", "-o", "b.exr", "--false-color", "lux"}));

std::vector<std::string> animating(std::vector<std::string> words)
{
    words.insert(words.begin(), {"animate", "a", "-o", "b.png"});
    return words;
}

INSTANTIATE_TEST_SUITE_P(
    Animate, RefusedArguments,
    ::testing::Values(std::vector<std::string>{"animate", "a"}, std::vector<std::string>{"animate", "a", "-o", "b.gif"},
                      animating({"--what", "frames"}), animating({"--what", "path"}), animating({"--path", "a.json"}),
                      animating({"--frames", "10"}), animating({"--what", "path", "--path", "p", "--frames", "1"}),
                      animating({"--what", "path", "--path", "p", "--frames", "1001"}),
                      animating({"--what", "path", "--path", "p", "--view", "front"}),
                      animating({"--what", "shots", "--size", "9x9"}), animating({"--what", "shots", "--wireframe"}),
                      animating({"--delay", "0"}), animating({"--delay", "65536"})));

INSTANTIATE_TEST_SUITE_P(Verify, RefusedArguments,
                         ::testing::Values(std::vector<std::string>{"verify"},
                                           std::vector<std::string>{"verify", "a", "--points", "0"},
                                           std::vector<std::string>{"verify", "a", "--points", "1e3"},
                                           std::vector<std::string>{"verify", "a", "--paths", "7"},
                                           std::vector<std::string>{"verify", "a", "--cycle", "-1"},
                                           std::vector<std::string>{"verify", "a", "--cycle", "middle"},
                                           std::vector<std::string>{"verify", "a", "--seed", "-1"},
                                           std::vector<std::string>{"verify", "a", "--threads", "0"},
                                           std::vector<std::string>{"verify", "a", "b"}));

INSTANTIATE_TEST_SUITE_P(Rerun, RefusedArguments,
                         ::testing::Values(std::vector<std::string>{"rerun"}, std::vector<std::string>{"rerun", "a"},
                                           std::vector<std::string>{"rerun", "a", "-o", "b", "--memory", "much"},
                                           std::vector<std::string>{"rerun", "a", "-o", "b", "--max-elements", "9"},
                                           solving({"--keep-factors"}),
                                           solving({"--keep-factors", "--refine", "both"})));

std::vector<std::string> exporting(std::vector<std::string> words)
{
    words.insert(words.begin(), {"export", "run"});
    return words;
}

INSTANTIATE_TEST_SUITE_P(
    Export, RefusedArguments,
    ::testing::Values(exporting({}), exporting({"--format", "vtu"}), exporting({"--format", "stl", "-o", "a"}),
                      exporting({"--format", "pvd", "-o", "a.pvd", "--cycle", "last"}),
                      exporting({"--format", "vtu", "-o", "a.vtu", "--cycle", "all"}),
                      exporting({"--format", "vtu", "-o", "a.vtu", "--size", "64"}),
                      exporting({"--format", "ply", "-o", "a.ply", "--texels-per-metre", "64"}),
                      exporting({"--format", "csv", "-o", "a.csv", "--quantity", "irradiance"}),
                      exporting({"--format", "lightmap", "-o", "a.glb"}),
                      exporting({"--format", "lightmap", "-o", "a.exr", "--size", "15"}),
                      exporting({"--format", "lightmap", "-o", "a.exr", "--size", "8193"}),
                      exporting({"--format", "lightmap", "-o", "a.exr", "--texels-per-metre", "0"}),
                      exporting({"--format", "lightmap", "-o", "a.exr", "--quantity", "B"})));

std::vector<std::string> factors(std::vector<std::string> words)
{
    words.insert(words.begin(), {"formfactors", "room.obj"});
    return words;
}

INSTANTIATE_TEST_SUITE_P(
    FormFactors, RefusedArguments,
    ::testing::Values(std::vector<std::string>{"formfactors"}, factors({"--between", "a"}),
                      factors({"--method", "rays"}), factors({"--method", "monte-carlo"}), factors({"--origins", "4"}),
                      factors({"--between", "a", "b", "--origins", "4"}),
                      factors({"--between", "a", "b", "--method", "hemicube", "--resolution", "7"}),
                      factors({"--between", "a", "b", "--method", "hemicube", "--rays", "100"}),
                      factors({"--between", "a", "b", "--tolerance", "0"}),
                      factors({"--between", "a", "b", "--relative-error", "0.01"}),
                      factors({"--between", "a", "b", "-o", "f.csv"}),
                      factors({"--between", "a", "b", "--max-elements", "4"}),
                      factors({"--between", "a", "b", "--repair", "symmetric"}),
                      factors({"--method", "hemisphere", "--rays", "65537"}), factors({"--rays", "64"}),
                      factors({"--method", "hemisphere", "--tolerance", "1e-3"}), factors({"-o", "f.txt"}),
                      factors({"-o", "f.csv", "--patches", "f.csv"}), factors({"--memory", "8"}),
                      factors({"--memory", "-1GB"}), factors({"--memory", "GiB"}), factors({"--memory", "1e9"}),
                      factors({"--max-edge", "1", "--max-elements", "100"}), factors({"--repair", "rows"}),
                      factors({"--pictures", "none"}), std::vector<std::string>{"validate", "room.obj"},
                      std::vector<std::string>{"validate", "--method", "all"}));

TEST(Arguments, OptionsArriveWhereTheyBelong)
{
    const auto command = std::get<SolveCommand>(
        parse(solving({"--refine",    "none",  "--max-elements", "3000", "--unit", "mm", "--emitter", "a=b=1,2,3",
                       "--two-sided", "all",   "--two-sided",    "leaf", "--rays", "64", "--seed",    "7",
                       "--size",      "20x10", "--threads",      "2"})));
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
    const auto uniform =
        std::get<SolveCommand>(parse(solving({"--refine", "none", "--max-edge", "50", "--unit", "cm"})));
    EXPECT_DOUBLE_EQ(uniform.options.meshing.max_edge, 0.5);
    EXPECT_EQ(uniform.options.meshing.max_elements, 0U);
    const auto adaptive = std::get<SolveCommand>(parse(solving({"--max-edge", "2", "--max-elements", "500"})));
    EXPECT_EQ(adaptive.options.meshing.max_elements, 0U);
    EXPECT_EQ(adaptive.options.max_elements, 500U);
    EXPECT_EQ(adaptive.options.refine, Refine::both);
    const auto lined = std::get<SolveCommand>(parse(solving({"--refine", "discontinuity", "--max-elements", "500"})));
    EXPECT_EQ(lined.options.meshing.max_elements, 500U) << "uniform but for the lines";
}

TEST(Arguments, RefinementAndDirectLightCanBeChosen)
{
    const auto options = [](std::vector<std::string> words) {
        return std::get<SolveCommand>(parse(solving(std::move(words)))).options;
    };
    EXPECT_EQ(options({}).refine, Refine::both);
    EXPECT_EQ(options({}).direct, Direct::exact);
    EXPECT_EQ(options({"--refine", "both"}).refine, Refine::both);
    EXPECT_EQ(options({"--refine", "intensity"}).refine, Refine::intensity);
    EXPECT_EQ(options({"--refine", "discontinuity"}).refine, Refine::discontinuity);
    EXPECT_EQ(options({"--direct", "exact"}).direct, Direct::exact);
    EXPECT_EQ(options({"--direct", "sampled"}).direct, Direct::sampled);
}

TEST(Arguments, SolversAndMemoryArrive)
{
    const auto command = [](std::vector<std::string> words) {
        return std::get<SolveCommand>(parse(solving(std::move(words))));
    };
    EXPECT_EQ(command({}).options.final.solver, Solver::gauss_seidel);
    EXPECT_EQ(command({"--solver", "conjugate-gradient"}).options.final.solver, Solver::conjugate_gradient);
    EXPECT_EQ(command({"--solver", "bicgstab"}).options.final.solver, Solver::bicgstab);
    EXPECT_TRUE(command({"--solver", "progressive", "--overshoot"}).options.final.overshoot);
    EXPECT_EQ(command({"--solver", "progressive", "--form-factors", "exact"}).options.final.tolerance, 0.01);
    EXPECT_EQ(command({}).memory, 0) << "what the machine has";
    EXPECT_EQ(command({"--memory", "4G"}).memory, 0x1p32);
    EXPECT_EQ(command({"--memory", "512MiB"}).memory, 0x1p29);
    EXPECT_EQ(command({"--memory", "1.5GB"}).memory, 1.5e9);
    EXPECT_EQ(command({}).time, 0) << "no limit";
    EXPECT_EQ(command({"--time", "90"}).time, 90);
    EXPECT_EQ(command({"--time", "0.5s"}).time, 0.5);
    EXPECT_EQ(command({"--time", "10min"}).time, 600);
    EXPECT_EQ(command({"--time", "2h"}).time, 7200);
}

TEST(Arguments, FormFactorsBetweenObjectsAndOfAllPatchesHaveTheirOwnDefaults)
{
    const auto pair = std::get<FormFactorsCommand>(parse(factors({"--between", "-a", "b c", "--seed", "9"})));
    EXPECT_EQ(pair.between, std::pair(std::string("-a"), std::string("b c")));
    EXPECT_EQ(pair.method, FormFactorMethod::exact);
    EXPECT_EQ(pair.pair.method, FormFactorMethod::exact);
    EXPECT_EQ(pair.pair.seed, 9U);
    EXPECT_FALSE(pair.scene.options.require_emitter);
    EXPECT_FALSE(pair.scene.options.join_objects);

    const auto cubes = std::get<FormFactorsCommand>(
        parse(factors({"--between", "a", "b", "--method", "hemicube", "--origins", "4", "--resolution", "64"})));
    EXPECT_EQ(cubes.pair.origins, 4);
    EXPECT_EQ(cubes.pair.resolution, 64);

    const auto all =
        std::get<FormFactorsCommand>(parse(factors({"--method", "hemisphere", "--rays", "64", "--seed", "9", "--memory",
                                                    "2GiB", "--repair", "symmetric", "-o", "f.bin"})));
    EXPECT_FALSE(all.between);
    EXPECT_EQ(all.matrix.method, FormFactorMethod::hemisphere);
    EXPECT_EQ(all.matrix.rays, 64);
    EXPECT_EQ(all.matrix.seed, 9U);
    EXPECT_EQ(all.meshing.max_elements, 2000U);
    EXPECT_EQ(all.memory, 0x1p31);
    EXPECT_TRUE(all.repair);

    const auto edge = std::get<FormFactorsCommand>(parse(factors({"--max-edge", "50", "--unit", "cm"})));
    EXPECT_DOUBLE_EQ(edge.meshing.max_edge, 0.5);
    EXPECT_EQ(edge.meshing.max_elements, 0U);
}

TEST(Arguments, VerifyTakesACycleAndHasDefaults)
{
    const auto plain = std::get<VerifyCommand>(parse({"verify", "run"}));
    EXPECT_EQ(plain.points, 2000U);
    EXPECT_EQ(plain.cycle.kind, WhichCycle::Kind::last);
    const auto chosen = std::get<VerifyCommand>(
        parse({"verify", "run", "--points", "50", "--paths", "64", "--cycle", "3", "--seed", "9", "--json"}));
    EXPECT_EQ(chosen.points, 50U);
    EXPECT_EQ(chosen.most_paths, 64U);
    EXPECT_EQ(chosen.cycle.number, 3);
    EXPECT_EQ(chosen.seed, 9U);
    EXPECT_TRUE(chosen.json);
}

TEST(Arguments, ExportHasDefaultsForLightmaps)
{
    const auto command = [](std::vector<std::string> words) {
        return std::get<ExportCommand>(parse(exporting(std::move(words))));
    };
    EXPECT_EQ(command({"--format", "vtu", "-o", "a"}).cycle.kind, WhichCycle::Kind::last);
    EXPECT_EQ(command({"--format", "vtu", "-o", "a", "--cycle", "2"}).cycle.number, 2);
    EXPECT_EQ(command({"--format", "lightmap", "-o", "a.exr"}).lightmap.size, 1024);
    const auto dense = command({"--format", "lightmap", "-o", "a.exr", "--texels-per-metre", "50"});
    EXPECT_EQ(dense.lightmap.size, largest_picture_side);
    EXPECT_EQ(dense.lightmap.texels_per_metre, 50);
    const auto both = command({"--format", "lightmap", "-o", "a.exr", "--texels-per-metre", "50", "--size", "512",
                               "--quantity", "irradiance"});
    EXPECT_EQ(both.lightmap.size, 512);
    EXPECT_EQ(both.quantity, LightmapQuantity::irradiance);
}

TEST(Arguments, CompareTakesLimitsThatMayBeGivenAgain)
{
    const auto command = std::get<CompareCommand>(
        parse(comparing({"--fail-above", "flip=0.05", "--fail-above", "l2=1e-3", "--points", "9", "--view", "v"})));
    ASSERT_EQ(command.limits.size(), 2U);
    EXPECT_EQ(command.limits[1].metric, Metric::l2);
    EXPECT_EQ(command.limits[1].value, 1e-3);
    EXPECT_FALSE(command.false_color.quantity);
    EXPECT_EQ(std::get<CompareCommand>(parse({"compare", "--fail-above", "rmse=1", "x", "y", "-o", "z"})).b, "y");
}

TEST(Arguments, ErrorAndSizeAreLogarithmicUnlessTold)
{
    const auto color = [](std::vector<std::string> words) {
        return std::get<RenderCommand>(parse(rendering(std::move(words)))).false_color;
    };
    EXPECT_FALSE(color({}).quantity);
    EXPECT_EQ(color({"--false-color", "lux"}).scale, ScaleKind::linear);
    EXPECT_EQ(color({"--show", "error"}).quantity, Quantity::error);
    EXPECT_EQ(color({"--show", "size"}).scale, ScaleKind::logarithmic);
    EXPECT_EQ(color({"--show", "size", "--scale", "linear"}).scale, ScaleKind::linear);
    EXPECT_EQ(color({"--false-color", "lux", "--range", "-1:2.5"}).range, std::pair(-1.0, 2.5));
}

TEST(Arguments, AFrameTakesItsTimeByWhatIsShown)
{
    EXPECT_EQ(std::get<AnimateCommand>(parse(animating({}))).delay, 800);
    EXPECT_EQ(std::get<AnimateCommand>(parse(animating({"--what", "path", "--path", "p"}))).delay, 40);
    EXPECT_EQ(std::get<AnimateCommand>(parse(animating({"--delay", "7"}))).delay, 7);
}

TEST(Arguments, ValidateTakesOneMethodOrAll)
{
    EXPECT_FALSE(std::get<ValidateCommand>(parse({"validate"})).method);
    EXPECT_EQ(std::get<ValidateCommand>(parse({"validate", "--method", "closed-form"})).method,
              FormFactorMethod::closed_form);
}

TEST(Arguments, ALeadingDashIsAFileNameAfterTwo)
{
    EXPECT_EQ(std::get<InspectCommand>(parse({"inspect", "--", "-x.obj"})).scene.file, "-x.obj");
    EXPECT_EQ(std::get<RenderCommand>(parse({"render", "r", "-o", "a.png", "--from", "-1,2,3", "--to=-.5,0,0"})).from,
              Vec3(-1, 2, 3));
}

}  // namespace
}  // namespace patchlight
