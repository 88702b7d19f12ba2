#include "apps/study/study.h"

#include <gmock/gmock.h>

namespace patchlight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const OptionNames names{"refine", "max-elements", "max-edge", "emitter", "rays",      "seed", "unit",
                        "mesh",   "threads",      "pictures", "size",    "overshoot", "view", "tolerance"};

Study study_of(const std::string& text, const std::filesystem::path& file = "studies/study.toml")
{
    return read_study(text, file, names);
}

std::string refusal_of(const std::string& text)
{
    try {
        study_of(text);
        return "taken";
    } catch (const StudyError& error) {
        return error.what();
    }
}

/// The options as "name=value".
std::vector<std::string> words(const std::vector<OptionText>& options)
{
    std::vector<std::string> found;
    for (const OptionText& option : options) found.push_back(option.name + "=" + option.value);
    return found;
}

const std::string whole = R"(title = "Cornell, meshes"
scene = "cornell-box.obj"
unit = "mm"
seed = 3

[options]
max_elements = 4000
tolerance = 1e-5
emitter = ["lamp=10,9,8", "sky=2"]

[vary]
refine = ["none", "intensity", "both"]
max_elements = [500, 1000, 2000, 4_000]

[[skip]]
refine = "none"
max_elements = 4000

[reference]
kind = "solution"
points = 500
[reference.options]
max_elements = 20000

[metrics]
probes = "points.csv"

[gates]
min_rate = 0.5
max_energy_residual = 1

[[compare]]
at = "elements"
values = [1000, 2000]
[[compare]]
at = "seconds"
values = [1.5]

[pictures]
views = ["front", "other.view.json"]
exposure = 1.5
size = "64x48"

[limits]
time = "10min"
memory = "4GiB"
cells = 12
)";

// One method with an option beside the same without it.
TEST(ReadStudy, AnEmptyValueLeavesAnOptionOut)
{
    const Study study = study_of("scene = \"a.obj\"\n[options]\nview = \"front\"\n[vary]\nview = [\"\", \"side\"]\n");
    const std::vector<StudyCell> cells = expand(study);
    ASSERT_EQ(cells.size(), 2u);
    EXPECT_THAT(words(cells[0].options), ::testing::Not(::testing::Contains(StartsWith("view"))));
    EXPECT_THAT(words(cells[1].options), ::testing::Contains("view=side"));
    EXPECT_THAT(study_of("scene = \"a.obj\"\n[reference]\nseen_from = \"front\"\n").reference.seen_from, "front");
    EXPECT_THAT(refusal_of("scene = \"a.obj\"\n[options]\nview = \"\"\n"), HasSubstr("is empty"));
}

TEST(ReadStudy, ThreeLinesAreAStudy)
{
    const Study study = study_of("scene = \"room.obj\"\n[vary]\nmax_elements = [100, 200]\n");
    EXPECT_EQ(study.name, "study");
    EXPECT_THAT(words(study.scenes), ElementsAre("scene=studies/room.obj"));
    EXPECT_THAT(words(study.options), ElementsAre("pictures=none"));
    EXPECT_EQ(study.reference.kind, ReferenceKind::path_traced);
    EXPECT_EQ(study.along, "max-elements");
    EXPECT_TRUE(study.pictures.views.empty());
    const auto cells = expand(study);
    ASSERT_EQ(cells.size(), 2U);
    EXPECT_EQ(cells[1].name, "max-elements=200");
    EXPECT_THAT(words(cells[1].options), ElementsAre("pictures=none", "max-elements=200"));
}

