#include "tests/command/command_runner.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace patchlight::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

class FormFactorsTest : public CommandTest {
protected:
    FormFactorsTest()
    {
        // Opposed unit squares, one of them in two halves of two objects; and one out of the way.
        write_text(folder_ / "squares.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                            "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv 0 .5 1\nv 1 .5 1\n"
                                            "v 0 0 3\nv 1 0 3\nv 1 1 3\n"
                                            "v 0 0 4\nv 1 0 4\nv 2 0 4\n"
                                            "o the floor\nf 1 2 3 4\n"
                                            "o Dächer\nf 5 9 10 6\n"
                                            "o -dash\nf 9 8 7 10\n"
                                            "o up there\nf 11 12 13\n"
                                            "o thread\nf 14 15 16\n");
    }

    Outcome between(const std::string& from, const std::string& to, std::vector<std::string> more = {})
    {
        std::vector<std::string> words{"formfactors", path("squares.obj"), "--between", from, to};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }

    Json answer(const Outcome& outcome)
    {
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return Json::parse(outcome.out);
    }

    void expect_no_temporaries()
    {
        for (const auto& [name, bytes] : files_in(folder_)) {
            EXPECT_THAT(name, Not(HasSubstr("tmp")));
        }
    }

    static constexpr double opposed = 0.19982489569838738304;
};

TEST_F(FormFactorsTest, BetweenTwoObjectsAsJson)
{
    const Json lower = answer(between("the floor", "Dächer", {"--json"}));
    std::vector<std::string> keys;
    for (const auto& [key, value] : lower.items()) {
        keys.push_back(key);
    }
    keys.resize(7);
    EXPECT_EQ(keys, (std::vector<std::string>{"from", "to", "method", "value", "error", "samples", "seconds"}));
    EXPECT_EQ(lower["from"], "the floor");
    EXPECT_EQ(lower["to"], "Dächer");
    EXPECT_EQ(lower["method"], "exact");
    EXPECT_NEAR(lower["value"].get<double>(), opposed / 2, 1e-9) << "half of the square above, by symmetry";
    EXPECT_NEAR(lower["reverse"].get<double>(), opposed, 1e-9) << "twice as much: half the area";
    EXPECT_NEAR(lower["areas"]["to"].get<double>(), 0.5, 1e-15);
    EXPECT_GT(lower["samples"].get<std::size_t>(), 0U);
    EXPECT_EQ(answer(between("the floor", "up there", {"--json"}))["value"], 0) << "it faces the other way";
}

TEST_F(FormFactorsTest, CoplanarObjectsOfOneMaterialStayApart)
{
    const double one = answer(between("the floor", "Dächer", {"--json", "--method", "closed-form"}))["value"];
    const double two = answer(between("the floor", "-dash", {"--json", "--method", "closed-form"}))["value"];
    EXPECT_NEAR(one, opposed / 2, 1e-10);
    EXPECT_NEAR(two, opposed / 2, 1e-10);
    EXPECT_EQ(answer(between("the floor", "the floor", {"--json"}))["value"], 0) << "planar: sees nothing of itself";
}

TEST_F(FormFactorsTest, EveryMethodAnswers)
{
    for (const char* method : {"closed-form", "hemicube", "hemisphere", "quadrature", "exact", "monte-carlo"}) {
        const Json found = answer(between("the floor", "Dächer", {"--json", "--method", method}));
        EXPECT_EQ(found["method"], method);
        EXPECT_NEAR(found["value"].get<double>(), opposed / 2, 0.005 * opposed) << method;
        EXPECT_GE(found["error"].get<double>(), 0) << method;
    }
    EXPECT_THAT(between("the floor", "Dächer").out, AllOf(HasSubstr("F        0.0999124"), HasSubstr("exact")));
}

TEST_F(FormFactorsTest, TheClosedFormWarnsOfWhatItLooksThrough)
{
    EXPECT_EQ(between("the floor", "Dächer", {"--method", "closed-form"}).err.find("looks through"), std::string::npos);
    write_text(folder_ / "squares.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                                        "v 0 0 .5\nv .5 0 .5\nv .5 .5 .5\nv 0 .5 .5\n"
                                        "o the floor\nf 1 2 3 4\no Dächer\nf 5 8 7 6\no plate\nf 9 10 11 12\n");
    const Outcome through = between("the floor", "Dächer", {"--method", "closed-form", "--json"});
    EXPECT_THAT(through.err, HasSubstr("warning: closed-form looks through"));
    EXPECT_EQ(answer(through)["unoccluded"], true);
    EXPECT_NEAR(answer(through)["value"].get<double>(), opposed, 1e-10);
    EXPECT_NEAR(answer(between("the floor", "Dächer", {"--json"}))["value"].get<double>(), 0.149868671773790537, 1e-9);
}

TEST_F(FormFactorsTest, ObjectsThatAreNotThereOrHaveNoArea)
{
    const Outcome unknown = between("the flor", "Dächer");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_THAT(unknown.err, AllOf(HasSubstr("error[object]: squares.obj: there is no object \"the flor\""),
                                   HasSubstr("there are \"the floor\"")));
    EXPECT_EQ(between("The floor", "Dächer").code, 2) << "upper case is another name";
    const Outcome empty = between("the floor", "thread");
    EXPECT_EQ(empty.code, 3);
    EXPECT_THAT(empty.err, AllOf(HasSubstr("error[zeroarea]"), HasSubstr("\"thread\"")));
    EXPECT_EQ(run({"formfactors", path("nothing.obj")}).code, 3);
    EXPECT_EQ(run({"formfactors", path("squares.obj"), "--method", "monte-carlo"}).code, 2);
}

