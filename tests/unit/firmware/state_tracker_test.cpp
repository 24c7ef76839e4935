#include "firmware/core/state_tracker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware/ublox/config/config_handler.hpp"
#include "firmware/ublox/config/legacy_keys.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using enum Constellation;

BoardProfile tracked_board() {
    BoardProfile board = sample_board(NmeaVersion::v4_10, {gps, galileo});
    board.identity.generation = 9;
    board.timing.cold_start = Seconds(26);
    board.timing.warm_start = Seconds(22);
    board.timing.hot_start = Seconds(1.5);
    return board;
}

// A receiver at one epoch a second.
class Tracked {
public:
    explicit Tracked(const BoardProfile& board, const char* utc = "2024-03-05T12:00:00Z")
        : board_(board), store_(factory_config(board_)), tracker_(board_), fix_(sample_fix(utc, 47, 8, 500)) {
        add_satellites(fix_, gps, 1, 8);
        add_satellites(fix_, galileo, 1, 8);
        fix_.velocity = {12.5, 0, 0};
        fix_.course = Angle::degrees(0);
        fix_.time_accuracy = Metres(6);
    }
    StateTracker& tracker() { return tracker_; }
    ConfigStore& store() { return store_; }
    Fix& fix() { return fix_; }
    FrontEnd& front_end() { return front_end_; }
    CorrectionStatus& corrections() { return corrections_; }
    const NavigationState& step(Nanoseconds period = 1s) {
        fix_.time += period;
        Epoch epoch{fix_};
        epoch.front_end = front_end_;
        return tracker_.update(epoch, receiver_config(store_, board_), corrections_);
    }
    const NavigationState& steps(int count) {
        for (int i = 1; i < count; ++i)
            step();
        return step();
    }
    void adopt() { tracker_.adopt(receiver_config(store_, board_)); }

private:
    BoardProfile board_;
    ConfigStore store_;
    StateTracker tracker_;
    Fix fix_;
    FrontEnd front_end_;
    CorrectionStatus corrections_;
};

TEST(Forgotten, IsColdWithoutTimeOrPlaceAndWarmWithoutEphemerides) {
    EXPECT_EQ(Forgotten::by_mask(0x0000).kind(), StartKind::hot);
    EXPECT_EQ(Forgotten::by_mask(0x0001).kind(), StartKind::warm);
    EXPECT_EQ(Forgotten::by_mask(0xFFFF).kind(), StartKind::cold);
    EXPECT_EQ(Forgotten::by_mask(0x0010).kind(), StartKind::cold);
    EXPECT_EQ(Forgotten::by_mask(0x0100).kind(), StartKind::cold);
    EXPECT_EQ(Forgotten::by_mask(0x0008).kind(), StartKind::hot);
    EXPECT_TRUE(Forgotten::by_mask(0x0080).utc);
}

TEST(StateTracker, KnowsEverythingWhenItHasBeenOnForLong) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    const NavigationState& state = t.step();
    EXPECT_TRUE(state.time.time && state.time.date && state.time.leap_seconds && state.time.confirmed);
    EXPECT_TRUE(state.fix_ok);
    EXPECT_EQ(state.epoch.fix.type, FixType::fix_3d);
    EXPECT_EQ(state.epoch_index, 0U);
    EXPECT_EQ(state.since_start.value(), 3600);
    EXPECT_EQ(t.step().epoch_index, 1U);
    EXPECT_EQ(t.steps(9).since_start.value(), 3610);
    EXPECT_EQ(state.since_boot.value(), 3610);
}

TEST(StateTracker, LeavesOutSatellitesOfSystemsThatAreOff) {
    Tracked t(tracked_board());
    add_satellites(t.fix(), beidou, 19, 4);
    add_satellites(t.fix(), navic, 1, 4);
    EXPECT_EQ(t.step().epoch.fix.satellites.size(), 16U);
    t.store().set(in_ram, 0x10310021, 0);
    for (const SatelliteStatus& s : t.step().epoch.fix.satellites)
        EXPECT_EQ(s.id.constellation, gps);
    t.store().set(in_ram, 0x10310022, 1);
    EXPECT_EQ(t.step().epoch.fix.satellites.size(), 12U);
}

