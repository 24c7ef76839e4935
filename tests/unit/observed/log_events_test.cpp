// What goes wrong in made-up logs is found, to the epoch, and told as faults.
#include "receiver/observed/log_events.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/time/utc_time.hpp"

namespace skyloop {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

// A good log at `rate` Hz with eight satellites of 45 dB-Hz.
ObservedLog sound_log(int epochs, int rate = 1) {
    ObservedLog log;
    log.name = "sound.ubx";
    log.format = "UBX";
    for (int i = 0; i < epochs; ++i) {
        ObservedEpoch epoch;
        epoch.time = to_gps_time(2304, 216018.0) + milliseconds(1000 / rate) * i;
        epoch.type = FixType::fix_3d;
        epoch.place = Geodetic::degrees(47, 8 + 1e-5 * i, 500);
        epoch.lists_satellites = true;
        for (int number = 1; number <= 8; ++number)
            epoch.signals.push_back({{Constellation::gps, number}, 45, 40});
        log.epochs.push_back(epoch);
    }
    return log;
}

void lose(ObservedEpoch& epoch) {
    epoch.type = FixType::none;
    epoch.place.reset();
    epoch.signals.clear();
}

TEST(LogEvents, FindNothingInASoundLog) {
    const LogEvents found = find_events(sound_log(100, 5), {});
    EXPECT_EQ(found.period, milliseconds(200));
    EXPECT_TRUE(found.events.empty());
}

TEST(LogEvents, FindAnOutageByItsSatellites) {
    ObservedLog log = sound_log(100);
    for (std::size_t i = 30; i < 43; ++i)
        lose(log.epochs[i]);
    for (std::size_t i = 41; i < 43; ++i)  // tracked again, not yet used
        log.epochs[i].signals = log.epochs[0].signals;
    const LogEvents found = find_events(log, {});
    ASSERT_EQ(found.events.size(), 1u);
    EXPECT_EQ(found.events[0].kind, LogEventKind::signals_lost);
    EXPECT_EQ(found.events[0].at, seconds(30));
    EXPECT_EQ(found.events[0].lasts, seconds(10));
}

TEST(LogEvents, TakeNoLossForTimeAlone) {
    ObservedLog log = sound_log(100);
    for (std::size_t i = 30; i < 40; ++i)
        log.epochs[i].type = FixType::time_only;
    for (std::size_t i = 95; i < 100; ++i)
        lose(log.epochs[i]);
    const LogEvents found = find_events(log, {});
    ASSERT_EQ(found.events.size(), 2u);
    EXPECT_EQ(found.events[0].kind, LogEventKind::fix_type);
    EXPECT_EQ(found.events[1].at, seconds(95));
    EXPECT_EQ(found.events[1].lasts, seconds(5));  // nobody saw it return
}

TEST(LogEvents, LeaveTimeToReacquireWhereNothingIsListed) {
    ObservedLog log = sound_log(100);
    for (ObservedEpoch& epoch : log.epochs)
        epoch.lists_satellites = false, epoch.signals.clear();
    for (std::size_t i = 30; i < 43; ++i)
        lose(log.epochs[i]);
    const LogEvents found = find_events(log, {});
    ASSERT_EQ(found.events.size(), 1u);
    EXPECT_EQ(found.events[0].at, seconds(30));
    EXPECT_EQ(found.events[0].lasts, seconds(12));
}

TEST(LogEvents, FindMissingEpochs) {
    ObservedLog log = sound_log(100, 5);
    log.epochs.erase(log.epochs.begin() + 50, log.epochs.begin() + 57);
    const LogEvents found = find_events(log, {});
    ASSERT_EQ(found.events.size(), 1u);
    EXPECT_EQ(found.events[0].kind, LogEventKind::silent);
    EXPECT_EQ(found.events[0].at, seconds(10));
    EXPECT_EQ(found.events[0].lasts, milliseconds(1400));
    EXPECT_EQ(found.events[0].seen, "7 epochs are missing");
}

TEST(LogEvents, FindTypesOfFix) {
    ObservedLog log = sound_log(20);
    for (std::size_t i = 5; i < 12; ++i)
        log.epochs[i].type = i < 9 ? FixType::rtk_fixed : FixType::rtk_float;
    const LogEvents found = find_events(log, {});
    ASSERT_EQ(found.events.size(), 2u);
    EXPECT_EQ(found.events[0].type, FixType::rtk_fixed);
    EXPECT_EQ(found.events[0].lasts, seconds(4));
    EXPECT_EQ(found.events[1].type, FixType::rtk_float);
    EXPECT_EQ(found.events[1].at, seconds(9));
    EXPECT_EQ(found.events[1].lasts, seconds(3));
}

TEST(LogEvents, TellADropOfAllFromOneOfASatellite) {
    ObservedLog log = sound_log(200);
    for (std::size_t i = 60; i < 75; ++i)
        for (ObservedSignal& satellite : log.epochs[i].signals)
            satellite.cn0_dbhz -= 12;
    for (std::size_t i = 100; i < 120; ++i)
        log.epochs[i].signals[3].cn0_dbhz -= 15;
    for (std::size_t i = 140; i < 150; ++i)
        log.epochs[i].signals.erase(log.epochs[i].signals.begin() + 6);
    const LogEvents found = find_events(log, {});
    ASSERT_EQ(found.events.size(), 3u);
    EXPECT_EQ(found.events[0].kind, LogEventKind::drop);
    EXPECT_EQ(found.events[0].at, seconds(60));
    EXPECT_EQ(found.events[0].lasts, seconds(15));
    EXPECT_NEAR(found.events[0].drop_db, 12, 1e-9);
    EXPECT_EQ(found.events[1].kind, LogEventKind::satellite_drop);
    EXPECT_EQ(to_string(*found.events[1].satellite), "G04");
    EXPECT_NEAR(found.events[1].drop_db, 15, 1e-9);
    EXPECT_EQ(found.events[2].kind, LogEventKind::satellite_lost);
    EXPECT_EQ(to_string(*found.events[2].satellite), "G07");
    EXPECT_EQ(found.events[2].lasts, seconds(10));
    EventLimits strict;
    strict.drop_db = 13;
    strict.satellite_drop_db = 16;
    strict.satellite_least = Seconds(11);
    EXPECT_TRUE(find_events(log, strict).events.empty());
}

TEST(LogScenario, WritesWhatItFound) {
    ObservedLog log = sound_log(100);
    log.name = "evil\n[run]\".ubx";
    for (std::size_t i = 30; i < 41; ++i)
        lose(log.epochs[i]);
    const auto made = scenario_of_log(log, find_events(log, {}));
    ASSERT_TRUE(made.has_value());
    EXPECT_EQ(made->places, 89u);
    EXPECT_THAT(made->scenario, HasSubstr("start = \"2024-03-05T12:00:00.000000000Z\"\nduration_s = 100\n"));
    EXPECT_THAT(made->scenario, HasSubstr("kind = \"outage\"\nat_s = 30\nfor_s = 10\n"));
    EXPECT_THAT(made->scenario, HasSubstr("evil?[run]\".ubx"));
    EXPECT_THAT(made->scenario, HasSubstr("time = \"recorded\""));
    EXPECT_THAT(made->track, HasSubstr("\n2304,216018.000000,47.000000000,8.000000000,500.0000\n"));
    ObservedLog nowhere = sound_log(3);
    for (ObservedEpoch& epoch : nowhere.epochs)
        lose(epoch);
    EXPECT_THAT(scenario_of_log(nowhere, find_events(nowhere, {})).error().message,
                HasSubstr("none with a fix and a place"));
    const ObservedLog one = sound_log(1);
    const auto still = scenario_of_log(one, find_events(one, {}));
    ASSERT_TRUE(still.has_value());
    EXPECT_TRUE(still->track.empty());
    EXPECT_THAT(still->scenario, HasSubstr("kind = \"fixed\"\nat = [47.000000000, 8.000000000, 500.0000]"));
}

}  // namespace
}  // namespace skyloop
