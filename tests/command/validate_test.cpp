#include "tests/command/command_runner.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <set>

namespace patchlight::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

class ValidateTest : public CommandTest {};

TEST_F(ValidateTest, EveryMethodKeepsItsBounds)
{
    const auto begin = std::chrono::steady_clock::now();
    const Outcome outcome = run({"validate", "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(180)) << "60 s on two free cores";
    const Json all = Json::parse(outcome.out);
    std::set<std::string> methods, cases;
    for (const Json& one : all["cases"]) {
        EXPECT_TRUE(one["passed"].get<bool>()) << one.dump();
        methods.insert(one["method"]);
        cases.insert(one["case"]);
        for (const char* key : {"value", "reference", "error", "bound", "seconds"}) {
            EXPECT_TRUE(one.contains(key)) << key;
        }
    }
    for (const char* method : {"closed-form", "hemicube", "hemisphere", "quadrature", "exact", "monte-carlo",
                               "formula C-11", "formula Lambert"}) {
        EXPECT_TRUE(methods.contains(method)) << method;
    }
    EXPECT_GE(cases.size(), 34U);
    EXPECT_EQ(all["failed"], 0);
    EXPECT_EQ(all["passed"].get<std::size_t>(), all["cases"].size());
}

TEST_F(ValidateTest, OneMethodAsATable)
{
    const Outcome outcome = run({"validate", "--method", "closed-form"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.out, HasSubstr("opposed squares, d = 0.1"));
    EXPECT_THAT(outcome.out, HasSubstr("42 of 42 within their bounds"));
    EXPECT_EQ(outcome.out.find("MISSED"), std::string::npos);
    EXPECT_EQ(outcome.out.find("hemicube"), std::string::npos);
}

}  // namespace
}  // namespace patchlight::testing
