#include "apps/study/check_study.h"
#include "tests/temporary_folder.h"

#include <gmock/gmock.h>

#include <fstream>

namespace patchlight {
namespace {

TEST(CheckStudyTest, ARunWhoseRecordIsBrokenIsAProblemAndOthersAreNotLookedAt)
{
    const testing::TemporaryFolder temporary;
    const std::filesystem::path root = temporary.path();
    EXPECT_FALSE(is_study_folder(root));
    for (const char* run : {"cells/b/run", "cells/a", "references/r"}) {
        std::filesystem::create_directories(root / run);
        std::ofstream(root / run / "run.json") << "{";
    }
    std::filesystem::create_directories(root / "cells/not-begun");
    std::filesystem::create_directories(root / "elsewhere");
    std::ofstream(root / "elsewhere/run.json") << "{";
    EXPECT_TRUE(is_study_folder(root));
    const StudyCheck check = check_study({root});
    EXPECT_THAT(check.runs, ::testing::ElementsAre(root / "cells/a", root / "cells/b/run", root / "references/r"));
    ASSERT_EQ(check.problems.size(), 3U);
    EXPECT_EQ(check.problems[1].file, "cells/b/run/run.json");
    EXPECT_EQ(check.files, 0U);
}

TEST(CheckStudyTest, NothingIsThrownWhereNothingIs)
{
    EXPECT_FALSE(is_study_folder("/nonexistent"));
    EXPECT_TRUE(check_study({"/nonexistent"}).problems.empty());
}

}  // namespace
}  // namespace patchlight
