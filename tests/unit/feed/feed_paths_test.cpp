#include "run/feed/detail/feed_paths.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "base/geo/local_frame.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

const GpsTime paths_start = GpsTime() + std::chrono::hours(24 * 365 * 46);
constexpr std::int64_t paths_start_ns = 80'000'000'000'000, one_ms = 1'000'000;

// On a circle, as a vehicle that tells its velocity.
TruthSample told_at(double t, double speed_mps = 12) {
    static const LocalFrame frame(Geodetic::degrees(47, 8, 600));
    constexpr double radius_m = 80;
    const double angle = speed_mps / radius_m * t;
    TruthSample sample;
    sample.position = frame.to_ecef(Position<Enu>(radius_m * std::sin(angle), radius_m * std::cos(angle), 0));
    sample.velocity = frame.to_ecef(Velocity<Enu>(speed_mps * std::cos(angle), -speed_mps * std::sin(angle), 0));
    return sample;
}

struct PathsUnderTest {
    explicit PathsUnderTest(ClockMode mode) : paths(settings_of(mode), desk) {
        path = paths.path("");
        paths.begin(paths_start, paths_start_ns);
    }
    static FeedSettings settings_of(ClockMode mode) {
        FeedSettings settings;
        settings.clock = mode;
        settings.path.before = Geodetic::degrees(1, 2, 3);
        return settings;
    }
    void say(FeedItem item) {
        std::vector<FeedItem> items{std::move(item)};
        desk.inbox.put(items);
    }
    void take(std::int64_t now_ns) { paths.take(now_ns); }
    std::vector<std::string> news() { return desk.news.take(); }

    FeedDesk desk;
    FeedPaths paths;
    std::shared_ptr<LivePath> path;
};

