#include "base/core/files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "support/packed.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// "skyloop\n" as `gzip -n9` packs it.
constexpr unsigned char packed[] = {0x1f, 0x8b, 0x08, 0x00, 0x00, 0x00, 0x00, 0x00, 0x02, 0x03, 0x2b, 0xce, 0xae, 0xcc,
                                    0xc9, 0xcf, 0x2f, 0xe0, 0x02, 0x00, 0xe0, 0x6c, 0x87, 0x51, 0x08, 0x00, 0x00, 0x00};

/// Each test has an empty folder of its own.
class ReadTextFile : public testing::Test {
protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "skyloop-text-XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path write(const std::string& name, const std::string& content) const {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return folder_ / name;
    }
    [[nodiscard]] const fs::path& folder() const { return folder_; }

private:
    fs::path folder_;
};

std::string packed_text() { return {std::begin(packed), std::end(packed)}; }

void expect_error(const Result<std::string>& result, ErrorCode code, const std::string& part, const fs::path& path) {
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, code);
    EXPECT_THAT(result.error().message, HasSubstr(part));
    EXPECT_THAT(result.error().message, HasSubstr(path.string()));
    EXPECT_EQ(result.error().message.find('\n'), std::string::npos);
}

TEST_F(ReadTextFile, PlainTextComesBackByteForByte) {
    const std::string content("one\r\ntwo\0three\xff", 15);
    EXPECT_EQ(read_text_file(write("a.txt", content)).value(), content);
    EXPECT_EQ(read_text_file(write("empty", "")).value(), "");
    EXPECT_EQ(read_text_file(write("one", "\x1f")).value(), "\x1f");
    const std::string longer(200'000, 'x');  // more than one block
    EXPECT_EQ(read_text_file(write("long", longer)).value(), longer);
}

TEST_F(ReadTextFile, GzipIsKnownByItsContent) {
    EXPECT_EQ(read_text_file(write("a.gz", packed_text())).value(), "skyloop\n");
    EXPECT_EQ(read_text_file(write("a.txt", packed_text())).value(), "skyloop\n");
    EXPECT_EQ(read_text_file(write("twice.gz", packed_text() + packed_text())).value(), "skyloop\nskyloop\n");
    EXPECT_EQ(read_text_file(write("plain.gz", "not packed\n")).value(), "not packed\n");
}

TEST_F(ReadTextFile, DamagedGzipIsRefused) {
    for (const std::size_t at : {12u, 20u, 21u, 24u}) {  // data, checksum, length
        std::string bytes = packed_text();
        bytes[at] = static_cast<char>(bytes[at] ^ 0x5a);
        const fs::path path = write("damaged.gz", bytes);
        const Result<std::string> result = read_text_file(path);
        ASSERT_FALSE(result.has_value()) << "byte " << at;
        EXPECT_EQ(result.error().code, ErrorCode::input);
        EXPECT_THAT(result.error().message, HasSubstr(path.string()));
    }
}

TEST_F(ReadTextFile, GzipCutOffAnywhereIsRefused) {
    for (std::size_t length = 2; length < sizeof(packed); ++length) {
        const fs::path path = write("cut.gz", packed_text().substr(0, length));
        SCOPED_TRACE(length);
        expect_error(read_text_file(path), ErrorCode::input, "gzip", path);
    }
}

TEST_F(ReadTextFile, OtherPackingsAreKnownByTheirContent) {
    for (const char* filter : {"compress", "bzip2", "xz", "zstd"})
        EXPECT_EQ(read_text_file(write("a.rnx", test::compressed(filter, "skyloop\n"))).value(), "skyloop\n") << filter;
    const std::string zip = test::archive_of("zip", {{"in/a.rnx", "skyloop\n"}});
    EXPECT_EQ(read_text_file(write("a.zip", zip)).value(), "skyloop\n");
    EXPECT_EQ(read_uncompressed(write("a.zip.xz", test::compressed("xz", zip))).value(), zip);
    const fs::path path = write("a.zip", zip.substr(0, 60));
    expect_error(read_text_file(path), ErrorCode::input, "no whole zip archive", path);
}

TEST_F(ReadTextFile, WhatIsNotAFileIsRefused) {
    const fs::path missing = folder() / "missing.txt";
    expect_error(read_text_file(missing), ErrorCode::outside, "No such file", missing);
    expect_error(read_text_file(folder()), ErrorCode::outside, "not a regular file", folder());
    expect_error(read_text_file("/dev/null"), ErrorCode::outside, "not a regular file", "/dev/null");
}

TEST_F(ReadTextFile, AFifoWithoutAWriterDoesNotHang) {
    const fs::path fifo = folder() / "fifo";
    ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
    expect_error(read_text_file(fifo), ErrorCode::outside, "not a regular file", fifo);
}

TEST_F(ReadTextFile, AFileThatMayNotBeReadIsRefused) {
    if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
    const fs::path path = write("secret", "x");
    fs::permissions(path, fs::perms::none);
    expect_error(read_text_file(path), ErrorCode::outside, "Permission denied", path);
}

TEST_F(ReadTextFile, MoreThanTheLimitIsRefused) {
    const fs::path plain = write("plain", std::string(1001, 'x'));
    EXPECT_TRUE(read_text_file(plain, 1001).has_value());
    expect_error(read_text_file(plain, 1000), ErrorCode::input, "more than 1000 bytes", plain);
    const fs::path small = write("small.gz", packed_text());
    EXPECT_TRUE(read_text_file(small, 8).has_value());
    const fs::path large = write("large", std::string(3'000'000, 'x'));
    expect_error(read_text_file(large, 1000), ErrorCode::input, "more than 1000 bytes", large);
    expect_error(read_text_file(small, 7), ErrorCode::input, "more than 7 bytes", small);
}

}  // namespace
}  // namespace skyloop
