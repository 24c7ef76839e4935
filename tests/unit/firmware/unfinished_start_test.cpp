// What a start knows that comes before an earlier one has found out all that it had forgotten.
#include <gtest/gtest.h>

#include "firmware/core/receiver.hpp"
#include "firmware/core/state_tracker.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

// A receiver with one epoch a second, without measurements, which starts cold. Of Galileo it learns the leap seconds
// 30 s after it has heard it first.
struct Unfinished {
    Unfinished() : board(sample_board(NmeaVersion::v4_10, {Constellation::gps, Constellation::galileo})) {
        board.timing.cold_start = Seconds(26);
        board.timing.warm_start = Seconds(22);
        board.timing.hot_start = Seconds(1.5);
        for (const Constellation system : board.constellations)
            add_satellites(fix, system, 1, 8);
        start(StartKind::cold);
    }
    void start(StartKind kind) { tracker.start(fix.time, Forgotten::of(kind)); }
    const NavigationState& step(int epochs = 1) {
        for (int i = 0; i < epochs; ++i) {
            fix.time += 1s;
            tracker.update(Epoch{fix}, receiver_config(store, board), {});
        }
        return tracker.state();
    }

    BoardProfile board;
    ConfigStore store{factory_config(board)};
    StateTracker tracker{board};
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
};

TEST(UnfinishedStart, GoesOnBeneathAStartThatForgetsLess) {
    for (const StartKind kind : {StartKind::hot, StartKind::warm}) {
        Unfinished r;
        r.step(3);
        r.start(kind);
        for (int second = 4; second < 26; ++second) {
            SCOPED_TRACE(second);
            const NavigationState& state = r.step();
            EXPECT_EQ(state.epoch.fix.type, FixType::none);
            EXPECT_FALSE(state.position_known || state.time.leap_seconds);
            EXPECT_EQ(state.time.time, second >= 4 + 8) << "heard anew from 4 s on";
            EXPECT_EQ(state.time.date, second >= 4 + 14);
            for (const SatelliteStatus& s : state.epoch.fix.satellites)
                EXPECT_FALSE(s.has_ephemeris);
        }
        EXPECT_EQ(r.step().epoch.fix.type, FixType::fix_3d);
        EXPECT_FALSE(r.tracker.state().time.leap_seconds);
        EXPECT_EQ(r.tracker.state().since_start.value(), 23);
    }
}

TEST(UnfinishedStart, TakesNoLessTimeThanTheLaterStart) {
    Unfinished r;
    r.step(25);
    r.start(StartKind::hot);
    EXPECT_EQ(r.step().epoch.fix.type, FixType::none) << "26 s, but only 1 s of it tracked";
    EXPECT_EQ(r.step().epoch.fix.type, FixType::fix_3d);
}

TEST(UnfinishedStart, IsFinishedByAFix) {
    Unfinished r;
    EXPECT_EQ(r.step(26).epoch.fix.type, FixType::fix_3d);
    r.start(StartKind::hot);
    const NavigationState& state = r.step();
    EXPECT_TRUE(state.time.time && state.time.date);
    EXPECT_FALSE(state.time.leap_seconds) << "they have not been sent yet";
    EXPECT_EQ(r.step().epoch.fix.type, FixType::fix_3d);
}

TEST(UnfinishedStart, LeavesNothingToAResetThatKeepsEverything) {
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
    add_satellites(fix, Constellation::gps, 1, 12);
    GpsTime now = fix.time;
    Receiver receiver(sample_ublox(), {});
    receiver.start(now);
    const auto wait = [&](int seconds) {
        for (int i = 0; i < seconds; ++i) {
            fix.time = now += 1s;
            receiver.output(now);
            receiver.on_epoch({fix}, {});
        }
    };
    const auto reset = [&](std::uint16_t mask) {
        constexpr std::uint8_t navigation_alone = 2;
        receiver.input(PortId::uart1, encode_frame(CfgRst{mask, navigation_alone, 0}), now);
    };
    wait(2);
    reset(0xFFFF);
    wait(4);
    reset(0x0000);
    wait(3);
    const NavigationState& state = receiver.state();
    EXPECT_FALSE(state.time.time || state.time.date || state.time.leap_seconds);
    EXPECT_EQ(state.epoch.fix.type, FixType::none);
}

}  // namespace
}  // namespace skyloop::firmware