TEST(FeedPaths, TellsOnceThatASourceDoesNotKeepRealTime) {
    for (const double rate : {0.9, 0.95, 1.0, 1.1}) {
        std::mt19937 random(31);
        std::uniform_real_distribution<double> delay_ms(0, 5);
        PathsUnderTest feed(ClockMode::realtime);
        int told = 0;
        for (int i = 0; i < 20 * 50; ++i) {
            TruthSample sample = told_at(0.02 * i);
            sample.source_time = 100s + i * 20ms;
            sample.received_ns = paths_start_ns + std::llround((20 * i / rate + delay_ms(random)) * one_ms);
            const std::int64_t now_ns = sample.received_ns;
            feed.say(std::move(sample));
            feed.paths.set_run(paths_start + Nanoseconds(now_ns - paths_start_ns), now_ns);  // as the loop does
            feed.take(now_ns);
            for (const std::string& sentence : feed.news())
                if (sentence.find("of real time; expected 1") != std::string::npos) {
                    ++told;
                    EXPECT_LT(now_ns, paths_start_ns + 11'000 * one_ms) << rate;
                    EXPECT_THAT(sentence, HasSubstr(std::to_string(rate).substr(0, 3))) << rate;
                }
        }
        EXPECT_EQ(told, rate == 1 ? 0 : 1) << rate;
    }
}

TEST(FeedPaths, TellsTheRateOfASourceWhoseClockHasJustStepped) {
    constexpr double rate = 0.9;
    PathsUnderTest feed(ClockMode::realtime);
    std::vector<std::string> told;
    for (int i = 0; i < 10 * 50; ++i) {
        TruthSample sample = told_at(0.02 * i);
        sample.source_time = 100s + i * 20ms + (i > 200 ? 5s : 0s);  // 4.5 s after the start
        sample.received_ns = paths_start_ns + std::llround(20 * i / rate * one_ms);
        const std::int64_t now_ns = sample.received_ns;
        feed.say(std::move(sample));
        feed.paths.set_run(paths_start + Nanoseconds(now_ns - paths_start_ns), now_ns);
        feed.take(now_ns);
        for (std::string& sentence : feed.news())
            told.push_back(std::move(sentence));
    }
    EXPECT_THAT(told, testing::Contains(HasSubstr("clock stepped")));
    EXPECT_THAT(told, testing::Contains(HasSubstr("runs at 0.90 of real time")).Times(1));
}

TEST(FeedNewsDesk, WhatIsSaidOnceIsKeptBackByAFullDeskAlone) {
    FeedNewsDesk desk;
    desk.tell(FeedNewsDesk::Kind::clock, "first", 0);
    desk.tell(FeedNewsDesk::Kind::clock, "too soon", one_ms);
    EXPECT_TRUE(desk.tell_once("once"));
    EXPECT_THAT(desk.take(), testing::ElementsAre("first", "once"));
    desk.tell(FeedNewsDesk::Kind::clock, "later", 6000 * one_ms);
    EXPECT_THAT(desk.take(), testing::ElementsAre("later (and 1 times before)"));
    for (int i = 0; i < 64; ++i)
        EXPECT_TRUE(desk.tell_once("many"));
    EXPECT_FALSE(desk.tell_once("too many"));
    EXPECT_EQ(desk.take().size(), 64u);
    EXPECT_TRUE(desk.tell_once("again"));
}

// The largest error of the path's velocity against the source's own, m/s: asked a little late, so that the samples on
// both sides are there, from `from_s` on.
double velocity_error_mps(double scatter_ms, double lost, double from_s, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> delay_ms(0, scatter_ms), lot(0, 1);
    PathsUnderTest feed(ClockMode::realtime);
    double worst = 0;
    for (int i = 0; i < 8 * 50; ++i) {
        const double late_ms = delay_ms(random);
        const std::int64_t now_ns = paths_start_ns + std::llround((20 * i + late_ms) * one_ms);
        if (i < 1 || lot(random) >= lost) {
            TruthSample sample = told_at(0.02 * i);
            sample.received_ns = now_ns;
            feed.say(std::move(sample));
        }
        feed.take(now_ns);
        for (double t = 0.02 * i - 0.2; t < 0.02 * i - 0.18; t += 0.005) {
            if (t < from_s) continue;
            const Eigen::Vector3d velocity = feed.path->at(advanced(paths_start, Seconds(t))).velocity.vector();
            worst = std::max(worst, (velocity - told_at(t).velocity->vector()).norm());
        }
    }
    EXPECT_EQ(feed.path->counts().jumps, 0u);
    EXPECT_EQ(feed.path->counts().late, 0u);
    return worst;
}

TEST(FeedPaths, ArrivalsThatScatterDoNotShakeAVehicleWhoseSourceHasNoTime) {
    for (const double scatter_ms : {5.0, 10.0, 15.0})
        for (unsigned seed = 1; seed <= 6; ++seed) {
            EXPECT_LT(velocity_error_mps(scatter_ms, 0, 1.5, seed), 1) << scatter_ms << " " << seed;
            EXPECT_LT(velocity_error_mps(scatter_ms, 0, 0.1, seed), 6) << scatter_ms << " " << seed;
        }
}

TEST(FeedPaths, NeitherDoLossesAmongThem) {
    for (const double lost : {0.02, 0.2})
        for (unsigned seed = 1; seed <= 6; ++seed)
            EXPECT_LT(velocity_error_mps(15, lost, 1.5, seed), 1) << lost << " " << seed;
}

TEST(FeedPaths, FollowStartsWithTheFirstStatementThoughItsTimeComesLater) {
    PathsUnderTest feed(ClockMode::follow);
    // X-Plane's first pose comes before the first answer with the time, a second after the run was begun.
    for (int i = 0; i < 10; ++i) {
        TruthSample sample = told_at(0.02 * i);
        if (i > 0) sample.source_time = 40s + i * 20ms;
        sample.received_ns = paths_start_ns + (1000 + 20 * i) * one_ms;
        feed.say(std::move(sample));
        feed.take(paths_start_ns + (1000 + 20 * i) * one_ms);
        ASSERT_TRUE(feed.paths.horizon());
        EXPECT_EQ(*feed.paths.horizon(), paths_start + i * 20ms);
    }
    EXPECT_EQ(feed.path->counts().late + feed.path->counts().jumps, 0u);
    EXPECT_LT((feed.path->at(paths_start).position - told_at(0).position).length().value(), 0.01);
}

// As `told_at`, of a vehicle and with a time.
TruthSample of_vehicle(const std::string& vehicle, std::chrono::milliseconds time) {
    TruthSample sample = told_at(to_seconds(time).value());
    sample.vehicle = vehicle;
    sample.source_time = time;
    sample.received_ns = paths_start_ns + time.count() * one_ms;
    return sample;
}

// A run that follows, whose receivers want these vehicles and have no place before.
struct FollowedVehicles {
    explicit FollowedVehicles(const std::vector<std::string>& wanted) : paths(settings(), desk) {
        for (const std::string& vehicle : wanted)
            path.push_back(paths.path(vehicle));
        paths.wait_for_all();
        paths.begin(paths_start, paths_start_ns - one_ms);
    }
    static FeedSettings settings() {
        FeedSettings settings = PathsUnderTest::settings_of(ClockMode::follow);
        settings.path.begins_at_first = true;
        return settings;
    }
    void say(TruthSample sample) {
        const std::int64_t now_ns = sample.received_ns;
        std::vector<FeedItem> items{std::move(sample)};
        desk.inbox.put(items);
        paths.take(now_ns);
    }
    // m from where told_at() is at a time of the source
    [[nodiscard]] double error_m(std::size_t i, GpsTime time, double t) const {
        return (path[i]->at(time).position - told_at(t).position).length().value();
    }
    FeedDesk desk;
    FeedPaths paths;
    std::vector<std::shared_ptr<LivePath>> path;
};

TEST(FeedPaths, VehiclesThatNobodyWantsStartNoRunThatFollows) {
    FollowedVehicles feed({"b"});
    for (auto t = 0ms; t < 2000ms; t += 20ms)
        feed.say(of_vehicle("a", t));
    EXPECT_FALSE(feed.paths.horizon());
    for (auto t = 2000ms; t <= 2500ms; t += 20ms) {
        feed.say(of_vehicle("a", t));
        feed.say(of_vehicle("b", t));
    }
    EXPECT_EQ(feed.paths.horizon(), paths_start + 500ms);
    EXPECT_LT(feed.error_m(0, paths_start, 2), 0.01);
    EXPECT_EQ(feed.path[0]->counts().jumps, 0u);
}

TEST(FeedPaths, ARunThatFollowsBeginsOnceAllOfItsVehiclesAreHeard) {
    FollowedVehicles feed({"a", "b"});
    for (auto t = 0ms; t < 9000ms; t += 20ms)
        feed.say(of_vehicle("a", t));
    EXPECT_FALSE(feed.paths.horizon());
    EXPECT_FALSE(feed.path[0]->newest());
    for (auto t = 9000ms; t <= 9500ms; t += 20ms) {
        feed.say(of_vehicle("b", t));
        feed.say(of_vehicle("a", t));
    }
    EXPECT_EQ(feed.paths.horizon(), paths_start + 520ms) << "with what was said last before all were heard";
    EXPECT_LT(feed.error_m(0, paths_start, 8.98), 0.01);
    EXPECT_LT(feed.error_m(1, paths_start, 9), 0.01);
    EXPECT_LT(feed.error_m(0, paths_start + 400ms, 9.38), 0.05);
    EXPECT_LT(feed.error_m(1, paths_start + 400ms, 9.38), 0.05);
    EXPECT_EQ(feed.path[0]->counts().jumps + feed.path[1]->counts().jumps, 0u);
}

TEST(FeedPaths, WhatCannotBeStartsNoRunThatFollowsAndIsTold) {
    FollowedVehicles feed({""});
    TruthSample nowhere = of_vehicle("a", 0ms);
    nowhere.position = to_ecef(Geodetic::degrees(0, 0, 0));
    feed.say(nowhere);
    EXPECT_FALSE(feed.paths.horizon());
    EXPECT_EQ(feed.desk.tallies.refused, 1u);
    EXPECT_THAT(feed.desk.news.take(),
                testing::ElementsAre(HasSubstr("refused: the place is at latitude and longitude 0")));
    feed.say(of_vehicle("a", 3000ms));
    feed.say(of_vehicle("a", 3020ms));
    EXPECT_EQ(feed.paths.horizon(), paths_start + 20ms);
    EXPECT_LT(feed.error_m(0, paths_start, 3), 0.01);
}

TEST(FeedPaths, StepsBeforeTheFirstPlaceAreAnsweredAndTheRunStartsAfterThem) {
    PathsUnderTest feed(ClockMode::lock_step);
    for (const auto until : {5000ms, 5100ms}) {
        feed.say(FeedStep{until, paths_start_ns, 3});
        feed.take(paths_start_ns);
        EXPECT_FALSE(feed.path->newest());
        const auto skipped = feed.paths.skip_steps();
        ASSERT_EQ(skipped.size(), 1u);
        EXPECT_EQ(skipped[0].until, until);
        EXPECT_EQ(skipped[0].speaker, 3u);
    }
    TruthSample sample = told_at(0);
    sample.source_time = 5100ms;
    feed.say(std::move(sample));
    feed.take(paths_start_ns);
    EXPECT_EQ(feed.path->newest(), paths_start);
    EXPECT_EQ(feed.path->counts().jumps, 0u);
    EXPECT_FALSE(feed.paths.horizon());
    feed.say(FeedStep{5200ms, paths_start_ns, 3});
    feed.take(paths_start_ns);
    EXPECT_EQ(feed.paths.horizon(), paths_start + 100ms);
    EXPECT_EQ(feed.paths.steps_done().size(), 1u);
}

TEST(FeedPaths, AStepOfTwoMinutesIsDoneBeforeItIsAnswered) {
    PathsUnderTest feed(ClockMode::lock_step);
    feed.say(of_vehicle("a", 0ms));
    feed.say(FeedStep{120s, paths_start_ns, 1});
    feed.take(paths_start_ns);
    EXPECT_EQ(feed.paths.horizon(), paths_start + 120s);
    EXPECT_EQ(feed.desk.tallies.restarts, 0u);
}

TEST(FeedPaths, TellsOnceThatASourceInLockStepDoesNotStep) {
    for (const bool steps : {false, true}) {
        PathsUnderTest feed(ClockMode::lock_step);
        std::vector<std::string> told;
        for (auto t = 0ms; t <= 20s; t += 500ms) {
            feed.say(of_vehicle("a", t));
            if (steps) feed.say(FeedStep{t, paths_start_ns, 1});
            feed.take(paths_start_ns + t.count() * one_ms);
            feed.paths.steps_done();
            for (std::string& sentence : feed.news())
                told.push_back(std::move(sentence));
            EXPECT_TRUE(told.empty() || t > 4s);
        }
        const auto missed = testing::ElementsAre(HasSubstr("does not step"));
        EXPECT_THAT(told, testing::Conditional(!steps, missed, testing::IsEmpty()));
    }
}

TEST(FeedPaths, TheGoodbyeOfOneVehicleIsNotThatOfAnother) {
    FollowedVehicles feed({"a", "b"});
    const auto say_goodbye = [&](std::chrono::milliseconds t) {
        std::vector<FeedItem> items{FeedEnd{}};
        feed.desk.inbox.put(items);
        feed.paths.take(paths_start_ns + t.count() * one_ms);
    };
    for (auto t = 0ms; t < 1000ms; t += 20ms) {
        feed.say(of_vehicle("a", t));
        feed.say(of_vehicle("b", t));
    }
    say_goodbye(1000ms);
    EXPECT_FALSE(feed.paths.ended());
    for (auto t = 1000ms; t < 3000ms; t += 20ms) {
        feed.say(of_vehicle("b", t));
        EXPECT_FALSE(feed.paths.ended());
    }
    say_goodbye(3000ms);
    EXPECT_TRUE(feed.paths.ended()) << "nobody is left";
    feed.say(of_vehicle("b", 3020ms));
    feed.say(of_vehicle("a", 3020ms));
    EXPECT_FALSE(feed.paths.ended());
    say_goodbye(3040ms);
    feed.paths.take(paths_start_ns + 4500 * one_ms);
    EXPECT_FALSE(feed.paths.ended());
    feed.paths.take(paths_start_ns + 4600 * one_ms);
    EXPECT_TRUE(feed.paths.ended()) << "it was for both";
}

TEST(FeedPaths, APauseEndsWithTheConnectionThatToldOfIt) {
    PathsUnderTest feed(ClockMode::realtime);
    FeedHearer hearer("json", FeedContext(), feed.desk);
    const auto is_paused = [&] {
        hearer.flush();
        feed.take(paths_start_ns);
        return feed.paths.paused();
    };
    hearer.hear(1, to_bytes("{\"type\":\"clock\",\"paused\":true}\n"), paths_start_ns);
    EXPECT_TRUE(is_paused());
    hearer.hear(2, to_bytes("{\"type\":\"hello\"}\n"), paths_start_ns);
    hearer.forget(2);
    EXPECT_TRUE(is_paused()) << "another's connection";
    hearer.forget(1);
    EXPECT_FALSE(is_paused());
}

// How much a client asks of the run before its first step is done, and after it.
struct AskedFor {
    std::size_t before = 0, after = 0;
    bool operator==(const AskedFor&) const = default;
};

AskedFor asked_for(const std::vector<std::string>& pieces) {
    PathsUnderTest feed(ClockMode::lock_step);
    FeedHearer hearer("json", FeedContext(), feed.desk);
    AskedFor asked;
    for (const std::string& piece : pieces) {
        hearer.hear(1, to_bytes(piece), paths_start_ns);
        hearer.flush();
        asked.before += feed.paths.take(paths_start_ns).size();
    }
    EXPECT_EQ(feed.paths.steps_done().size(), 1u);
    asked.after = feed.paths.take(paths_start_ns).size();
    return asked;
}

TEST(FeedPaths, AnEventKeepsItsPlaceAmongStepsHoweverTheNetworkJoinsThem) {
    const std::string truth = "{\"t\":0,\"lla\":[48,11,500],\"h_ref\":\"ell\"}\n";
    const std::string event = "{\"type\":\"event\",\"name\":\"pause\"}\n", step = "{\"type\":\"step\",\"t\":0.1}\n";
    for (const auto& pieces : {std::vector{truth + event + step}, std::vector{truth, event, step}})
        EXPECT_EQ(asked_for(pieces), (AskedFor{1, 0})) << pieces.size();
    for (const auto& pieces : {std::vector{truth + step + event}, std::vector{truth, step, event}})
        EXPECT_EQ(asked_for(pieces), (AskedFor{0, 1})) << pieces.size();
}

}  // namespace
}  // namespace skyloop
