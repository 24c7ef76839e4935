// The memory of a receiver that is switched off.
#include "run/emulator/run_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/run_parts.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;

const GpsTime state_start = to_gps_time(2400, 0);

std::size_t files_in(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(StateFile, KeepsATextForTheNextRun) {
    const test::TemporaryFolder folder;
    const auto path = folder / "receiver.state";
    auto first = StateFile::open(path);
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_EQ(first->text(), "") << "a receiver from the factory";
    first->keep("baud 38400\n", state_start);
    EXPECT_EQ(test::content_of(path), "baud 38400\n");
    EXPECT_EQ(StateFile::open(path)->text(), "baud 38400\n");
    first->keep("baud 57600\n", state_start + 1s);
    EXPECT_EQ(StateFile::open(path)->text(), "baud 57600\n");
    EXPECT_EQ(files_in(folder / "."), 1U) << "nothing else is left behind";
    EXPECT_FALSE(first->failure());
}

TEST(StateFile, WritesOnlyWhatHasChanged) {
    const test::TemporaryFolder folder;
    const auto path = folder / "receiver.state";
    auto file = StateFile::open(path);
    file->keep("", state_start);
    EXPECT_FALSE(std::filesystem::exists(path)) << "no state, no file";
    file->keep("a", state_start);
    std::filesystem::remove(path);
    file->keep("a", state_start + 5s);
    EXPECT_FALSE(std::filesystem::exists(path));
    file->keep("b", state_start + 6s);
    EXPECT_EQ(test::content_of(path), "b");
}

TEST(StateFile, IsDueOnceASecond) {
    const test::TemporaryFolder folder;
    auto file = StateFile::open(folder / "receiver.state");
    EXPECT_TRUE(file->due(state_start));
    file->keep("a", state_start);
    EXPECT_FALSE(file->due(state_start + 999ms));
    EXPECT_TRUE(file->due(state_start + 1s));
}

TEST(StateFile, FailuresNameTheFile) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "taken");
    const auto folder_as_file = StateFile::open(folder / "taken");
    ASSERT_FALSE(folder_as_file);
    EXPECT_THAT(folder_as_file.error().message, testing::HasSubstr("taken"));
    auto nowhere = StateFile::open(folder / "missing/receiver.state");
    ASSERT_TRUE(nowhere);
    nowhere->keep("a", state_start);
    ASSERT_TRUE(nowhere->failure());
    EXPECT_EQ(nowhere->failure()->code, ErrorCode::outside);
    EXPECT_THAT(nowhere->failure()->message, testing::HasSubstr("missing/receiver.state"));
}

}  // namespace
}  // namespace skyloop
