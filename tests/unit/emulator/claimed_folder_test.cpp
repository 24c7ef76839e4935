// A folder that one run at a time writes into.
#include "run/emulator/run_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

TEST(ClaimedFolder, IsHeldUntilItsOwnerGoes) {
    const TemporaryFolder folder;
    {
        auto first = ClaimedFolder::claim(folder / "run");
        ASSERT_TRUE(first);
        EXPECT_EQ(first->path(), folder / "run");
        const ClaimedFolder moved = std::move(*first);
        const auto second = ClaimedFolder::claim(folder / "run");
        ASSERT_FALSE(second);
        EXPECT_EQ(second.error().code, ErrorCode::outside);
        EXPECT_THAT(second.error().message, HasSubstr("run: another run is recording there; expected another folder"));
        EXPECT_TRUE(ClaimedFolder::claim(folder / "other"));
        EXPECT_TRUE(std::filesystem::exists(folder / "run")) << "who was refused takes nothing away";
    }
    EXPECT_TRUE(ClaimedFolder::claim(folder / "run"));
}

TEST(ClaimedFolder, TakesAwayWhatItMadeInVain) {
    const TemporaryFolder folder;
    { EXPECT_TRUE(ClaimedFolder::claim(folder / "made")); }
    EXPECT_FALSE(std::filesystem::exists(folder / "made"));
    std::filesystem::create_directory(folder / "was there");
    { EXPECT_TRUE(ClaimedFolder::claim(folder / "was there")); }
    EXPECT_TRUE(std::filesystem::exists(folder / "was there"));
    {
        const auto used = ClaimedFolder::claim(folder / "used");
        std::ofstream(folder / "used/file") << "x";
    }
    EXPECT_TRUE(std::filesystem::exists(folder / "used/file"));
}

}  // namespace
}  // namespace skyloop