TEST(ReadStudy, EverySectionArrives)
{
    const Study study = study_of(whole);
    EXPECT_EQ(study.name, "Cornell, meshes");
    EXPECT_THAT(words(study.options), ElementsAre("unit=mm", "seed=3", "max-elements=4000", "tolerance=1e-05",
                                                  "emitter=lamp=10,9,8\nsky=2", "pictures=none"));
    EXPECT_EQ(study.options[2].place.line, 7);
    EXPECT_EQ(study.options[2].place.column, 1);
    ASSERT_EQ(study.axes.size(), 2U);
    EXPECT_EQ(study.axes[0].name, "refine") << "as the file has them, not by the alphabet";
    EXPECT_THAT(words(study.axes[1].values),
                ElementsAre("max-elements=500", "max-elements=1000", "max-elements=2000", "max-elements=4000"));
    EXPECT_EQ(study.along, "max-elements");
    EXPECT_EQ(study.reference.kind, ReferenceKind::solution);
    EXPECT_EQ(study.reference.points, 500U);
    EXPECT_THAT(words(reference_options(study)),
                ElementsAre("unit=mm", "seed=3", "max-elements=20000", "tolerance=1e-05", "emitter=lamp=10,9,8\nsky=2",
                            "pictures=none"));
    EXPECT_EQ(study.probes, "studies/points.csv");
    EXPECT_EQ(study.gates.min_rate, 0.5);
    EXPECT_EQ(study.gates.max_energy_residual, 1);
    EXPECT_FALSE(study.gates.max_error);
    ASSERT_EQ(study.comparisons.size(), 2U);
    EXPECT_EQ(study.comparisons[1].at, StudyComparison::At::seconds);
    EXPECT_THAT(study.comparisons[0].values, ElementsAre(1000, 2000));
    ASSERT_EQ(study.pictures.views.size(), 2U);
    EXPECT_EQ(study.pictures.views[1].view, "studies/other.view.json");
    EXPECT_EQ(study.pictures.exposure, 1.5);
    EXPECT_EQ(study.pictures.size, std::pair(64, 48));
    EXPECT_EQ(study.limits.seconds, 600);
    EXPECT_EQ(study.limits.memory, "4GiB");
    EXPECT_EQ(study.limits.memory_place.line, 46);
}

TEST(ReadStudy, CellsAreTheGridWithoutWhatIsSkipped)
{
    const auto cells = expand(study_of(whole));
    ASSERT_EQ(cells.size(), 11U);
    EXPECT_EQ(cells[0].name, "refine=none max-elements=500");
    EXPECT_EQ(cells[2].index, 2U);
    EXPECT_EQ(cells[3].index, 4U) << "the fourth is skipped, and numbers stay";
    EXPECT_EQ(cells[3].name, "refine=intensity max-elements=500");
    EXPECT_THAT(cells[3].values, ElementsAre("intensity", "500"));
    EXPECT_THAT(words(cells[3].options),
                ElementsAre("unit=mm", "seed=3", "max-elements=500", "tolerance=1e-05", "emitter=lamp=10,9,8\nsky=2",
                            "pictures=none", "refine=intensity"));
}

TEST(ReadStudy, SeveralScenesAreTheFirstAxis)
{
    const Study study = study_of("scene = [\"a.obj\", \"/b/c.glb\"]\n[vary]\nrays = [16, 32]\n"
                                 "[[skip]]\nscene = \"a.obj\"\nrays = 16\n");
    const auto cells = expand(study);
    ASSERT_EQ(cells.size(), 3U);
    EXPECT_EQ(cells[0].name, "scene=a.obj rays=32");
    EXPECT_EQ(cells[0].scene, "studies/a.obj");
    EXPECT_EQ(cells[1].scene, "/b/c.glb");
    EXPECT_THAT(words(cells[1].options), ElementsAre("pictures=none", "rays=16"));
}

TEST(ReadStudy, WithoutAxesThereIsOneCell)
{
    const auto cells = expand(study_of("scene = \"a.obj\"\n"));
    ASSERT_EQ(cells.size(), 1U);
    EXPECT_EQ(cells[0].name, "study");
}

