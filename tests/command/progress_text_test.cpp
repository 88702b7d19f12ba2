#include "apps/patchlight/progress_text.h"

#include <gmock/gmock.h>

namespace patchlight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const ProgressText gathering{.fraction = 0.426,
                             .cycle = 0,
                             .stage = "indirect",
                             .elements = 1483,
                             .rays_per_second = 3.456e6,
                             .unshot = 0.0123,
                             .seconds_left = 11.2};

TEST(ProgressLine, LeavesOutWhatMattersLeast)
{
    EXPECT_EQ(progress_line(gathering, 120),
              "[######.........] 42 %  indirect  cycle 0  1483 elements  3.46 M rays/s  unshot 1.23 %  12 s left");
    EXPECT_EQ(progress_line(gathering, 80),
              "[####......] 42 %  indirect  cycle 0  1483 elements  unshot 1.23 %  12 s left");
    EXPECT_EQ(progress_line(gathering, 40), "[##...] 42 %  indirect  12 s left");
    EXPECT_EQ(progress_line(gathering, 12), "[##..] 42 %");
    EXPECT_EQ(progress_line(gathering, 5), "[#.] ");
    EXPECT_EQ(progress_line(gathering, 3), "");
    EXPECT_EQ(progress_line(gathering, -1), "");
}

TEST(ProgressLine, IsNeverWiderThanItMayBe)
{
    ProgressText longest = gathering;
    longest.cycle = 999;
    longest.elements = 1'000'000'000;
    longest.residual = 1.5e-12;
    for (const double fraction : {-1.0, 0.0, 0.5, 1.0, 2.0})
        for (int width = 0; width < 160; ++width) {
            longest.fraction = fraction;
            EXPECT_LE(static_cast<int>(progress_line(longest, width).size()), width) << fraction;
        }
}

TEST(ProgressLine, TellsWhatIsKnownOnly)
{
    const std::string line = progress_line({.stage = "mesh"}, 120);
    for (const char* unknown : {"elements", "rays", "unshot", "residual", "left", "cycle"})
        EXPECT_THAT(line, Not(HasSubstr(unknown)));
    EXPECT_THAT(progress_line({.stage = "solve", .residual = 0.00012}, 120), HasSubstr("residual 1.2e-04"));
}

TEST(TimeInWords, AreShort)
{
    EXPECT_EQ(time_in_words(0), "0 s");
    EXPECT_EQ(time_in_words(0.2), "1 s");
    EXPECT_EQ(time_in_words(98.4), "99 s");
    EXPECT_EQ(time_in_words(100), "2 min");
    EXPECT_EQ(time_in_words(3600 * 5), "5 h");
    EXPECT_EQ(time_in_words(1e12), "days");
}

TEST(TimeLeft, SaysNothingAtTheStart)
{
    TimeLeft left;
    EXPECT_EQ(left.after(0.5, 0.9), -1) << "a second hasn't gone by";
    EXPECT_EQ(left.after(30, 0.04), -1) << "a twentieth isn't done";
    EXPECT_EQ(left.after(30, 0), -1);
}

TEST(TimeLeft, CountsDownWhereWorkIsSteadyAndWhereItStandsStill)
{
    TimeLeft steady;
    // To rounding.
    for (double t = 1; t < 10; t += 0.1) EXPECT_NEAR(steady.after(t, t / 10), 10 - t, 1e-9);
    EXPECT_EQ(steady.after(12, 1), 0) << "late, but not negative";
}

TEST(TimeLeft, FollowsAJumpSlowly)
{
    TimeLeft left;
    left.after(10, 0.5);
    // A tenth of a second later a tenth less is done: a naive guess jumps from 10 s to 15 s.
    EXPECT_LT(left.after(10.1, 0.4), 10.2);
    double last = 0;
    for (double t = 10.2; t < 20; t += 0.1) last = left.after(t, t / 25);
    EXPECT_NEAR(last, 5, 0.5) << "and believes it in the end";
}

}  // namespace
}  // namespace patchlight
