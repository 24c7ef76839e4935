// Who sees to what a program leaves behind when it is killed; here that program is a child of the test.
#include "base/core/watchdog_process.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;

std::string told_in(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

// Each program says "begun", and two seconds later "late", unless somebody ends it; the run of them ends as `how` says.
int leave_programs(const std::vector<std::filesystem::path>& files, const std::function<void()>& how) {
    const pid_t child = ::fork();
    if (child == 0) {
        const auto watchdog = OrphanWatchdog::start();
        std::atomic<std::size_t> heard_of = 0;
        std::vector<std::thread> running;
        for (const auto& file : files)
            running.emplace_back([&] {
                ProcessRequest request;
                // In the background, so that it is no child of whoever is killed first.
                request.command = {"/bin/sh", "-c", "(sleep 2; echo late >>\"$0\") & echo begun >>\"$0\"; wait",
                                   file.string()};
                // A program may well have begun before the watchdog hears of it, and is nobody's until then.
                request.group = [&, tell = (*watchdog)->listener()](std::optional<int> group) {
                    tell(group);
                    if (group) ++heard_of;
                };
                static_cast<void>(run_process(request));
            });
        for (const auto& file : files)
            while (told_in(file).empty() || heard_of < files.size())
                std::this_thread::sleep_for(5ms);
        how();
        for (std::thread& one : running)
            one.join();
        ::_exit(0);
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

TEST(OrphanWatchdog, EndsTheProgramsOfOneThatIsKilled) {
    const test::TemporaryFolder folder;
    const std::vector<std::filesystem::path> files{folder / "told", folder / "beside"};
    EXPECT_EQ(leave_programs(files, [] { ::kill(::getpid(), SIGKILL); }), SIGKILL);
    std::this_thread::sleep_for(2500ms);
    for (const auto& file : files)
        EXPECT_EQ(told_in(file), "begun\n");
}

TEST(OrphanWatchdog, LeavesAloneWhatEndsByItself) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(leave_programs({folder / "told"}, [] {}), 0);
    EXPECT_EQ(told_in(folder / "told"), "begun\nlate\n");
}

}  // namespace
}  // namespace skyloop