TEST(ReadStudy, WordsTakeDashesAndUnderscoresAndNumbersKeepTheirDigits)
{
    const Study study =
        study_of("scene = \"a.obj\"\noptions.max-edge = 0.1\noptions.overshoot = true\n"
                 "[vary]\ntolerance = [1e-3, 0.30000000000000004]\nmax-elements = [9007199254740993]\n");
    EXPECT_THAT(words(study.options), ElementsAre("max-edge=0.1", "overshoot=true", "pictures=none"));
    EXPECT_EQ(study.axes[0].values[1].value, "0.30000000000000004");
    EXPECT_EQ(study.axes[1].values[0].value, "9007199254740993");
    const Study pictured = study_of("scene = \"a.obj\"\noptions.pictures = \"all\"\n");
    EXPECT_THAT(words(pictured.options), ElementsAre("pictures=all"));
}

struct Refused {
    std::string text, message;
};

class RefusedStudy : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedStudy, NamesThePlaceAndTheCause)
{
    EXPECT_THAT(refusal_of(GetParam().text), HasSubstr(GetParam().message)) << GetParam().text;
}

const std::string scene = "scene = \"a.obj\"\n";

INSTANTIATE_TEST_SUITE_P(
    Keys, RefusedStudy,
    ::testing::Values(
        Refused{"", "studies/study.toml: no scene"},
        Refused{scene + "[vary]\n  max_egde = [1, 2]\n",
                "studies/study.toml:3:3: unknown key \"max_egde\", did you mean \"max_edge\"?"},
        Refused{scene + "[vary]\nmax-egde = [1, 2]\n", "did you mean \"max-edge\"?"},
        Refused{scene + "[gate]\nmin_rate = 1\n", ":2:2: unknown key \"gate\", did you mean \"gates\"?"},
        Refused{scene + "[gates]\nmin_rat = 1\n", ":3:1: unknown key \"min_rat\", did you mean \"min_rate\"?"},
        Refused{scene + "rays = 16\n", ":2:1: unknown key \"rays\": options stand in [options]"},
        Refused{scene + "[options]\nflux_capacitor = 1\n", "patchlight solve --help"},
        Refused{scene + "[options]\nthreads = 2\n", ":3:1: \"threads\" is no option of a study"},
        Refused{scene + "[options]\no = \"run\"\n", "each cell's folder"},
        Refused{scene + "[options]\njson = true\n", "cells print nothing"},
        Refused{scene + "[vary]\nscene = [\"a\", \"b\"]\n", "at the top of the file"},
        Refused{scene + "seed = 1\n[options]\nseed = 2\n", ":4:1: \"seed\" stands at the top, too"},
        Refused{scene + "[options]\nmax_edge = 1\nmax-edge = 2\n", ":4:1: \"max-edge\" stands there twice"},
        Refused{scene + "[vary]\nrays = [16]\nrays = [32]\n", "study.toml:4:8: not TOML: "},
        Refused{scene + "[reference]\nkind = \"furnace\"\npaths = 10\n", ":4:1: unknown key \"paths\"; there are kind"},
        Refused{scene + "[[compare]]\nat = \"elements\"\n", "needs at and values"},
        Refused{scene + "[[skip]]\nrays = 16\n", ":3:1: unknown key \"rays\": nothing in [vary]"},
        Refused{scene + "[vary]\nrays = [16, 32]\n[[skip]]\nrays = 64\n", ":5:8: 64 is no value of \"rays\""},
        Refused{scene + "[[skip]]\n", "without a condition"}));

