// A whole run of the program on a virtual USB serial device, which this process plays.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "eventually.hpp"
#include "mock_cdc_acm.hpp"
#include "testbed.hpp"

extern char** environ;

namespace skyloop {
namespace {

using mock::eventually;
using mock::MockCdcAcm;
using testing::HasSubstr;

const char* const place = "1546:01a8:A1";

mock::DeviceSpec board(std::uint8_t address) {
    return {{0x1546, 0x01a8}, "u-blox AG", "u-blox GNSS receiver", "A1", mock::cdc_acm_configuration(), "1", address};
}

// The program, with this process' virtual devices; what it says lies in a file.
class Program {
public:
    explicit Program(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), SKYLOOP_PROGRAM);
        std::vector<char*> pointers;
        for (std::string& argument : arguments)
            pointers.push_back(argument.data());
        pointers.push_back(nullptr);
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_addopen(&files, STDERR_FILENO, log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        EXPECT_EQ(posix_spawn(&pid_, SKYLOOP_PROGRAM, &files, nullptr, pointers.data(), environ), 0);
        posix_spawn_file_actions_destroy(&files);
    }
    ~Program() {
        if (pid_ > 0) (void)kill(pid_, SIGKILL);
        (void)code();
        (void)std::remove(log_.c_str());
    }
    // Waits for its end.
    int code() {
        int status = 0;
        if (pid_ > 0) (void)waitpid(std::exchange(pid_, 0), &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    std::string said() const {
        std::ifstream in(log_);
        std::stringstream text;
        text << in.rdbuf();
        return text.str();
    }

private:
    std::string log_ = testing::TempDir() + "/skyloop_usb_run_" + std::to_string(getpid());
    pid_t pid_ = 0;
};

std::vector<std::string> run(const std::string& seconds) {
    return {"run",        "--port", std::string("usb:") + place, "--start", "2026-03-01T00:00:00Z", "--model", "ideal",
            "--duration", seconds};
}

bool hears_fix(MockCdcAcm& device) {
    return eventually([&] { return to_string(device.heard()).find("GGA,") != std::string::npos; });
}

TEST(UsbRun, TheReceiverSpeaksOnTheDeviceAtItsSpeed) {
    mock::Testbed bed;
    auto device = std::make_shared<MockCdcAcm>();
    bed.plug_in(board(4), device);
    Program program(run("3"));
    EXPECT_TRUE(hears_fix(*device)) << program.said();
    EXPECT_EQ(program.code(), 0) << program.said();
    ASSERT_FALSE(device->codings().empty());
    EXPECT_EQ(device->codings().back().baud(), 9600U) << "the board's own";
    EXPECT_EQ(device->driver(0), "cdc_acm") << "given back";
}

TEST(UsbRun, UnpluggedAndBackWhileItRuns) {
    mock::Testbed bed;
    auto device = std::make_shared<MockCdcAcm>();
    bed.plug_in(board(4), device);
    Program program(run("8"));
    ASSERT_TRUE(hears_fix(*device)) << program.said();
    bed.unplug(board(4));
    EXPECT_TRUE(eventually([&] { return program.said().find("is gone") != std::string::npos; })) << program.said();
    auto back = std::make_shared<MockCdcAcm>();
    bed.plug_in(board(5), back);
    EXPECT_TRUE(hears_fix(*back)) << program.said();
    EXPECT_THAT(program.said(), HasSubstr("1546:01a8:A1 (usb) is back, at 1-1"));
    EXPECT_EQ(program.code(), 0) << program.said();
}

}  // namespace
}  // namespace skyloop
