#include "run/emulator/run_files.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "support/run_parts.hpp"
#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using test::content_of;
using test::TemporaryFolder;
using testing::HasSubstr;

TEST(OutputFile, WritesAllInOrder) {
    const TemporaryFolder folder;
    std::string expected;
    {
        auto file = OutputFile::create(folder / "x");
        ASSERT_TRUE(file);
        for (int i = 0; i < 100'000; ++i) {
            const std::string line = std::to_string(i) + "\n";
            file->write(line);
            expected += line;
        }
        file->write(ByteSpan(to_bytes("end")));
        EXPECT_FALSE(file->failure());
    }
    EXPECT_EQ(content_of(folder / "x"), expected + "end");
}

TEST(OutputFile, FlushHandsOverWhatIsBuffered) {
    const TemporaryFolder folder;
    auto file = OutputFile::create(folder / "x");
    file->write(std::string_view("little"));
    EXPECT_EQ(content_of(folder / "x"), "");
    file->flush();
    EXPECT_EQ(content_of(folder / "x"), "little");
    OutputFile moved = std::move(*file);
    moved.write(std::string_view(" more"));
    moved.flush();
    EXPECT_EQ(content_of(folder / "x"), "little more");
}

TEST(OutputFile, ReplacesAnOldFile) {
    const TemporaryFolder folder;
    std::ofstream(folder / "x") << "a long old content";
    { OutputFile::create(folder / "x")->write(std::string_view("new")); }
    EXPECT_EQ(content_of(folder / "x"), "new");
}

// What the program's standard output was, once the test is over.
class StandardOutputKept {
public:
    StandardOutputKept() : kept_(dup(STDOUT_FILENO)) { std::fflush(stdout); }
    ~StandardOutputKept() {
        dup2(kept_, STDOUT_FILENO);
        close(kept_);
    }
    StandardOutputKept(const StandardOutputKept&) = delete;
    StandardOutputKept& operator=(const StandardOutputKept&) = delete;

private:
    int kept_;
};

TEST(OutputFile, WritesToStandardOutputBehindWhatIsThere) {
    const TemporaryFolder folder;
    std::ofstream(folder / "x") << "head ";
    {
        const StandardOutputKept kept;
        const int shared = open((folder / "x").c_str(), O_WRONLY);
        lseek(shared, 0, SEEK_END);
        dup2(shared, STDOUT_FILENO);
        close(shared);
        OutputFile::standard_output()->write(std::string_view("rows "));
        ASSERT_EQ(::write(STDOUT_FILENO, "tail", 4), 4) << "the descriptor of the program stays open";
    }
    EXPECT_EQ(content_of(folder / "x"), "head rows tail");
}

TEST(OutputFile, FailsWithoutAStandardOutput) {
    const StandardOutputKept kept;
    close(STDOUT_FILENO);
    const auto file = OutputFile::standard_output();
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().message, "standard output: cannot be written: Bad file descriptor");
}

TEST(OutputFile, FailsOnAPathThatCannotBeWritten) {
    const auto file = OutputFile::create("/no/such/folder/x");
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, ErrorCode::outside);
    EXPECT_EQ(file.error().message, "/no/such/folder/x: cannot be written: No such file or directory");
}

TEST(OutputFile, KeepsTheFailureOfAFullDisk) {
    auto file = OutputFile::create("/dev/full");
    ASSERT_TRUE(file);
    file->write(std::string_view("x"));
    EXPECT_FALSE(file->failure()) << "still buffered";
    file->flush();
    ASSERT_TRUE(file->failure());
    EXPECT_EQ(file->failure()->code, ErrorCode::outside);
    EXPECT_THAT(file->failure()->message, HasSubstr("/dev/full: cannot be written: No space left on device"));
    file->write(std::string_view("y"));
    file->flush();
    EXPECT_THAT(file->failure()->message, HasSubstr("No space left")) << "the first failure stays";
}

TEST(OutputFile, KeepsWhatWasWrittenBeforeTheFailure) {
    const TemporaryFolder folder;
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = signal(SIGXFSZ, SIG_IGN);
    const rlimit small{1000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    auto file = OutputFile::create(folder / "x");
    file->write(std::string(900, 'a'));
    file->flush();
    const bool failed_early = file->failure().has_value();
    file->write(std::string(900, 'b'));
    file->flush();
    file->write(std::string(900, 'c'));
    file->flush();
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    EXPECT_FALSE(failed_early);
    ASSERT_TRUE(file->failure());
    EXPECT_THAT(file->failure()->message, HasSubstr("File too large; what was written before is kept"));
    EXPECT_EQ(content_of(folder / "x"), std::string(900, 'a') + std::string(100, 'b'));
}

}  // namespace
}  // namespace skyloop
