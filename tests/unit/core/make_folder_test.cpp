#include "base/core/files.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "unit/transport/temporary_folder.hpp"

namespace skyloop::test {
namespace {

TEST(MakeFolder, MakesThoseAboveAndTellsWhatWasThere) {
    const TemporaryFolder folder;
    const auto made = make_folder(folder / "a/b");
    ASSERT_TRUE(made);
    EXPECT_TRUE(*made);
    EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b"));
    EXPECT_FALSE(*make_folder(folder / "a/b"));
}

TEST(MakeFolder, NamesTheFolderAndTheReason) {
    const TemporaryFolder folder;
    std::ofstream(folder / "file") << "text";
    const auto below_a_file = make_folder(folder / "file/run");
    ASSERT_FALSE(below_a_file);
    EXPECT_EQ(below_a_file.error().code, ErrorCode::outside);
    EXPECT_EQ(below_a_file.error().message,
              (folder / "file/run").string() + ": cannot be made a folder: Not a directory");
}

}  // namespace
}  // namespace skyloop::test
