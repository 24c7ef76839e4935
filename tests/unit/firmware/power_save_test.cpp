// When a receiver that saves power goes on and off (NEO-M9N integration manual, 3.11.2; MAX-M10S, 2.7.2).
#include "firmware/core/power_save.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "firmware/ublox/config/config_handler.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using enum PowerSaveState;

const GpsTime saver_noon = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());

// A receiver's epochs, as often as it wants them, until it goes off.
class SaverBench {
public:
    explicit SaverBench(PowerSaveSettings settings, PowerAbility ability = {})
        : ability_(ability), settings_(settings), power_(ability_) {
        power_.adopt(settings_);
    }
    bool solved = true, heard = true;
    Seconds time_accuracy{20e-9};

    // So many epochs; stops where it goes off. The states that they tell.
    std::string epochs(int count) {
        std::string told;
        rest.reset();
        for (int i = 0; i < count && !rest; ++i) {
            NavigationState report;
            report.epoch.fix.time = now;
            report.epoch.fix.leap_seconds = 18;
            report.epoch.fix.type = solved ? FixType::fix_3d : FixType::none;
            report.fix_ok = solved;
            report.time.time = time_known;
            report.time.accuracy = time_accuracy;
            if (heard) add_satellites(report.epoch.fix, Constellation::gps, 1, 3);
            rest = power_.update(report);
            told += "-eatoi"[static_cast<int>(power_.state())];
            now += power_.navigation_period(1s);
        }
        return told;
    }
    // It is woken, or its time has come.
    void wake(GpsTime at) {
        now = at;
        power_.go_off();
        power_.restart(true);
    }
    PowerSave& power() { return power_; }
    void adopt(const PowerSaveSettings& settings) { power_.adopt(settings); }

    GpsTime now = saver_noon;
    bool time_known = true;
    std::optional<PowerSave::Rest> rest;

private:
    PowerAbility ability_;
    PowerSaveSettings settings_;
    PowerSave power_;
};

PowerSaveSettings saves_on_off() {
    PowerSaveSettings s;
    s.mode = PowerMode::on_off;
    s.update_period = 60s;
    s.search_period = 20s;
    s.on_time = Seconds(2);
    s.time_accuracy = Seconds(1e-6);
    return s;
}

PowerSaveSettings saves_cyclic() {
    PowerSaveSettings s = saves_on_off();
    s.mode = PowerMode::cyclic;
    return s;
}

TEST(PowerSave, DoesNothingAtFullPower) {
    SaverBench bench({});
    EXPECT_EQ(bench.epochs(5), "-----");
    EXPECT_EQ(bench.power().navigation_period(200ms), 200ms);
}

TEST(PowerSave, GoesOffWhenItsTimeOnIsOver) {
    SaverBench bench(saves_on_off());
    EXPECT_EQ(bench.epochs(50), "eattt");
    ASSERT_TRUE(bench.rest);
    EXPECT_EQ(bench.rest->until, saver_noon + 60s) << "whole minutes of UTC";
    bench.wake(saver_noon + 60s);
    EXPECT_EQ(bench.epochs(50), "eattt") << "and again";
    EXPECT_EQ(bench.rest->until, saver_noon + 120s);
}

TEST(PowerSave, SolvesTwiceASecondWhileItSearchesOnAndOff) {
    SaverBench bench(saves_on_off());
    bench.solved = false;
    bench.epochs(4);
    EXPECT_EQ(bench.now, saver_noon + 2s);
    EXPECT_EQ(bench.power().navigation_period(1s), 500ms);
    bench.solved = true;
    EXPECT_EQ(bench.epochs(1), "t");
    EXPECT_EQ(bench.power().navigation_period(1s), 1s);
    SaverBench other(saves_cyclic());
    EXPECT_EQ(other.power().navigation_period(1s), 1s);
}

TEST(PowerSave, GoesOffAtOnceWithoutATimeOn) {
    PowerSaveSettings settings = saves_on_off();
    settings.on_time = Seconds(0);
    SaverBench bench(settings);
    EXPECT_EQ(bench.epochs(50), "eat");
    EXPECT_TRUE(bench.rest);
}

TEST(PowerSave, GivesUpWhereItHearsNothing) {
    SaverBench bench(saves_on_off());
    bench.solved = bench.heard = false;
    EXPECT_EQ(bench.epochs(500).size(), 32u) << "15 s after the first half second";
    ASSERT_TRUE(bench.rest);
    EXPECT_EQ(bench.rest->until, saver_noon + 19s) << "a second ahead of the search grid";
}

TEST(PowerSave, SearchesForLongerWhereItHearsSomething) {
    SaverBench bench(saves_on_off());
    bench.solved = false;
    EXPECT_EQ(bench.epochs(500).size(), 242u) << "120 s";
    PowerSaveSettings settings = saves_on_off();
    settings.longest_acquisition = Seconds(30);
    SaverBench told(settings);
    told.solved = false;
    EXPECT_EQ(told.epochs(500).size(), 62u);
    told.heard = false;
    told.wake(saver_noon + 90s);
    EXPECT_EQ(told.epochs(500).size(), 32u) << "the shorter of both";
    settings.least_acquisition = Seconds(40);
    SaverBench patient(settings);
    patient.solved = patient.heard = false;
    EXPECT_EQ(patient.epochs(500).size(), 82u);
}

