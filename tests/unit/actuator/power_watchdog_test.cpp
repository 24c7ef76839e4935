// Who restores when the program cannot: a process that dies, here a child of the test.
#include "wire/actuator/power_watchdog.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <functional>

#include "told_orders.hpp"
#include "wire/actuator/actuator_uri.hpp"
#include "wire/actuator/power_switch.hpp"

namespace skyloop {
namespace {

std::string command_into(const std::string& file) {
    return "command:sh -c 'echo cut >>\"$1\"' - '" + file + "'|sh -c 'echo on >>\"$1\"' - '" + file + "'";
}

// Runs it in a process of its own that ends by itself or by a signal; gives that signal, or 0.
int die_in(const std::function<void()>& run) {
    const pid_t child = ::fork();
    if (child == 0) {
        run();
        ::_exit(0);
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

std::unique_ptr<PowerWatchdog> watch(const std::vector<std::string>& wards) {
    auto watchdog = PowerWatchdog::start(wards);
    return watchdog ? std::move(*watchdog) : nullptr;
}

TEST(PowerWatchdog, RestoresAfterAKill) {
    const test::TemporaryFolder folder;
    const std::string first = (folder / "first").string(), second = (folder / "second").string();
    const int by = die_in([&] {
        const auto watchdog = watch({command_into(first), command_into(second)});
        static_cast<void>(watchdog->note_cut(1));
        ::kill(::getpid(), SIGKILL);
    });
    EXPECT_EQ(by, SIGKILL);
    EXPECT_TRUE(eventually([&] { return text_of(second) == "on\n"; })) << text_of(second);
    EXPECT_EQ(text_of(first), "") << "it had not been cut";
}

TEST(PowerWatchdog, EndsACutThatIsStillUnderWay) {
    const test::TemporaryFolder folder;
    const std::string file = (folder / "state").string();
    const std::string power = "command:sh -c 'echo begun >>\"$1\"; sleep 3; echo cut >>\"$1\"' - '" + file +
                              "'|sh -c 'echo on >>\"$1\"' - '" + file + "'";
    const int by = die_in([&] {
        const auto watchdog = watch({power});
        const auto running = PowerSwitch::start({power, [&] { return open_actuator(power); }, watchdog.get(), 0});
        (*running)->want(PowerState::cut);
        static_cast<void>(eventually([&] { return text_of(file) == "on\nbegun\n"; }));
        ::kill(::getpid(), SIGKILL);
    });
    EXPECT_EQ(by, SIGKILL);
    EXPECT_TRUE(eventually([&] { return text_of(file) == "on\nbegun\non\n"; })) << text_of(file);
    std::this_thread::sleep_for(std::chrono::milliseconds(3200));  // longer than that cut takes
    EXPECT_EQ(text_of(file), "on\nbegun\non\n");
}

TEST(PowerWatchdog, RestoresAgainWhatIsCutBehindItsBack) {
    const test::TemporaryFolder folder;
    const std::string file = (folder / "state").string();
    // The first restore lasts only for a moment.
    const std::string power =
        "command:true|sh -c 'test -s \"$1\" || echo cut >>\"$1\"; echo on >>\"$1\".all; test $(wc "
        "-l <\"$1\".all) = 1 || echo on >>\"$1\"' - '" +
        file + "'|tail -n 1 '" + file + "'";
    die_in([&] {
        const auto watchdog = watch({power});
        static_cast<void>(watchdog->note_cut(0));
        ::kill(::getpid(), SIGKILL);
    });
    EXPECT_TRUE(eventually([&] { return text_of(file) == "cut\non\n"; })) << text_of(file);
}

TEST(PowerWatchdog, OutlivesWhatEndsItsProgramInOrder) {
    const test::TemporaryFolder folder;
    const std::string file = (folder / "state").string();
    const int by = die_in([&] {
        ::setpgid(0, 0);
        const auto watchdog = watch({command_into(file)});
        static_cast<void>(watchdog->note_cut(0));
        std::this_thread::sleep_for(std::chrono::milliseconds(200));  // until it is in a session of its own
        ::kill(0, SIGKILL);  // all of the process group, as a terminal's Ctrl-C would
    });
    EXPECT_EQ(by, SIGKILL);
    EXPECT_TRUE(eventually([&] { return text_of(file) == "on\n"; })) << text_of(file);
}

TEST(PowerWatchdog, LeavesAloneWhatHasBeenRestored) {
    const test::TemporaryFolder folder;
    const std::string file = (folder / "state").string();
    EXPECT_EQ(die_in([&] {
                  const auto watchdog = watch({command_into(file)});
                  static_cast<void>(watchdog->note_cut(0));
                  watchdog->note_restored(0);
              }),
              0);
    EXPECT_EQ(text_of(file), "") << "its end has been waited for";
}

TEST(PowerWatchdog, RestoresWhatIsStillNotedAtTheEnd) {
    const test::TemporaryFolder folder;
    const std::string file = (folder / "state").string();
    EXPECT_EQ(die_in([&] {
                  const auto watchdog = watch({command_into(file)});
                  static_cast<void>(watchdog->note_cut(0));
                  watchdog->note_restored(0);
                  static_cast<void>(watchdog->note_cut(0));
              }),
              0);
    EXPECT_EQ(text_of(file), "on\n");
}

TEST(PowerWatchdog, WithoutItNothingIsToBeCut) {
    const auto watchdog = watch({"command:true|true"});
    ASSERT_TRUE(watchdog);
    EXPECT_TRUE(watchdog->note_cut(0));
    watchdog->note_restored(0);
    // Its only child here.
    const std::string children = text_of("/proc/self/task/" + std::to_string(::getpid()) + "/children");
    if (children.empty()) GTEST_SKIP() << "this kernel's /proc tells no children";
    const int child = std::stoi(children);
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    EXPECT_TRUE(eventually([&] { return !watchdog->note_cut(0); }));
}

}  // namespace
}  // namespace skyloop
