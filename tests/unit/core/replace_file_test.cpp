#include "base/core/files.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <thread>
#include <vector>

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

TEST(ReplaceFile, FollowsLinksAndLeavesThem) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "there");
    std::filesystem::create_symlink("there/b", folder / "a");
    for (const std::string content : {"made", "made anew"}) {
        ASSERT_TRUE(replace_file(folder / "a", content));
        EXPECT_TRUE(std::filesystem::is_symlink(folder / "a"));
        EXPECT_EQ(read_text_file(folder / "there/b").value(), content);
    }
    std::filesystem::create_symlink("c", folder / "c");
    EXPECT_FALSE(replace_file(folder / "c", "text")) << "a link to itself";
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "c"));
}

TEST(ReplaceFile, WritesToDevicesAndPipes) {
    const test::TemporaryFolder folder;
    const auto full = replace_file("/dev/full", "text");
    ASSERT_FALSE(full);
    EXPECT_EQ(full.error().message, "/dev/full: cannot be written: No space left on device");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    const int reader = ::open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    ASSERT_TRUE(replace_file(folder / "pipe", "text"));
    std::string heard(16, '\0');
    heard.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::read(reader, heard.data(), heard.size()))));
    ::close(reader);
    EXPECT_EQ(heard, "text");
    EXPECT_THAT(names_in(folder.path()), testing::ElementsAre("pipe"));
}

TEST(CheckReplaceable, TellsBeforehandWhatWritingWouldTell) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "file") << "text";
    std::filesystem::create_symlink("missing/b", folder / "link");
    for (const char* name : {"missing/a", "file/a", "link"}) {
        const auto checked = check_replaceable(folder / name);
        ASSERT_FALSE(checked) << name;
        EXPECT_EQ(checked.error().code, ErrorCode::outside);
        EXPECT_EQ(checked.error().message, replace_file(folder / name, "text").error().message);
    }
    for (const std::filesystem::path& path : {folder / "file", folder / "new", std::filesystem::path("/dev/null")})
        EXPECT_TRUE(check_replaceable(path)) << path;
    EXPECT_THAT(names_in(folder.path()), testing::UnorderedElementsAre("file", "link"));
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
