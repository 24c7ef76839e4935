#include <gtest/gtest.h>

#include "firmware/core/factory_settings.hpp"
#include "firmware/core/state_tracker.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

// A receiver that has gone 125 m, the last 50 m of them since its odometer was reset.
struct Driven {
    Driven() {
        board.identity.generation = 9;
        add_satellites(fix, Constellation::gps, 1, 8);
        tracker.start(fix.time, {}, true);
        fix.speed_accuracy = MetresPerSecond(1.25);
        drive(7);
        tracker.reset_odometer();
        drive(4);
    }
    void drive(int epochs) {
        for (int i = 0; i < epochs; ++i) {
            fix.time += 1s;
            tracker.update({fix}, config, {});
        }
    }
    [[nodiscard]] const NavigationState& state() const { return tracker.state(); }

    BoardProfile board = sample_board(NmeaVersion::v4_10, {Constellation::gps});
    ReceiverConfig config = factory_settings(board, {});
    StateTracker tracker{board};
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
};

TEST(Odometer, GoesOnOverHotAndWarmStarts) {
    for (const StartKind kind : {StartKind::hot, StartKind::warm}) {
        Driven driven;
        const double deviation = driven.state().odometer_deviation_m;
        driven.tracker.start(driven.fix.time, Forgotten::of(kind));
        EXPECT_NEAR(driven.state().odometer_m, 50, 1e-9);
        EXPECT_NEAR(driven.state().odometer_total_m, 125, 1e-9);
        EXPECT_GT(deviation, 0);
        EXPECT_EQ(driven.state().odometer_deviation_m, deviation);
    }
}

TEST(Odometer, BeginsAnewWithAColdStart) {
    Driven driven;
    driven.tracker.start(driven.fix.time, Forgotten::of(StartKind::cold));
    EXPECT_EQ(driven.state().odometer_m, 0);
    EXPECT_EQ(driven.state().odometer_total_m, 0);
    EXPECT_EQ(driven.state().odometer_deviation_m, 0);
}

}  // namespace
}  // namespace skyloop::firmware