TEST(StateTracker, CountsFromTheStartOfNavigationAndFromThatOfTheReceiver) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    t.steps(5);
    t.tracker().start(t.fix().time, {});
    EXPECT_EQ(t.steps(2).since_start.value(), 2);
    EXPECT_EQ(t.tracker().state().since_boot.value(), 3606);
    t.tracker().boot(t.fix().time);
    t.tracker().start(t.fix().time, {});
    EXPECT_EQ(t.steps(3).since_boot.value(), 3);
}

TEST(StateTracker, ShowsSatellitesOneByOneBeforeTheFirstFixOfAColdStart) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, Forgotten::by_mask(0xFFFF));
    const NavigationState& first = t.step();
    EXPECT_EQ(first.epoch.fix.type, FixType::none);
    EXPECT_TRUE(first.epoch.fix.satellites.empty());
    EXPECT_FALSE(first.time.time || first.time.date || first.time.leap_seconds);
    EXPECT_FALSE(first.position_known);
    std::size_t before = 0;
    int growths = 0;
    for (int second = 2; second < 26; ++second) {
        const NavigationState& state = t.step();
        ASSERT_EQ(state.epoch.fix.type, FixType::none) << second;
        ASSERT_EQ(state.epoch.fix.satellites_used(), 0);
        ASSERT_GE(state.epoch.fix.satellites.size(), before);
        growths += state.epoch.fix.satellites.size() > before ? 1 : 0;
        before = state.epoch.fix.satellites.size();
    }
    EXPECT_GE(growths, 8);
    const NavigationState& fixed = t.step();
    EXPECT_EQ(fixed.epoch.fix.type, FixType::fix_3d);
    EXPECT_TRUE(fixed.fix_ok);
    ASSERT_TRUE(fixed.time_to_first_fix);
    EXPECT_NEAR(fixed.time_to_first_fix->value(), 26, 1e-6);
}

TEST(StateTracker, LearnsTheTimeBeforeTheDateAndBoth) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, Forgotten::by_mask(0xFFFF));
    int time_at = 0, date_at = 0;
    for (int second = 1; second < 26; ++second) {
        const NavigationState& state = t.step();
        if (state.time.time && time_at == 0) time_at = second;
        if (state.time.date && date_at == 0) date_at = second;
    }
    EXPECT_GE(time_at, 8);
    EXPECT_LE(time_at, 14);
    EXPECT_GT(date_at, time_at);
}

TEST(StateTracker, HasTimeAtOnceAfterAWarmStart) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, Forgotten::by_mask(0x0001));
    const NavigationState& state = t.step();
    EXPECT_TRUE(state.time.time && state.time.date && state.time.leap_seconds);
    EXPECT_FALSE(state.time.confirmed);
    EXPECT_EQ(state.epoch.fix.type, FixType::none);
    EXPECT_EQ(t.steps(21).epoch.fix.type, FixType::fix_3d);
}

TEST(StateTracker, HasAFixTwoSecondsAfterAHotStart) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {});
    EXPECT_EQ(t.step().epoch.fix.type, FixType::none);
    EXPECT_EQ(t.step().epoch.fix.type, FixType::fix_3d);
}

// Page 18 of GPS subframe 4 ends 534 s into each cycle of 750 s; at 12:00:18 GPST of that day the time of week is
// 216 018 s, 18 s into the cycle.
TEST(StateTracker, DecodesLeapSecondsWithTheGpsPageThatCarriesThem) {
    BoardProfile board = tracked_board();
    board.constellations = {gps};
    Tracked t(board);
    std::erase_if(t.fix().satellites, [](const auto& s) { return s.id.constellation == galileo; });
    t.tracker().start(t.fix().time, Forgotten::by_mask(0xFFFF));
    int known_at = 0;
    for (int second = 1; second < 800 && known_at == 0; ++second)
        if (t.step().time.leap_seconds) known_at = second;
    EXPECT_EQ(known_at, 516);
}

TEST(StateTracker, BelievesTheFirmwaresLeapSecondsUntilItHasDecodedThem) {
    BoardProfile board = tracked_board();
    board.quirks.leap_seconds = 16;
    Tracked t(board);
    t.tracker().start(t.fix().time, Forgotten::by_mask(0xFFFF));
    EXPECT_EQ(t.steps(28).epoch.fix.leap_seconds, 16);
    EXPECT_EQ(t.steps(60).epoch.fix.leap_seconds, 18);
}

