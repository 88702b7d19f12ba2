#include "apps/run/file_writer.h"

#include "apps/run/sha256.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <sys/resource.h>
#include <unistd.h>

namespace patchlight {
namespace {

class FileWriterTest : public ::testing::Test {
protected:
    std::size_t entries() const
    {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
    }

    const testing::TemporaryFolder temporary_;
    const std::filesystem::path& folder_ = temporary_.path();
    FileWriter writer_;
};

TEST_F(FileWriterTest, ReplacesAFileAndLeavesNothingBesideIt)
{
    writer_.write(folder_ / "a", "old");
    writer_.write(folder_ / "a", "new");
    EXPECT_EQ(read_bytes(folder_ / "a"), "new");
    EXPECT_EQ(entries(), 1U);
}

TEST_F(FileWriterTest, TakesAFileInPieces)
{
    const std::string one(5000, 'a'), two(7000, 'b');
    const auto bytes = [](const std::string& text) {
        return std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size());
    };
    writer_.write_pieces(folder_ / "a", [&](const FileWriter::Sink& sink) {
        sink(bytes(one));
        EXPECT_EQ(entries(), 1U) << "still under its temporary name";
        EXPECT_FALSE(std::filesystem::exists(folder_ / "a"));
        sink(bytes(two));
    });
    EXPECT_EQ(read_bytes(folder_ / "a"), one + two);
    EXPECT_THROW(writer_.write_pieces(folder_ / "a",
                                      [&](const FileWriter::Sink& sink) {
                                          sink(bytes(one));
                                          throw std::runtime_error("enough");
                                      }),
                 std::runtime_error);
    EXPECT_EQ(read_bytes(folder_ / "a"), one + two) << "the old file stays";
    EXPECT_EQ(entries(), 1U);
}

TEST_F(FileWriterTest, WhenTheDiskIsFullTheOldFileStays)
{
    writer_.write(folder_ / "a", "old");
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{1000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(writer_.write(folder_ / "a", std::string(100'000, 'x')), OutputError);
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_EQ(read_bytes(folder_ / "a"), "old");
    EXPECT_EQ(entries(), 1U) << "no temporary is left";
}

TEST_F(FileWriterTest, AfterAnInterruptNothingIsWrittenAnyMore)
{
    writer_.abandon();
    EXPECT_THROW(writer_.write(folder_ / "a", "late"), OutputError);
    EXPECT_EQ(entries(), 0U);
}

TEST_F(FileWriterTest, SweepsTemporariesOfAKilledProgramOnly)
{
    std::ofstream(folder_ / ".run.json.123.patchlight-tmp") << "half";
    std::ofstream(folder_ / "mine.patchlight-tmp") << "kept";
    FileWriter::sweep(folder_);
    EXPECT_FALSE(std::filesystem::exists(folder_ / ".run.json.123.patchlight-tmp"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "mine.patchlight-tmp"));
}

TEST_F(FileWriterTest, AFolderThatIsNotThereIsAnError)
{
    EXPECT_THROW(writer_.write(folder_ / "missing" / "a", "x"), OutputError);
    std::ofstream(folder_ / "file") << "x";
    EXPECT_THROW(FileWriter::make_folder(folder_ / "file"), OutputError);
    EXPECT_THROW(FileWriter::make_folder(folder_ / "file" / "below"), OutputError);
    EXPECT_THROW(FileWriter::make_folder("/proc/patchlight"), OutputError);
}

TEST(Sha256, HasTheStandardsValues)
{
    EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace patchlight