TEST(PowerSave, TakesItsTimeToAcquire) {
    PowerSaveSettings settings = saves_on_off();
    settings.least_acquisition = Seconds(5);
    SaverBench bench(settings);
    EXPECT_EQ(bench.epochs(50), "eaaaaaaaaaattt");
    settings.never_off = true;
    SaverBench other(settings);
    EXPECT_EQ(other.epochs(50), "eattt") << "ignored with DONOTENTEROFF";
}

TEST(PowerSave, NeverGivesUpWhenTold) {
    PowerSaveSettings settings = saves_on_off();
    settings.never_off = true;
    SaverBench bench(settings);
    bench.solved = bench.heard = false;
    bench.epochs(2000);
    EXPECT_FALSE(bench.rest);
    EXPECT_EQ(bench.power().state(), acquisition);
}

TEST(PowerSave, WaitsForTheTime) {
    PowerSaveSettings settings = saves_on_off();
    settings.wait_for_time = true;
    SaverBench bench(settings);
    bench.time_accuracy = Seconds(2e-6);
    EXPECT_EQ(bench.epochs(10), "eaaaaaaaaa");
    bench.time_accuracy = Seconds(0.5e-6);
    EXPECT_EQ(bench.epochs(1), "t");
    SaverBench other(settings);
    EXPECT_EQ(other.epochs(6), "eaaatt") << "two seconds of fixes";
}

TEST(PowerSave, SearchesAgainWhenItLosesItsFix) {
    SaverBench bench(saves_on_off());
    bench.epochs(3);
    bench.solved = false;
    EXPECT_EQ(bench.epochs(2), "aa");
    bench.solved = true;
    EXPECT_EQ(bench.epochs(50), "ttt") << "the time on begins anew";
}

TEST(PowerSave, WaitsToBeWoken) {
    PowerSaveSettings settings = saves_on_off();
    settings.update_period = settings.search_period = 0s;
    SaverBench bench(settings);
    bench.epochs(50);
    ASSERT_TRUE(bench.rest);
    EXPECT_FALSE(bench.rest->until);
    bench.solved = bench.heard = false;
    bench.wake(saver_noon + 7s);
    bench.epochs(50);
    ASSERT_TRUE(bench.rest);
    EXPECT_FALSE(bench.rest->until);
}

TEST(PowerSave, HasAGridThatBeginsWithTheWeek) {
    PowerSaveSettings settings = saves_on_off();
    settings.update_period = 24h;
    settings.grid_offset = 6h;
    SaverBench bench(settings);
    bench.epochs(50);
    EXPECT_EQ(bench.rest->until, saver_noon + 18h) << "six in the morning, UTC";
    settings.in_utc = false;
    bench.adopt(settings);
    bench.wake(saver_noon);
    bench.epochs(50);
    EXPECT_EQ(bench.rest->until, saver_noon + 18h - 18s) << "of GPS time";
    // 11 hours do not divide the week: after Saturday 21:00 comes the first of the next one.
    settings.update_period = 11h;
    settings.in_utc = true;
    bench.adopt(settings);
    const GpsTime late = to_gps_time(*parse_utc("2024-03-09T22:00:00Z"), LeapSeconds::announced());
    bench.wake(late);
    bench.epochs(50);
    EXPECT_EQ(bench.rest->until, late + 8h);
}

TEST(PowerSave, HasNoGridBeforeItKnowsTheTime) {
    SaverBench bench(saves_on_off());
    bench.time_known = false;
    bench.now += 7s;
    bench.epochs(50);
    EXPECT_EQ(bench.rest->until, saver_noon + 7s + 3s + 60s);
}

TEST(PowerSave, TracksInCycles) {
    PowerSaveSettings settings = saves_cyclic();
    settings.cyclic_period = 5s;
    SaverBench bench(settings);
    EXPECT_EQ(bench.epochs(8), "eattoooo") << "two seconds of tracking";
    EXPECT_FALSE(bench.rest);
    EXPECT_EQ(bench.power().navigation_period(1s), 5s);
    bench.solved = false;
    EXPECT_EQ(bench.epochs(3), "taa");
    bench.solved = true;
    EXPECT_EQ(bench.epochs(4), "ttoo");
}

TEST(PowerSave, GoesOffFromCyclesWhenItFindsNothing) {
    SaverBench bench(saves_cyclic());
    bench.epochs(10);
    bench.solved = bench.heard = false;
    bench.epochs(100);
    ASSERT_TRUE(bench.rest);
    EXPECT_TRUE(bench.rest->until);
}

TEST(PowerSave, DownloadsEphemeridesEveryHalfHour) {
    PowerSaveSettings settings = saves_cyclic();
    settings.update_ephemerides = true;
    SaverBench bench(settings);
    bench.now = saver_noon + 1700s;
    bench.epochs(20);
    EXPECT_EQ(bench.power().state(), optimized);
    std::string told = bench.epochs(2000);
    const auto left = told.find('t');
    ASSERT_NE(left, std::string::npos);
    EXPECT_EQ((saver_noon + 1720s + static_cast<int>(left) * 1s).time_since_epoch() % 30min, 0s);
    EXPECT_EQ(told.find('o', left) - left, 30u) << "s";
    EXPECT_EQ(told.find('t', told.find('o', left)) - left, 1800u);
}