TEST(StateTracker, CoastsThenShowsTheLastPlaceWithGrowingUncertainty) {
    BoardProfile board = tracked_board();
    board.timing.coasting = Seconds(3);
    Tracked t(board);
    t.tracker().start(t.fix().time, {}, true);
    const Fix last = t.step().epoch.fix;
    t.fix().type = FixType::none;
    for (SatelliteStatus& s : t.fix().satellites)
        s.used = false, s.cn0.reset();
    const NavigationState coasting = t.step();
    EXPECT_EQ(coasting.epoch.fix.type, FixType::dead_reckoning);
    EXPECT_TRUE(coasting.fix_ok);
    // 12.5 m north
    EXPECT_NEAR((coasting.epoch.fix.position.latitude.deg() - last.position.latitude.deg()) * 111'170, 12.5, 0.1);
    EXPECT_GT(coasting.epoch.fix.horizontal_accuracy.value(), last.horizontal_accuracy.value());
    const NavigationState lost = t.steps(4);
    EXPECT_EQ(lost.epoch.fix.type, FixType::none);
    EXPECT_FALSE(lost.fix_ok);
    EXPECT_TRUE(lost.position_known);
    EXPECT_GT(lost.epoch.fix.position.latitude.deg(), last.position.latitude.deg());
    EXPECT_EQ(lost.epoch.fix.satellites_used(), 0);
    const double accuracy = lost.epoch.fix.horizontal_accuracy.value();
    const double time_accuracy = lost.time.accuracy.value();
    const NavigationState later = t.steps(5);
    EXPECT_NEAR(later.epoch.fix.horizontal_accuracy.value() - accuracy, 36, 1);
    EXPECT_GT(later.time.accuracy.value(), time_accuracy);
}

TEST(StateTracker, DropsTheFixAFewEpochsAfterTheDynamicModelsLimitsAreLeft) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    t.store().set(in_ram, key::navspg_dynmodel, 3);  // pedestrian: 30 m/s
    t.fix().speed = MetresPerSecond(29);
    EXPECT_TRUE(t.step().fix_ok);
    t.fix().speed = MetresPerSecond(31);
    const NavigationState& first = t.step();
    EXPECT_FALSE(first.fix_ok);
    EXPECT_EQ(first.epoch.fix.type, FixType::fix_3d);
    EXPECT_EQ(t.steps(2).epoch.fix.type, FixType::none);
    t.fix().speed = MetresPerSecond(1);
    EXPECT_TRUE(t.step().fix_ok);
}

