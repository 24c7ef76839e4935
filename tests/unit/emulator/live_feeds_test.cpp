// What becomes of a run whose source of truth falls silent.
#include "run/emulator/live_feeds.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <thread>

#include "base/core/file_descriptor.hpp"
#include "base/core/threads.hpp"
#include "run/emulator/assembly.hpp"
#include "support/run_parts.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using test::emulator_scenario;

// A source on the same machine, and the run that it flies in.
class LiveFeedsTest : public testing::Test {
protected:
    void open(const std::string& clock, const std::string& lost_after_s = "0.2",
              const std::string& when_lost = "outage") {
        open_scenario(
            "[trajectory]\nkind = \"live\"\n"
            "source = \"udp-json:0\"\nwhen_lost = \"" +
            when_lost + "\"\nlost_after_s = " + lost_after_s + "\nclock = \"" + clock + "\"\n");
    }
    void open_scenario(const std::string& text) {
        scenario_ = emulator_scenario("[run]\nstart = 2024-03-05T12:00:00Z\n" + text);
        auto feeds = LiveFeeds::open(scenario_, nullptr);
        ASSERT_TRUE(feeds) << feeds.error().message;
        feeds_ = std::move(*feeds);
        start_ = *scenario_.run.start;
        feeds_->begin(start_, steady_clock_ns());
        point_to(feeds_->descriptions().at(0));
    }
    // From now on say() is heard there. @param name of a feed
    void point_to(const std::string& name) const {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(name.substr(name.rfind(':') + 1))));
        ASSERT_EQ(::connect(source_.value(), reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    }
    void say(const std::string& line) const {
        ASSERT_EQ(::send(source_.value(), line.data(), line.size(), 0), static_cast<ssize_t>(line.size()));
    }
    void say(double t) const { say(fmt::format(R"({{"t":{:.3f},"lla":[48,11,500],"h_ref":"ell"}})", t)); }
    void say_step(double t) const { say(fmt::format(R"({{"type":"step","t":{:.3f}}})", t)); }
    // The first command that is asked for at `now`, within two seconds.
    std::optional<Command> command_at(GpsTime now, std::chrono::milliseconds patience = 2s) {
        const auto end = std::chrono::steady_clock::now() + patience;
        while (std::chrono::steady_clock::now() < end) {
            auto commands = feeds_->pump(now, std::nullopt);
            if (!commands.empty()) return commands.front();
            std::this_thread::sleep_for(5ms);
        }
        return std::nullopt;
    }
    bool reaches(GpsTime horizon) {
        for (int i = 0; i < 400; ++i) {
            EXPECT_TRUE(feeds_->pump(start_, std::nullopt).empty());
            if (feeds_->horizon() == horizon) return true;
            std::this_thread::sleep_for(5ms);
        }
        return false;
    }

    Scenario scenario_;
    std::unique_ptr<LiveFeeds> feeds_;
    GpsTime start_;
    FileDescriptor source_{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
};

TEST(LiveFeeds, ContradictionsAreToldWhereTheyStand) {
    const auto refused = [](const std::string& text) {
        Scenario scenario = emulator_scenario(text);
        const auto feeds = LiveFeeds::open(scenario, nullptr);
        return feeds ? "accepted" : feeds.error().message;
    };
    const auto receiver = [](const std::string& source, const std::string& clock) {
        return "[[receiver]]\n[receiver.trajectory]\nkind = \"live\"\nsource = \"" + source + "\"\nclock = \"" + clock +
               "\"\n";
    };
    using testing::StartsWith;
    EXPECT_THAT(refused(receiver("udp-json:0", "realtime") + receiver("udp-json:0", "follow")),
                StartsWith("test.toml:9:10: receiver.trajectory.source: \"udp-json:0\" is asked for with clock = "
                           "\"realtime\" and with clock = \"follow\""));
    EXPECT_THAT(refused(receiver("udp-json:0", "follow") + receiver("udp-json:127.0.0.1:0", "follow")),
                StartsWith("test.toml:9:10: receiver.trajectory.source: two sources would lead the run's time, "));
    EXPECT_THAT(refused("[run]\nspeed = 2\n" + receiver("udp-json:0", "realtime")),
                StartsWith("test.toml:2:9: run.speed: is 2, and a live trajectory with clock = \"realtime\""));
}

// Why nothing comes of commands.
class Refusals : public RunObserver {
public:
    void on_command(const CommandSeen& seen) override { told.emplace_back(seen.ignored); }
    std::vector<std::string> told;
};

// Of a scenario. @param clock of its feed
Result<Assembly> live_assembly(const std::string& clock, const std::string& rest = "") {
    RunMode mode;
    mode.now = to_gps_time(2400, 0);
    mode.now_steady_ns = steady_clock_ns();
    return assemble(emulator_scenario("[model]\nname = \"ideal\"\n[trajectory]\nkind = \"live\"\n"
                                      "source = \"udp-json:0\"\nclock = \"" +
                                      clock + "\"\n[[receiver]]\nport = \"pty\"\n" + rest),
                    test::emulator_data(), mode);
}

TEST_F(LiveFeedsTest, WhatASourceHasCountedAndHasNotComeIsToldOf) {
    const auto assembly = live_assembly("realtime");
    ASSERT_TRUE(assembly) << assembly.error().message;
    const LiveFeeds& feeds = *assembly->emulator->feeds();
    point_to(feeds.descriptions().at(0));
    for (const int number : {1, 5})
        say(fmt::format(R"({{"t":{0},"seq":{0},"lla":[48,11,500],"h_ref":"ell"}})", number));
    for (int i = 0; i < 400 && feeds.reports().at(0).counts.lost < 3; ++i)
        std::this_thread::sleep_for(5ms);
    EXPECT_THAT(run_summary(emulator_scenario(""), *assembly, "0"), testing::HasSubstr("\"lost\": 3"));
}

TEST(LiveFeeds, KeepTheSpeedOfTheRun) {
    const auto told = [](const std::string& clock) {
        auto assembly = live_assembly(clock, "[[command]]\nkind = \"speed\"\nfactor = 2\nat_s = 0\n");
        EXPECT_TRUE(assembly) << assembly.error().message;
        Refusals refusals;
        if (!assembly) return refusals.told;
        EXPECT_THAT(assembly->warnings, testing::Contains(testing::HasSubstr("[[command]] 'speed' will do nothing: ")));
        assembly->emulator->add_observer(&refusals);
        assembly->emulator->run_until(GpsTime::max(), std::atomic<bool>{true});
        return refusals.told;
    };
    EXPECT_THAT(told("realtime"), testing::ElementsAre("a live trajectory with clock = \"realtime\" runs at 1"));
    EXPECT_THAT(told("follow"), testing::ElementsAre("the live source leads the run's time"));
}

TEST_F(LiveFeedsTest, AnOutageLastsForTheTimeThatARunThatFollowsHasYetToGo) {
    open("follow");
    say(10);
    ASSERT_TRUE(reaches(start_));
    auto begun = command_at(start_);
    ASSERT_TRUE(begun);
    EXPECT_EQ(begun->verb, CommandVerb::start_fault);
    say(13);
    EXPECT_TRUE(reaches(start_ + 3s)) << "the run has not gone there yet: the signals stay away";
    say(13.1);
    EXPECT_FALSE(command_at(start_ + 2900ms, 50ms));
    const auto ended = command_at(start_ + 3s);
    ASSERT_TRUE(ended);
    EXPECT_EQ(ended->verb, CommandVerb::stop_fault);
    EXPECT_FALSE(command_at(start_ + 3s, 50ms)) << "once";
}

TEST_F(LiveFeedsTest, ASecondSilenceBeforeTheEndOfAnOutageGoesOnWithIt) {
    open("follow");
    say(10);
    ASSERT_TRUE(reaches(start_));
    ASSERT_TRUE(command_at(start_));
    say(13);
    ASSERT_TRUE(reaches(start_ + 3s));
    EXPECT_FALSE(command_at(start_ + 1s, 500ms)) << "lost again, with the signals still gone";
    say(15);
    EXPECT_FALSE(command_at(start_ + 3s, 50ms));
    const auto ended = command_at(start_ + 5s);
    ASSERT_TRUE(ended);
    EXPECT_EQ(ended->verb, CommandVerb::stop_fault);
}

TEST_F(LiveFeedsTest, ASourceThatWaitsForItsStepIsNotSilent) {
    open("lock_step");
    say(10);
    say_step(10.1);
    ASSERT_TRUE(reaches(start_ + 100ms));
    EXPECT_FALSE(command_at(start_, 600ms)) << "the step takes longer than silence may";
    feeds_->rest(0);
    const auto begun = command_at(start_ + 100ms);
    ASSERT_TRUE(begun) << "and now it has the word";
    EXPECT_EQ(begun->verb, CommandVerb::start_fault);
}

TEST_F(LiveFeedsTest, ASourceThatOnlyStepsIsHeard) {
    open("lock_step", "0.8");
    say(10);
    for (int i = 1; i <= 20; ++i) {
        say_step(10 + 0.1 * i);
        ASSERT_TRUE(reaches(start_ + i * 100ms)) << i;
        feeds_->rest(0);  // up to 50 ms
        std::this_thread::sleep_for(50ms);
    }
}

TEST_F(LiveFeedsTest, ASourceThatOnlyTellsOfItsClockIsHeard) {
    open("realtime", "0.8");
    say(10);
    for (int i = 0; i < 20; ++i) {
        say(R"({"type":"clock","paused":true})");
        EXPECT_FALSE(command_at(start_, 80ms)) << i;
    }
}

TEST_F(LiveFeedsTest, APauseOfTheSourceInRealTimePausesTheRunThatPausesWithoutTruth) {
    open("realtime", "100", "pause");
    say(10);
    say(R"({"type":"clock","paused":true})");
    const auto halted = command_at(start_);
    ASSERT_TRUE(halted);
    EXPECT_EQ(halted->verb, CommandVerb::pause);
    EXPECT_THAT(feeds_->take_news(), testing::Contains(testing::HasSubstr("has paused; time stands still")));
    EXPECT_FALSE(command_at(start_, 50ms)) << "once";
    say(R"({"type":"clock","paused":false})");
    const auto goes_on = command_at(start_);
    ASSERT_TRUE(goes_on);
    EXPECT_EQ(goes_on->verb, CommandVerb::resume);
    EXPECT_EQ(halted->source, silence_source);
    EXPECT_EQ(goes_on->source, silence_source);
}

TEST_F(LiveFeedsTest, ARunThatStandsStillForTwoSourcesWaitsForBoth) {
    std::string text;
    for (const char* source : {"udp-json:0", "udp-json:127.0.0.1:0"})
        text += std::string("[[receiver]]\n[receiver.trajectory]\nkind = \"live\"\nwhen_lost = \"pause\"\n") +
                "lost_after_s = 100\nsource = \"" + source + "\"\n";
    open_scenario(text);
    for (const std::size_t feed : {0u, 1u}) {
        point_to(feeds_->descriptions().at(feed));
        say(10);
        say(R"({"type":"clock","paused":true})");
        const auto halted = command_at(start_);
        ASSERT_TRUE(halted);
        EXPECT_EQ(halted->verb, CommandVerb::pause);
    }
    say(R"({"type":"clock","paused":false})");
    EXPECT_FALSE(command_at(start_, 200ms)) << "the first one still stands";
    point_to(feeds_->descriptions().at(0));
    say(R"({"type":"clock","paused":false})");
    const auto goes_on = command_at(start_);
    ASSERT_TRUE(goes_on);
    EXPECT_EQ(goes_on->verb, CommandVerb::resume);
}

TEST_F(LiveFeedsTest, APauseOfTheSourceInRealTimeIsToldOnce) {
    open("realtime", "100");
    say(10);
    for (int i = 0; i < 3; ++i) {
        say(R"({"type":"clock","paused":true})");
        EXPECT_FALSE(command_at(start_, 100ms));
        say(R"({"type":"clock","paused":false})");
        EXPECT_FALSE(command_at(start_, 100ms));
    }
    EXPECT_THAT(feeds_->take_news(), testing::ElementsAre(testing::HasSubstr("has paused; the run goes on")));
}

TEST_F(LiveFeedsTest, ASourceWithoutAPositionIsReportedOnce) {
    open("realtime", "0.2");
    EXPECT_FALSE(command_at(start_, 500ms)) << "it is waited for, not lost";
    EXPECT_THAT(feeds_->take_news(),
                testing::ElementsAre(testing::AllOf(testing::HasSubstr(": no position in the first 0."),
                                                    testing::EndsWith(" s: nothing was received"))));
    say(10);
    for (int i = 0; i < 400 && feeds_->reports().at(0).counts.samples == 0; ++i)
        std::this_thread::sleep_for(5ms);
    EXPECT_FALSE(command_at(start_, 50ms));
    EXPECT_THAT(feeds_->take_news(), testing::IsEmpty());
}

TEST_F(LiveFeedsTest, WhatCameWithoutAPositionIsReported) {
    open("realtime", "0.5");
    say(R"({"type":"clock","paused":false})");
    say("no JSON at all\n");
    EXPECT_FALSE(command_at(start_, 900ms));
    EXPECT_THAT(feeds_->take_news(),
                testing::Contains(
                    testing::EndsWith(" s: 46 bytes were received, none of them a position; 1 messages were refused")));
}

TEST_F(LiveFeedsTest, ASourceWithPositionsIsNotReported) {
    open("realtime", "0.2", "hold");
    say(10);
    (void)command_at(start_, 500ms);
    EXPECT_THAT(feeds_->take_news(), testing::Not(testing::Contains(testing::HasSubstr("no position"))));
}

TEST(LiveFeeds, EachVehicleOfASourceHasAPlaceOfItsOwnBefore) {
    Scenario scenario = emulator_scenario(R"toml(
[run]
start = 2024-03-05T12:00:00Z
[[receiver]]
[receiver.trajectory]
kind = "live"
source = "udp-json:0"
vehicle_id = "a"
at = [1, 2, 3]
[[receiver]]
[receiver.trajectory]
kind = "live"
source = "udp-json:0"
vehicle_id = "b"
at = [4, 5, 6]
delay_s = 2
)toml");
    const auto feeds = LiveFeeds::open(scenario, nullptr);
    ASSERT_TRUE(feeds) << feeds.error().message;
    EXPECT_EQ((*feeds)->descriptions().size(), 1u);
    const auto latitude = [&](std::size_t receiver) {
        const auto& live = std::get<LiveSettings>(*scenario.receivers.at(receiver).trajectory);
        return live.path->at(*scenario.run.start).geodetic.latitude.deg();
    };
    EXPECT_EQ(latitude(0), 1);
    EXPECT_EQ(latitude(1), 4);
}

TEST(LiveFeeds, LockStepNeedsASourceThatSteps) {
    const auto why_not = [](const std::string& source, const std::string& clock) -> std::string {
        Scenario scenario =
            emulator_scenario("[run]\nstart = 2024-03-05T12:00:00Z\n[trajectory]\nkind = \"live\"\nsource = \"" +
                              source + "\"\nclock = \"" + clock + "\"\n");
        const auto checked = LiveFeeds::check(scenario);
        return checked ? "" : checked.error().message;
    };
    for (const char* source : {"px4:4560,127.0.0.1:4561", "mavlink-udp", "flightgear", "xplane:127.0.0.1"}) {
        EXPECT_THAT(why_not(source, "lock_step"), testing::HasSubstr("expected clock = \"follow\"")) << source;
        EXPECT_EQ(why_not(source, "follow"), "") << source;
    }
    for (const char* source : {"udp-json", "tcp-json", "json-to:127.0.0.1:5000"})
        EXPECT_EQ(why_not(source, "lock_step"), "") << source;
    Scenario scenario = emulator_scenario(
        "[run]\nstart = 2024-03-05T12:00:00Z\n[trajectory]\nkind = \"live\"\nsource = \"flightgear:0\"\nclock = "
        "\"lock_step\"\n");
    const auto feeds = LiveFeeds::open(scenario, nullptr);
    ASSERT_FALSE(feeds);
    EXPECT_EQ(feeds.error().code, ErrorCode::usage);
}

TEST_F(LiveFeedsTest, WhatASourceAsksForInVainIsTold) {
    open("realtime");
    const auto told_of = [&](const std::string& asks, const std::string& ignored) {
        const Command command{CommandVerb::start_fault, Parameters({{"fault", std::string("zz")}}), {}, asks};
        feeds_->on_command({start_, "start_fault", command, ignored});
        return feeds_->take_news();
    };
    EXPECT_THAT(told_of("feed", "no fault is called zz"),
                testing::ElementsAre(testing::HasSubstr(": start_fault is not done: no fault is called zz")));
    EXPECT_THAT(told_of("http", "no fault is called zz"), testing::IsEmpty()) << "who asked has been told";
    EXPECT_THAT(told_of("feed", ""), testing::IsEmpty());
}

TEST_F(LiveFeedsTest, AnOutageInRealTimeEndsAtOnce) {
    open("realtime");
    say(10);
    const auto begun = command_at(start_);
    ASSERT_TRUE(begun);
    EXPECT_EQ(begun->verb, CommandVerb::start_fault);
    say(13);
    const auto ended = command_at(start_);
    ASSERT_TRUE(ended);
    EXPECT_EQ(ended->verb, CommandVerb::stop_fault);
}

}  // namespace
}  // namespace skyloop
