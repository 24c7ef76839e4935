#include "campaigns/campaign/keyed_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

// As an editor leaves it: by a second, whatever the clock of the file system can tell.
void make_younger(const fs::path& path) {
    fs::last_write_time(path, fs::last_write_time(path) + std::chrono::seconds(1));
}

class KeyedFilesTest : public testing::Test {
protected:
    KeyedFilesTest() {
        write(track(), "abc");
        fs::create_directories(folder_ / "city/east");
        write(folder_ / "city/east/b.obj", "b");
        write(folder_ / "city/a.obj", "a");
    }
    [[nodiscard]] fs::path track() const { return folder_ / "track.csv"; }

    test::TemporaryFolder folder_;
    KeyedFiles files_;
};

TEST_F(KeyedFilesTest, TheDigestIsThatOfTheContent) {
    // printf abc | sha256sum; printf 'a.obj\naeast/b.obj\nb' | sha256sum
    EXPECT_EQ(files_.digest(track()), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(files_.digest(folder_ / "city"), "adad0627bcc7a567ec9e9888c179db9b1c83f77134be84a3e53abedf23e250ed");
    const auto absent = files_.digest(folder_ / "absent.csv");
    ASSERT_FALSE(absent);
    EXPECT_EQ(absent.error().code, ErrorCode::outside);
    EXPECT_THAT(absent.error().message, testing::EndsWith("/absent.csv: cannot be read: No such file or directory"));
    EXPECT_EQ(files_.find_written(), std::nullopt) << "what could not be read is not looked after";
}

TEST_F(KeyedFilesTest, WhatIsNoFileIsNotWaitedFor) {
    ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    for (const fs::path& path : {folder_ / "pipe", fs::path("/dev/zero")}) {
        const auto digest = files_.digest(path);
        ASSERT_FALSE(digest);
        EXPECT_EQ(digest.error().message, path.string() + ": is not a regular file");
    }
}

TEST_F(KeyedFilesTest, AnotherContentIsToldByTheNameOfItsFile) {
    ASSERT_TRUE(files_.digest(track()));
    EXPECT_EQ(files_.find_written(), std::nullopt);
    write(track(), "another");
    const auto changed = files_.find_written();
    ASSERT_FALSE(changed);
    EXPECT_EQ(changed.error().code, ErrorCode::outside);
    EXPECT_THAT(changed.error().message, testing::HasSubstr("/track.csv: has changed since the campaign began"));
    fs::remove(track());
    EXPECT_FALSE(files_.find_written());
}

TEST_F(KeyedFilesTest, SoItIsWithTheSizeOfBefore) {
    ASSERT_TRUE(files_.digest(track()));
    const auto time = fs::last_write_time(track());
    write(folder_ / "other.csv", "xyz");
    fs::last_write_time(folder_ / "other.csv", time);
    fs::rename(folder_ / "other.csv", track());
    EXPECT_FALSE(files_.find_written());
}

TEST_F(KeyedFilesTest, WhatIsWrittenWithTheSameContentIsToldOnce) {
    ASSERT_TRUE(files_.digest(track()));
    make_younger(track());
    EXPECT_EQ(files_.find_written(), track());
    EXPECT_EQ(files_.find_written(), std::nullopt);
}

TEST_F(KeyedFilesTest, AFolderIsAllFilesInIt) {
    ASSERT_TRUE(files_.digest(folder_ / "city"));
    make_younger(folder_ / "city/east/b.obj");
    EXPECT_EQ(files_.find_written(), folder_ / "city");
    write(folder_ / "city/east/c.obj", "c");
    EXPECT_FALSE(files_.find_written());
}

}  // namespace
}  // namespace skyloop