TEST_F(FormFactorsTest, BadGeometryHasAnAnswerAllTheSame)
{
    // Faces that aren't planar, that pierce one another, that lie in one another, that aren't convex; a needle.
    write_text(folder_ / "squares.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1.2\nv 0 1 1\n"
                                        "v .5 -1 -.5\nv .5 2 -.5\nv .5 2 1.5\nv .5 -1 1.5\n"
                                        "v .6 .6 0\nv .9 .6 0\nv .7 .7 0\nv .6 .9 0\nv 0 0 2\nv 1 0 2\nv 1 1e-6 2\n"
                                        "o floor\nf 1 2 3 4\no bent\nf 5 8 7 6\no plate\nf 9 10 11 12\n"
                                        "o inlay\nf 13 14 15 16\no needle\nf 19 18 17\n");
    const std::vector<std::pair<std::string, std::string>> pairs{
        {"floor", "bent"}, {"floor", "plate"}, {"bent", "inlay"}, {"floor", "needle"}, {"floor", "inlay"}};
    for (const auto& [from, to] : pairs) {
        const double exact = answer(between(from, to, {"--json"}))["value"];
        const double sampled = answer(between(from, to, {"--json", "--method", "hemisphere"}))["value"];
        EXPECT_TRUE(exact >= 0 && exact <= 1) << from << " " << to;
        EXPECT_NEAR(sampled, exact, 0.02 * exact) << from << " " << to;
    }
}

TEST_F(FormFactorsTest, OfAllPatchesAsJson)
{
    const Json found = answer(run({"formfactors", path("squares.obj"), "--method", "hemisphere", "--max-elements",
                                   "200", "--rays", "64", "--repair", "symmetric", "--json"}));
    for (const char* key : {"scene", "method", "elements", "entries", "samples", "seconds", "bytes_estimated", "closed",
                            "closure", "reciprocity", "outside", "repair", "options"}) {
        EXPECT_TRUE(found.contains(key)) << key;
    }
    EXPECT_EQ(found["closed"], false);
    EXPECT_EQ(found["outside"]["count"], 0);
    EXPECT_GT(found["entries"].get<int>(), 100);
    EXPECT_GT(found["repair"]["reciprocity_before"]["worst"].get<double>(), 1e-3);
    EXPECT_LT(found["reciprocity"]["worst"].get<double>(), 1e-15);
    EXPECT_EQ(found["options"]["rays"], 64);
}

TEST_F(FormFactorsTest, TheSameBytesAtAnyNumberOfThreads)
{
    for (const char* threads : {"1", "2"}) {
        EXPECT_EQ(run({"formfactors", path("squares.obj"), "--method", "hemisphere", "--max-elements", "300", "--rays",
                       "64", "--threads", threads, "-o", path(std::string(threads) + ".bin")})
                      .code,
                  0);
    }
    EXPECT_GT(text_of(path("1.bin")).size(), 1000U);
    EXPECT_EQ(text_of(path("1.bin")), text_of(path("2.bin")));
}

TEST_F(FormFactorsTest, MoreThanTheMemoryHoldsIsRefusedBeforeItIsAllocated)
{
    const Outcome large = run({"formfactors", path("squares.obj"), "--max-elements", "10000000"});
    EXPECT_EQ(large.code, 5);
    EXPECT_THAT(large.err, AllOf(HasSubstr("error[memory]: needs "), HasSubstr(" GiB, limit ")));
    const Outcome small = run({"formfactors", path("squares.obj"), "--memory", "100kB", "-o", path("new/f.bin")});
    EXPECT_EQ(small.code, 5);
    EXPECT_THAT(small.err, HasSubstr("--memory"));
    EXPECT_FALSE(std::filesystem::exists(path("new")));
}

TEST_F(FormFactorsTest, WhatCannotBeWrittenIsSix)
{
    const std::vector<std::string> words{
        "formfactors", path("squares.obj"), "--method", "hemisphere", "--max-elements", "300", "-o", path("f.csv")};
    EXPECT_EQ(run(words, {.largest_file = 4000}).code, 6);
    EXPECT_FALSE(std::filesystem::exists(path("f.csv")));
    expect_no_temporaries();
    EXPECT_EQ(run({"formfactors", path("squares.obj"), "--max-elements", "50", "-o", path("squares.obj/f.csv")}).code,
              6);
}

TEST_F(FormFactorsTest, AnInterruptLeavesNothing)
{
    std::filesystem::create_directory(folder_ / "out");
    RunningCommand computing({"formfactors", path("squares.obj"), "--method", "hemisphere", "--max-elements", "4000",
                              "--rays", "65536", "-o", path("out/f.bin")},
                             folder_ / "scratch", {});
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    const auto begin = std::chrono::steady_clock::now();
    computing.send(SIGINT);
    EXPECT_EQ(computing.wait().code, 130);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
    EXPECT_EQ(files_in(folder_ / "out").size(), 0U);
}

TEST_F(FormFactorsTest, AnInterruptWhileAFileIsWrittenLeavesNothing)
{
    std::filesystem::create_directory(folder_ / "out");
    RunningCommand writing({"formfactors", path("squares.obj"), "--method", "hemisphere", "--max-elements", "6000",
                            "--rays", "1024", "-o", path("out/f.csv")},
                           folder_ / "scratch", {});
    ASSERT_TRUE(writing.wait_for([&] { return !std::filesystem::is_empty(folder_ / "out"); }));
    writing.send(SIGTERM);
    const int code = writing.wait().code;
    if (code != 0) {
        EXPECT_EQ(code, 143);
        EXPECT_EQ(files_in(folder_ / "out").size(), 0U);
    }
}

}  // namespace
}  // namespace patchlight::testing
