#include "skyloop/base/replace_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "skyloop/base/text_file.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    return names;
}

TEST(ReplaceFile, PutsTheWholeInPlaceAndLeavesNothingBeside) {
    const test::TemporaryFolder folder;
    for (const std::string& content : {std::string("first"), std::string(1 << 20, 'x'), std::string()}) {
        ASSERT_TRUE(replace_file(folder / "a", content));
        EXPECT_EQ(read_text_file(folder / "a").value(), content);
        EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("a"));
    }
}

TEST(ReplaceFile, WhereItCannotTheOldFileStands) {
    const test::TemporaryFolder folder;
    const auto missing = replace_file(folder / "no/such/a", "text");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::outside);
    EXPECT_EQ(missing.error().message,
              (folder / "no/such/a").string() + ": cannot be written: No such file or directory");
    std::filesystem::create_directories(folder / "a/b");
    EXPECT_FALSE(replace_file(folder / "a", "text")) << "a folder with something in it";
    EXPECT_TRUE(std::filesystem::exists(folder / "a/b"));
    EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("a"));
}

TEST(ReplaceFile, OfManyWhoWriteAtOnceOneWins) {
    const test::TemporaryFolder folder;
    const std::string contents[] = {std::string(100'000, 'a'), std::string(100'000, 'b')};
    std::vector<std::thread> writers;
    for (const std::string& content : contents)
        writers.emplace_back([&] {
            for (int i = 0; i < 100; ++i)
                EXPECT_TRUE(replace_file(folder / "a", content));
        });
    for (std::thread& writer : writers)
        writer.join();
    EXPECT_THAT(contents, testing::Contains(read_text_file(folder / "a").value()));
    EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("a"));
}

}  // namespace
}  // namespace skyloop
