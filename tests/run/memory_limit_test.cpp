#include "apps/run/memory_limit.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace patchlight::testing {
namespace {

class GroupMemory : public ::testing::Test {
protected:
    void set(const std::string& file, const std::string& text) const
    {
        std::filesystem::create_directories((root_ / file).parent_path());
        std::ofstream(root_ / file) << text << "\n";
    }

    const TemporaryFolder temporary_;
    const std::filesystem::path& root_ = temporary_.path();
};

TEST_F(GroupMemory, VersionTwoTakesTheLeastOfAllAbove)
{
    const std::string groups = "0::/outer/inner\n";
    EXPECT_TRUE(std::isinf(group_memory(groups, root_))) << "nothing is there";
    set("outer/inner/memory.max", "max");
    EXPECT_TRUE(std::isinf(group_memory(groups, root_)));
    set("outer/memory.max", "1073741824");
    EXPECT_EQ(group_memory(groups, root_), 0x1p30);
    set("outer/inner/memory.max", "536870912");
    EXPECT_EQ(group_memory(groups, root_), 0x1p29);
    set("other/memory.max", "4096");
    EXPECT_EQ(group_memory(groups, root_), 0x1p29) << "another process's";
}

TEST_F(GroupMemory, VersionOneAndBothTogether)
{
    const std::string groups = "9:name=systemd:/\n4:cpu,memory:/job\n0::/\n";
    set("memory/memory.limit_in_bytes", "9223372036854771712");
    set("memory/job/memory.limit_in_bytes", "2147483648");
    EXPECT_EQ(group_memory(groups, root_), 0x1p31);
    set("unified/memory.max", "1048576");
    EXPECT_EQ(group_memory(groups, root_), 0x1p20);
}

TEST_F(GroupMemory, AContainerSeesItsGroupAsTheRoot)
{
    set("memory.max", "268435456");
    EXPECT_EQ(group_memory("0::/not/to/be/seen\n", root_), 0x1p28);
    EXPECT_TRUE(std::isinf(group_memory("", root_)));
    EXPECT_TRUE(std::isinf(group_memory("rubbish\n1:memory\n", root_)));
}

TEST_F(GroupMemory, TheDefaultIsAtMostSixteenGibibytes)
{
    EXPECT_GT(default_memory(), 0);
    EXPECT_LE(default_memory(), 0x1p34);
}

}  // namespace
}  // namespace patchlight::testing