TEST(PowerSave, WakesForEphemerides) {
    PowerSaveSettings settings = saves_on_off();
    settings.update_period = 2h;
    settings.update_ephemerides = true;
    SaverBench bench(settings);
    bench.epochs(50);
    const GpsTime half_hour = saver_noon + 30min - 18s;
    ASSERT_EQ(bench.rest->until, half_hour) << "the grid is one of GPS time";
    bench.wake(half_hour);
    EXPECT_EQ(bench.epochs(100).size(), 33u) << "two epochs of search, 30 s of tracking";
    EXPECT_EQ(bench.rest->until, half_hour + 30min);
}

TEST(PowerSave, BeginsAnewWhenItIsSwitched) {
    SaverBench bench({});
    bench.epochs(3);
    bench.adopt(saves_cyclic());
    EXPECT_EQ(bench.epochs(6), "eattoo");
    bench.adopt({});
    EXPECT_EQ(bench.epochs(1), "-");
    bench.adopt(saves_cyclic());
    bench.epochs(6);
    bench.adopt(saves_on_off());
    EXPECT_EQ(bench.epochs(50), "ttt");
    EXPECT_TRUE(bench.rest);
}

PowerSaveSettings saver_settings(BoardProfile board, std::vector<std::pair<std::uint32_t, std::uint64_t>> values) {
    board.power.save_modes = true;
    ConfigStore store(factory_config(board));
    for (const auto& [id, value] : values)
        store.set(in_ram, id, value);
    return receiver_config(store, board).power;
}

TEST(PowerSaveSettings, AreThoseInForce) {
    const PowerSaveSettings s = saver_settings(sample_ublox(), {{key::pm_operate_mode, 1},
                                                                {key::pm_update_period, 90},
                                                                {key::pm_search_period, 30},
                                                                {key::pm_grid_offset, 5},
                                                                {key::pm_on_time, 4},
                                                                {key::pm_least_acquisition, 6},
                                                                {key::pm_longest_acquisition, 70},
                                                                {key::pm_never_off, 1},
                                                                {key::pm_wait_for_time, 1},
                                                                {key::pm_update_ephemerides, 0}});
    EXPECT_EQ(s.mode, PowerMode::on_off);
    EXPECT_EQ(s.update_period, 90s);
    EXPECT_EQ(s.search_period, 30s);
    EXPECT_EQ(s.grid_offset, 5s);
    EXPECT_EQ(s.on_time, Seconds(4));
    EXPECT_EQ(s.least_acquisition, Seconds(6));
    EXPECT_EQ(s.longest_acquisition, Seconds(70));
    EXPECT_TRUE(s.never_off && s.wait_for_time && s.in_utc);
    EXPECT_FALSE(s.update_ephemerides);
    EXPECT_NEAR(s.time_accuracy.value(), 1.17e-6, 1e-8) << "350 m";
}

TEST(PowerSaveSettings, AreNoneOnABoardThatDoesNotSave) {
    const BoardProfile board = sample_ublox();
    ConfigStore store(factory_config(board));
    store.set(in_ram, key::pm_operate_mode, 1);
    EXPECT_EQ(receiver_config(store, board).power.mode, PowerMode::full);
}

// NEO-M9N integration manual, 3.11.6.
TEST(PowerSaveSettings, HaveCyclesAtFewRatesFromGenerationNineOn) {
    const auto mode = [](std::uint64_t period_ms) {
        return saver_settings(sample_ublox(), {{key::pm_operate_mode, 2}, {key::rate_meas, period_ms}}).mode;
    };
    for (const std::uint64_t good : {500u, 1000u, 2000u, 10'000u})
        EXPECT_EQ(mode(good), PowerMode::cyclic) << good;
    for (const std::uint64_t bad : {100u, 250u, 1500u, 11'000u})
        EXPECT_EQ(mode(bad), PowerMode::full) << bad;
}

TEST(PowerSaveSettings, HaveTheUpdatePeriodBefore) {
    BoardProfile m8 = sample_ublox();
    m8.identity.generation = 8;
    const auto period = [&](std::uint64_t seconds, std::uint64_t setup = 0) {
        return saver_settings(m8, {{key::pm_operate_mode, 2}, {key::pm_update_period, seconds}, {0x20FD0440, setup}})
            .cyclic_period;
    };
    EXPECT_EQ(period(3), 3s);
    EXPECT_EQ(period(0), 1s);
    EXPECT_EQ(period(60), 10s);
    EXPECT_EQ(period(3, 4), 500ms) << "CFG-PMS, aggressive at 2 Hz";
    EXPECT_EQ(saver_settings(sample_ublox(), {{key::pm_operate_mode, 2}}).cyclic_period, 0s);
}

}  // namespace
}  // namespace skyloop::firmware
