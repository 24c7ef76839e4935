#include "wire/transport/file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "temporary_folder.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

std::string content(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(FileTransport, WritesAndTruncates) {
    const test::TemporaryFolder folder;
    for (const std::string text : {"a longer first run", "short"}) {
        auto file = FileTransport::open(folder / "out.nmea");
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ((*file)->write(to_bytes(text)), text.size());
        EXPECT_EQ(content(folder / "out.nmea"), text);
        EXPECT_TRUE((*file)->line().connected);
        EXPECT_EQ((*file)->line().baud, std::nullopt);
        EXPECT_EQ((*file)->failure(), "");
        EXPECT_TRUE((*file)->read().empty());
    }
}

// A run that is refused after its wires are open leaves what was there.
TEST(FileTransport, KeepsWhatIsThereUntilItBegins) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "out.nmea") << "a former run";
    ASSERT_TRUE(FileTransport::open(folder / "out.nmea"));
    EXPECT_EQ(content(folder / "out.nmea"), "a former run");
    auto file = FileTransport::open(folder / "out.nmea");
    ASSERT_TRUE(file);
    (*file)->begin();
    EXPECT_EQ(content(folder / "out.nmea"), "");
    EXPECT_EQ((*file)->write(to_bytes("this one")), 8U);
    (*file)->begin();
    EXPECT_EQ(content(folder / "out.nmea"), "this one");
}

TEST(FileTransport, LeavesNothingWhereNothingBegan) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(FileTransport::open(folder / "out.nmea"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out.nmea"));
    auto file = FileTransport::open(folder / "out.nmea");
    ASSERT_TRUE(file);
    (*file)->begin();
    file->reset();
    EXPECT_TRUE(std::filesystem::exists(folder / "out.nmea"));
}

TEST(FileTransport, TakesMoreThanAPipefulAtOnce) {
    const test::TemporaryFolder folder;
    auto file = FileTransport::open(folder / "big");
    ASSERT_TRUE(file);
    EXPECT_EQ((*file)->write(Bytes(1'000'000, 7)), 1'000'000U);
    EXPECT_EQ(std::filesystem::file_size(folder / "big"), 1'000'000U);
}

TEST(FileTransport, SaysThatTheDiskIsFullAndTakesNothing) {
    auto file = FileTransport::open("/dev/full");
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ((*file)->write(to_bytes("abc")), 0U);
    EXPECT_THAT((*file)->failure(), HasSubstr("/dev/full (file): writing failed: No space left on device"));
    EXPECT_EQ((*file)->write(to_bytes("defg")), 0U);
    EXPECT_FALSE((*file)->line().connected);
}

TEST(FileTransport, RefusesWhatCannotBeWritten) {
    const test::TemporaryFolder folder;
    const auto missing = FileTransport::open(folder / "no/such/folder");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::outside);
    EXPECT_THAT(missing.error().message, HasSubstr("no/such/folder: cannot be written: No such file"));
    EXPECT_FALSE(FileTransport::open(folder / ""));
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_FALSE(FileTransport::open(folder / "pipe")) << "nobody reads it";
}

TEST(FileTransport, OutlivesAPipeWhoseReaderStopsOrGoes) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    const int reader = ::open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
    auto file = FileTransport::open(folder / "pipe");
    ASSERT_TRUE(file) << file.error().message;
    const std::size_t taken = (*file)->write(Bytes(1'000'000, 1));
    EXPECT_GE(taken, 4096U);
    EXPECT_LT(taken, 1'000'000U);
    EXPECT_EQ((*file)->failure(), "");
    ::close(reader);
    EXPECT_EQ((*file)->write(to_bytes("abc")), 0U);
    EXPECT_THAT((*file)->failure(), HasSubstr("Broken pipe"));
}

TEST(FileTransport, WritesToStandardOutput) {
    testing::internal::CaptureStdout();
    EXPECT_EQ(FileTransport::standard_output()->write(to_bytes("$GNGLL\r\n")), 8U);
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "$GNGLL\r\n");
}

}  // namespace
}  // namespace skyloop