TEST(StateTracker, ExportsNothingBeyondFiveHundredMetresASecondOrTheModelsAltitude) {
    const auto allowed = [](std::uint64_t model, double height_m, double speed, int generation) {
        Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, height_m);
        fix.speed = MetresPerSecond(speed);
        return within_dynamic_model(model, fix, generation);
    };
    EXPECT_TRUE(allowed(8, 20'000, 499, 9));
    EXPECT_FALSE(allowed(8, 20'000, 501, 9));
    EXPECT_TRUE(allowed(8, 79'000, 100, 9));
    EXPECT_FALSE(allowed(8, 80'100, 100, 9));
    EXPECT_TRUE(allowed(8, 49'000, 100, 8));
    EXPECT_FALSE(allowed(8, 51'000, 100, 8));
    EXPECT_TRUE(allowed(6, 100, 300, 9)) << "airborne models look at the altitude alone";
    EXPECT_FALSE(allowed(5, 600, 1, 9));
    EXPECT_TRUE(allowed(200, 100, 1, 9));
}

TEST(StateTracker, ReadsTheLimitsOfExportAsOneRuleOrAsTwo) {
    const auto allowed = [](ExportLimits limits, double height_m, double speed, double down) {
        Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, height_m);
        fix.geoid_undulation = Metres(0);
        fix.speed = MetresPerSecond(speed);
        fix.velocity.down = down;
        return within_export_limits(limits, fix);
    };
    using enum ExportLimits;
    EXPECT_TRUE(allowed(off, 30'000, 900, 0));
    EXPECT_TRUE(allowed(both_exceeded, 30'000, 514, 0));
    EXPECT_TRUE(allowed(both_exceeded, 18'000, 600, 0));
    EXPECT_FALSE(allowed(both_exceeded, 18'300, 0, -516)) << "upward counts, too";
    EXPECT_FALSE(allowed(either_exceeded, 30'000, 5, 0));
    EXPECT_FALSE(allowed(either_exceeded, 500, 300, 450));
    EXPECT_TRUE(allowed(either_exceeded, 18'280, 510, 0));
}

TEST(StateTracker, IsNotOkBeyondTheUsersMasks) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    t.store().set(in_ram, key::navspg_pdop, 15);
    const NavigationState& by_dop = t.step();
    EXPECT_FALSE(by_dop.fix_ok);
    EXPECT_EQ(by_dop.epoch.fix.type, FixType::fix_3d);
    t.store().set(in_ram, key::navspg_pdop, 250);
    t.store().set(in_ram, key::navspg_pacc, 5);
    EXPECT_FALSE(t.step().fix_ok);
    t.store().set(in_ram, key::navspg_pacc, 100);
    EXPECT_TRUE(t.step().fix_ok);
    t.store().set(in_ram, key::navspg_fixmode, 2);
    t.fix().type = FixType::fix_2d;
    EXPECT_EQ(t.step().epoch.fix.type, FixType::none);
}

TEST(StateTracker, HasNoFixOfFewerOrWeakerSatellitesThanTheUserWants) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    const auto used = static_cast<std::uint64_t>(t.fix().satellites_used());
    ASSERT_GT(used, 4U);
    t.store().set(in_ram, key::navspg_min_svs, used);
    EXPECT_EQ(t.step().epoch.fix.type, FixType::fix_3d);
    t.store().set(in_ram, key::navspg_min_svs, used + 1);
    EXPECT_EQ(t.step().epoch.fix.type, FixType::none);
    t.store().set(in_ram, key::navspg_min_svs, 3);
    EXPECT_EQ(t.step().epoch.fix.type, FixType::fix_3d);

    for (SatelliteStatus& s : t.fix().satellites)
        s.cn0 = DbHz(30);
    t.fix().satellites.front().cn0 = t.fix().satellites.back().cn0 = DbHz(40);
    t.store().set(in_ram, key::navspg_cno_threshold, 35);
    EXPECT_EQ(t.step().epoch.fix.type, FixType::fix_3d) << "of none is it asked";
    t.store().set(in_ram, key::navspg_cno_count, 2);
    EXPECT_EQ(t.step().epoch.fix.type, FixType::fix_3d);
    t.store().set(in_ram, key::navspg_cno_count, 3);
    EXPECT_EQ(t.step().epoch.fix.type, FixType::none);
}

TEST(StateTracker, MeasuresTwoDimensionsByTheirOwnDop) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    t.fix().type = FixType::fix_2d;
    t.fix().dop.pdop = t.fix().dop.vdop = std::numeric_limits<double>::quiet_NaN();
    t.fix().dop.hdop = 8;
    EXPECT_TRUE(t.step().fix_ok);
    t.fix().dop.hdop = 26;
    EXPECT_FALSE(t.step().fix_ok);
}

TEST(StateTracker, HoldsPositionAndCourseBelowTheThreshold) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    t.store().set(in_ram, key::mot_speed_threshold, 50);
    t.store().set(in_ram, key::mot_distance_threshold, 20);
    t.fix().speed = MetresPerSecond(0.4);
    const Geodetic place = t.step().epoch.fix.position;
    t.fix().position = Geodetic::degrees(47.0001, 8, 500);  // 11 m
    const NavigationState held = t.step();
    EXPECT_TRUE(held.position_held);
    EXPECT_EQ(held.epoch.fix.position.latitude.deg(), place.latitude.deg());
    EXPECT_EQ(held.epoch.fix.speed.value(), 0);
    t.fix().position = Geodetic::degrees(47.0003, 8, 500);  // 33 m
    EXPECT_NEAR(t.step().epoch.fix.position.latitude.deg(), 47.0003, 1e-9);
    t.fix().speed = MetresPerSecond(0.6);
    EXPECT_FALSE(t.step().position_held);
}

TEST(StateTracker, FreezesTheCourseAtRest) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    t.fix().speed = MetresPerSecond(0.05);
    EXPECT_FALSE(t.step().course);
    t.fix().speed = MetresPerSecond(3);
    t.fix().course = Angle::degrees(30);
    EXPECT_FALSE(t.step().course_is_frozen);
    t.fix().speed = MetresPerSecond(0.05);
    t.fix().course = Angle::degrees(200);
    const NavigationState& state = t.step();
    EXPECT_TRUE(state.course_is_frozen);
    EXPECT_NEAR(state.course->deg(), 30, 1e-9);
}

TEST(StateTracker, CountsTheDistance) {
    Tracked t(tracked_board());
    t.store().set(in_ram, key::odo_use_odo, 1);
    t.tracker().start(t.fix().time, {}, true);
    EXPECT_NEAR(t.steps(11).odometer_m, 125, 1e-9);
    t.tracker().reset_odometer();
    EXPECT_EQ(t.tracker().state().odometer_m, 0);
    EXPECT_NEAR(t.tracker().state().odometer_total_m, 125, 1e-9);
}

TEST(StateTracker, CountsTheDistanceOfAUbloxWhileItsOdometerIsOn) {
    BoardProfile board = tracked_board();
    board.maker = MakerKind::ublox;
    Tracked t(board);
    t.fix().speed_accuracy = MetresPerSecond(0.05);
    t.tracker().start(t.fix().time, {}, true);
    EXPECT_EQ(t.steps(11).odometer_m, 0) << "off from the factory";
    t.store().set(in_ram, key::odo_use_odo, 1);
    const NavigationState& counted = t.steps(40);
    EXPECT_NEAR(counted.odometer_m, 500, 1e-9);
    EXPECT_NEAR(counted.odometer_deviation_m, 2, 1e-9);
    t.store().set(in_ram, key::odo_use_odo, 0);
    EXPECT_NEAR(t.steps(10).odometer_m, 500, 1e-9) << "what was counted stays";
    EXPECT_NEAR(t.tracker().state().odometer_total_m, 500, 1e-9);
    t.tracker().reset_odometer();
    EXPECT_EQ(t.tracker().state().odometer_m, 0);
}

// 47.1° N, 8.2° E, 512.34 m, within 2 m.
void stand_at_a_fixed_place(ConfigStore& store) {
    for (const auto& [item, value] :
         std::initializer_list<std::pair<std::uint32_t, std::uint64_t>>{{key::tmode_mode, 2},
                                                                        {0x20030002, 1},
                                                                        {0x40030009, 471000000},
                                                                        {0x4003000A, 82000000},
                                                                        {0x4003000B, 51234},
                                                                        {0x4003000F, 20000}})
        store.set(in_ram, item, value);
}

TEST(StateTracker, StandsWhereABaseWasToldThatItDoes) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    stand_at_a_fixed_place(t.store());
    const NavigationState& state = t.steps(3);
    const Fix& fix = state.epoch.fix;
    EXPECT_EQ(fix.type, FixType::time_only);
    EXPECT_TRUE(state.fix_ok);
    EXPECT_EQ(fix.satellites_used(), 12);
    EXPECT_NEAR(fix.position.latitude.deg(), 47.1, 1e-9);
    EXPECT_NEAR(fix.position.longitude.deg(), 8.2, 1e-9);
    EXPECT_NEAR(fix.position.height.above_ellipsoid.value(), 512.34, 1e-6);
    EXPECT_NEAR(fix.horizontal_accuracy.value(), 2, 1e-9);
    EXPECT_NEAR(fix.vertical_accuracy.value(), 2, 1e-9);
    EXPECT_EQ(fix.velocity.north, 0);
    EXPECT_EQ(fix.speed.value(), 0);
    t.store().set(in_ram, key::tmode_mode, 0);
    EXPECT_EQ(t.step().epoch.fix.type, FixType::fix_3d);
    EXPECT_NEAR(t.tracker().state().epoch.fix.position.latitude.deg(), 47, 1e-9);
}

TEST(StateTracker, KeepsItsFixedPlaceWithoutASolution) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    stand_at_a_fixed_place(t.store());
    t.steps(3);
    t.fix().type = FixType::none;
    const NavigationState& state = t.step();
    EXPECT_EQ(state.epoch.fix.type, FixType::none);
    EXPECT_FALSE(state.fix_ok);
    EXPECT_NEAR(state.epoch.fix.position.latitude.deg(), 47.1, 1e-9);
}

TEST(StateTracker, ListsTheSbasSatellitesOfItsScanMaskAlone) {
    const auto listed = [](std::uint64_t mask) {
        BoardProfile board = tracked_board();
        board.maker = MakerKind::ublox;
        board.constellations.push_back(sbas);
        Tracked t(board);
        add_satellites(t.fix(), sbas, 20, 5);
        t.tracker().start(t.fix().time, {}, true);
        t.store().set(in_ram, key::sbas_scan_mask, mask);
        std::vector<int> prns;
        for (const SatelliteStatus& s : t.step().epoch.fix.satellites)
            if (s.id.constellation == sbas) prns.push_back(s.id.number + 100);
        return prns;
    };
    EXPECT_THAT(listed(0x8), testing::ElementsAre(123));
    EXPECT_THAT(listed(0x11), testing::ElementsAre(120, 124));
    EXPECT_EQ(listed(0).size(), 5U) << "no mask: all";
}

TEST(StateTracker, TellsJammingOnlyWhenTheMonitorIsOn) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    const BandMonitor quiet = t.step().monitors.upper;
    EXPECT_EQ(quiet.jamming_state, 0);
    t.store().set(in_ram, key::itfm_enable, 1);
    EXPECT_EQ(t.step().monitors.jamming_state(), 1);
    t.front_end().interference = Decibels(12);
    const BandMonitor jammed = t.step().monitors.upper;
    EXPECT_EQ(jammed.jamming_state, 2);
    EXPECT_GT(jammed.jamming_indicator, quiet.jamming_indicator + 50);
    EXPECT_LT(jammed.agc, quiet.agc);
    EXPECT_GT(jammed.noise_per_ms, quiet.noise_per_ms);
    t.fix().type = FixType::none;
    EXPECT_EQ(t.step().monitors.jamming_state(), 3);
}

TEST(StateTracker, KeepsTheLevelThatIsToldInTwoDimensions) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    t.fix().geoid_undulation = Metres(48);
    t.store().set(in_ram, key::navspg_fixmode, 1);
    t.store().set(in_ram, key::navspg_constr_alt, 12345);
    const Fix& fix = t.step().epoch.fix;
    EXPECT_EQ(fix.type, FixType::fix_2d);
    EXPECT_NEAR(fix.position.height.above_ellipsoid.value(), 123.45 + 48, 1e-9);
    EXPECT_EQ(fix.velocity.down, 0);
    EXPECT_NEAR(fix.vertical_accuracy.value(), 1, 1e-9);
    EXPECT_TRUE(std::isnan(fix.dop.pdop) && std::isnan(fix.dop.vdop)) << "none of a height that is told";
    t.store().set(in_ram, key::navspg_fixmode, 3);
    EXPECT_EQ(t.step().epoch.fix.type, FixType::fix_3d);
}

TEST(StateTracker, CountsASurveyFromItsBegin) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    (void)t.step();
    t.store().set(in_ram, key::tmode_mode, 1);
    (void)t.step();
    (void)t.step();
    const NavigationState& state = t.step();
    ASSERT_TRUE(state.survey);
    EXPECT_NEAR(state.survey->time().value(), 2, 1e-9);
    EXPECT_EQ(state.survey->positions(), 3U);
    EXPECT_FALSE(state.survey->done()) << "no limit of accuracy is ever met that is not given";
    t.store().set(in_ram, key::tmode_mode, 0);
    EXPECT_FALSE(t.step().survey);
}

// 20 s, 1.5 m.
void survey_in(ConfigStore& store, std::uint64_t seconds = 20, std::uint64_t tenths_of_mm = 15000) {
    store.set(in_ram, legacy_key::tmode_svin_min_dur, seconds);
    store.set(in_ram, legacy_key::tmode_svin_acc_limit, tenths_of_mm);
    store.set(in_ram, key::tmode_mode, 1);
}

TEST(StateTracker, StandsWhereASurveyEnds) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    t.fix().horizontal_accuracy = Metres(0.6);
    t.fix().vertical_accuracy = Metres(0.8);
    survey_in(t.store());
    EXPECT_FALSE(t.steps(20).survey->done()) << "19 s";
    EXPECT_EQ(t.tracker().state().epoch.fix.type, FixType::fix_3d);
    const Geodetic at = t.fix().position;
    const NavigationState& state = t.step();
    ASSERT_TRUE(state.survey->done());
    EXPECT_EQ(state.epoch.fix.type, FixType::time_only);
    EXPECT_TRUE(state.fix_ok);
    EXPECT_NEAR(state.epoch.fix.position.latitude.deg(), at.latitude.deg(), 1e-9);
    // The first position in full, a hundredth of each of the 20 behind it.
    const double deviation = 1 / std::sqrt(1 + 20 * 0.01);
    EXPECT_NEAR(state.survey->accuracy().value(), deviation, 1e-9);
    EXPECT_NEAR(state.epoch.fix.horizontal_accuracy.value(), deviation, 1e-9);
    t.fix().position.latitude = Angle::degrees(47.5);
    EXPECT_NEAR(t.steps(5).epoch.fix.position.latitude.deg(), at.latitude.deg(), 1e-9) << "the place is settled";
    EXPECT_EQ(t.tracker().state().survey->positions(), 21U);
    EXPECT_NEAR(t.tracker().state().survey->time().value(), 20, 1e-9);
}

TEST(StateTracker, SurveysUntilItIsAccurateEnoughByPositionsInSpaceAlone) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    t.fix().horizontal_accuracy = Metres(3);
    t.fix().vertical_accuracy = Metres(4);
    survey_in(t.store(), 10, 35355);  // half of the variance of one: after 100 s
    EXPECT_FALSE(t.steps(100).survey->done());
    t.fix().type = FixType::fix_2d;
    EXPECT_FALSE(t.steps(5).survey->done());
    EXPECT_EQ(t.tracker().state().survey->positions(), 100U);
    t.fix().type = FixType::fix_3d;
    EXPECT_TRUE(t.steps(2).survey->done());
}

// A base station program ends a survey and begins another between two epochs.
TEST(StateTracker, SurveysAnewAfterTheModeWasOff) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    survey_in(t.store(), 3, 1'000'000);
    EXPECT_TRUE(t.steps(10).survey->done());
    survey_in(t.store(), 3, 1'000'000);
    t.adopt();
    EXPECT_TRUE(t.step().survey->done()) << "the same again";
    t.store().set(in_ram, key::tmode_mode, 0);
    t.adopt();
    survey_in(t.store(), 3, 1'000'000);
    t.adopt();
    EXPECT_EQ(t.step().survey->positions(), 1U);
    EXPECT_TRUE(t.steps(3).survey->done());
    survey_in(t.store(), 4, 1'000'000);
    EXPECT_EQ(t.step().survey->positions(), 1U) << "other limits";
}

TEST(StateTracker, TellsWhichBandIsJammedWhereItHasTwo) {
    for (const bool dual : {false, true}) {
        BoardProfile board = tracked_board();
        board.dual_frequency = dual;
        Tracked t(board);
        t.tracker().start(t.fix().time, {}, true);
        t.store().set(in_ram, key::itfm_enable, 1);
        t.front_end().lower_interference = Decibels(20);
        const MonitorStatus m = t.step().monitors;
        EXPECT_EQ(m.upper.jamming_state, 1);
        EXPECT_EQ(m.lower.jamming_state, dual ? 2 : 0);
        EXPECT_EQ(m.jamming_state(), dual ? 2 : 1);
    }
}

TEST(StateTracker, WatchesTheAntennaOnlyWithVoltageControl) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    t.front_end().antenna = AntennaStatus::short_circuit;
    EXPECT_EQ(t.step().monitors.antenna, AntennaStatus::unknown);
    EXPECT_EQ(t.tracker().state().monitors.antenna_power, 2);
    t.store().set(in_ram, key::ant_voltage_control, 1);
    EXPECT_EQ(t.step().monitors.antenna, AntennaStatus::short_circuit);
    EXPECT_EQ(t.tracker().state().monitors.antenna_power, 1);
    t.store().set(in_ram, key::ant_power_down, 1);
    EXPECT_EQ(t.step().monitors.antenna_power, 0);
}

TEST(StateTracker, TakesTheStateOfCorrections) {
    Tracked t(tracked_board());
    t.tracker().start(t.fix().time, {}, true);
    t.corrections().state = CorrectionState::rtk_float;
    EXPECT_EQ(t.step().epoch.fix.type, FixType::rtk_float);
    t.corrections().state = CorrectionState::rtk_fixed;
    EXPECT_EQ(t.step().epoch.fix.type, FixType::rtk_fixed);
    t.corrections().state = CorrectionState::differential;
    EXPECT_EQ(t.step().epoch.fix.type, FixType::dgnss);
    t.fix().type = FixType::none;
    EXPECT_EQ(t.step().epoch.fix.type, FixType::none);
}

}  // namespace
}  // namespace skyloop::firmware