INSTANTIATE_TEST_SUITE_P(
    Values, RefusedStudy,
    ::testing::Values(
        Refused{"scene = 3\n", ":1:9: \"scene\" is a number"}, Refused{"scene = []\n", "empty list"},
        Refused{"scene = [\"a\", \"a\"]\n", "has the value a twice"}, Refused{"scene = \"\"\n", "is empty"},
        Refused{"scene = \"a\\nb\"\n", "control character"}, Refused{scene + "vary = 1\n", "wanted is a table: [vary]"},
        Refused{scene + "[vary]\nrays = []\n", ":3:8: \"rays\" is an empty list"},
        Refused{scene + "[vary]\nrays = 16\n", ":3:8: \"rays\" is a number"},
        Refused{scene + "[vary]\nrays = [[16], [32]]\n", ":3:9: \"rays\" is a list of lists"},
        Refused{scene + "[vary]\nrays = [16, 32, 16]\n", ":3:17: \"rays\" has the value 16 twice"},
        Refused{scene + "[vary]\nrays = [16, 16.0]\n", "twice"},
        Refused{scene + "[vary]\nmax_edge = [1.0, inf]\n", ":3:18: \"max_edge\" is not finite"},
        Refused{scene + "[options]\nmax_edge = nan\n", "is not finite"},
        Refused{scene + "[options]\nmax_edge = 1979-05-27\n", "is a date or time"},
        Refused{scene + "[options]\nmax_edge = {a = 1}\n", "is a table"},
        Refused{scene + "[options]\nrays = 99999999999999999999\n", "not TOML"},
        Refused{scene + "seed = [1, 2]\n", "what varies stands in [vary]"},
        Refused{scene + "[reference]\nkind = \"exact\"\n", ":3:8: \"kind\" is \"exact\"; there are path-traced"},
        Refused{scene + "[reference]\nkind = \"run\"\n", ":2:2: the reference names no run"},
        Refused{scene + "[reference]\nkind = \"points\"\n", "names no file"},
        Refused{scene + "[reference]\nkind = \"solution\"\n", "no finer"},
        Refused{scene + "[reference]\npoints = 0\n", "a whole number from 1 to 1000000"},
        Refused{scene + "[reference]\npaths = 64.5\n", "a whole number"},
        Refused{scene + "[gates]\nmin_rate = 0.5\n", "a rate needs an axis"},
        Refused{scene + "[gates]\nmax_error = -1\n", "a number from 0"},
        Refused{scene + "[gates]\nmax_error = nan\n", "a number from 0"},
        Refused{scene + "[gates]\nmax_error = \"low\"\n", "a number from 0"},
        Refused{scene + "[gates]\nmin_effectivity = 3\nmax_effectivity = 2\n", "is above"},
        Refused{scene + "[gates]\nmax_error = 1\n[reference]\nkind = \"none\"\n", "needs a reference"},
        Refused{scene + "[metrics]\nalong = \"rays\"\n", "is no axis of numbers"},
        Refused{scene + "[metrics]\nalong = \"refine\"\n[vary]\nrefine = [\"none\", \"both\"]\n", "no axis of numbers"},
        Refused{scene + "[[compare]]\nat = \"error\"\nvalues = [2, 1]\n", "a growing list"},
        Refused{scene + "[[compare]]\nat = \"error\"\nvalues = [0, 1]\n", "above 0"},
        Refused{scene + "[[compare]]\nat = \"rays\"\nvalues = [1]\n", "there are elements, seconds, error"},
        Refused{scene + "[pictures]\nsize = \"9x9x9\"\n", "wanted is WxH"},
        Refused{scene + "[pictures]\nsize = \"0x9\"\n", "wanted is WxH"},
        Refused{scene + "[pictures]\nexposure = \"bright\"\n", "\"auto\" or a number"},
        Refused{scene + "[pictures]\nviews = [\"a\", \"a\"]\n", "twice"},
        Refused{scene + "[limits]\ntime = \"soon\"\n", "wanted is a time such as"},
        Refused{scene + "[limits]\ntime = \"-1s\"\n", "wanted is a time such as"},
        Refused{scene + "[limits]\ntime = \"nan h\"\n", "wanted is a time such as"},
        Refused{scene + "[limits]\ncells = 1000000000\n", "a whole number from 1 to 100000"}));

