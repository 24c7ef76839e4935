// Who sees to what a program leaves behind when it is killed; here that program is a child of the test.
#include "skyloop/base/watchdog_process.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;

std::string told_in(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

// Its own program says "begun", and two seconds later "late", unless somebody ends it; the run of it ends as `how`
// says.
int leave_a_program(const std::filesystem::path& file, const std::function<void()>& how) {
    const pid_t child = ::fork();
    if (child == 0) {
        const auto watchdog = OrphanWatchdog::start();
        ProcessRequest request;
        // In the background, so that it is no child of whoever is killed first.
        request.command = {"/bin/sh", "-c", "(sleep 2; echo late >>\"$0\") & echo begun >>\"$0\"; wait", file.string()};
        request.group = (*watchdog)->listener();
        std::thread running([&] { static_cast<void>(run_process(request)); });
        while (told_in(file).empty())
            std::this_thread::sleep_for(5ms);
        how();
        running.join();
        ::_exit(0);
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

TEST(OrphanWatchdog, EndsTheProgramsOfOneThatIsKilled) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(leave_a_program(folder / "told", [] { ::kill(::getpid(), SIGKILL); }), SIGKILL);
    std::this_thread::sleep_for(2500ms);
    EXPECT_EQ(told_in(folder / "told"), "begun\n");
}

TEST(OrphanWatchdog, LeavesAloneWhatEndsByItself) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(leave_a_program(folder / "told", [] {}), 0);
    EXPECT_EQ(told_in(folder / "told"), "begun\nlate\n");
}

}  // namespace
}  // namespace skyloop