TEST(ReadStudy, HostileTextsAreRefused)
{
    EXPECT_THAT(refusal_of("scene = \"\xff\xfe\"\n"), HasSubstr("study.toml:1:"));
    EXPECT_THAT(refusal_of(std::string("scene = 1\0", 10)), HasSubstr("byte 10 is zero"));
    EXPECT_THAT(refusal_of("scene = \"a.obj"), HasSubstr("not TOML"));
    EXPECT_THAT(refusal_of("\x7f"
                           "ELF\x02\x01"),
                HasSubstr("not TOML"));
    EXPECT_THAT(refusal_of(std::string(1'000'001, '#')), HasSubstr("too many"));
    EXPECT_THAT(refusal_of("x = " + std::string(10'000, '[')), HasSubstr("not TOML"));
    std::string inlined = "x = ";
    for (int i = 0; i < 10'000; ++i) inlined += "{a=";
    EXPECT_THAT(refusal_of(inlined), HasSubstr("not TOML"));
    // A megabyte of either would be half a million tables in one another: more than the stack can take down.
    std::string dotted, quoted;
    while (dotted.size() < 990'000) dotted += "a.";
    while (quoted.size() < 990'000) quoted += "'=' . \"]\\\"\".";
    EXPECT_THAT(refusal_of(dotted + "a = 1\n"), HasSubstr("study.toml:1:32: a key of so many parts"));
    EXPECT_THAT(refusal_of("\n[" + dotted + "a]\n"), HasSubstr("study.toml:2:33: a key of so many parts"));
    EXPECT_THAT(refusal_of(quoted + "a = 1\n"), HasSubstr("so many parts"));
}

TEST(ReadStudy, DotsInTextsAndNumbersAreNoKeys)
{
    std::string numbers = "0.5", title(100, '.');
    for (int i = 0; i < 40; ++i) numbers += ", " + std::to_string(i + 1) + ".5";
    const Study study = study_of("title = '" + title + "' # " + title + "\nscene = \"\"\"a\\\n" + title + "\"\"\"\n" +
                                 "[vary]\nmax_edge = [" + numbers + "]\n");
    EXPECT_EQ(study.axes[0].values.size(), 41U);
}

TEST(ReadStudy, ATooLargeGridIsRefusedBeforeItIsMade)
{
    std::string text = scene + "[vary]\n";
    for (const char* name : {"rays", "max_elements", "seed"}) {
        text += std::string(name) + " = [1";
        for (int i = 2; i <= 1000; ++i) text += ", " + std::to_string(i);
        text += "]\n";
    }
    const Study study = study_of(text);
    EXPECT_EQ(grid_size(study), 1'000'000'000U);
    try {
        expand(study);
        ADD_FAILURE() << "expanded";
    } catch (const StudyLimitError& error) {
        EXPECT_THAT(error.what(), StartsWith("studies/study.toml: 1000000000 cells, limit 1000; "));
    }
    Study endless = study;
    for (int i = 0; i < 4; ++i) endless.axes.insert(endless.axes.end(), study.axes.begin(), study.axes.end());
    EXPECT_EQ(grid_size(endless), std::numeric_limits<std::uint64_t>::max()) << "10^45 saturates";
    EXPECT_THROW(expand(endless), StudyLimitError);
}

TEST(ReadStudy, AStudyOfNoCellIsRefused)
{
    const Study study = study_of(scene + "[vary]\nrays = [16]\n[[skip]]\nrays = 16\n");
    EXPECT_THROW(expand(study), StudyError);
}

TEST(ReadConfiguration, HoldsOptionsAlone)
{
    const auto options = read_configuration("rays = 64\nthreads = 2\nsize = \"10x10\"\n", "c.toml", names);
    EXPECT_THAT(words(options), ElementsAre("rays=64", "threads=2", "size=10x10"));
    const auto refusal = [](const std::string& text) -> std::string {
        try {
            read_configuration(text, "c.toml", names);
            return "taken";
        } catch (const StudyError& error) {
            return error.what();
        }
    };
    EXPECT_EQ(refusal("raise = 1\n"), "c.toml:1:1: unknown key \"raise\", did you mean \"rays\"?");
    EXPECT_THAT(refusal("scene = \"a.obj\"\n"), HasSubstr("given on the command line"));
    EXPECT_THAT(refusal("[options]\nrays = 1\n"), HasSubstr("unknown key \"options\""));
    EXPECT_THAT(refusal("rays = [[1]]\n"), HasSubstr("a list of lists"));
}

}  // namespace
}  // namespace patchlight
