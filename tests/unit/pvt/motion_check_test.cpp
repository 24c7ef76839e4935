#include "receiver/pvt/motion_check.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

const GpsTime check_start = to_gps_time(2300, 1000.0);
constexpr double g = 9.80665;

// Epochs of which a climb with so much acceleration loses some, at 10 Hz.
int lost_in_a_climb(DynamicModel model, double acceleration, double seconds) {
    MotionCheck check;
    const MotionLimits limits = motion_limits({.dynamic_model = model});
    int lost = 0;
    double up = 0;
    for (int i = 0; i < 100; ++i) {
        const double t = 0.1 * i;
        if (t >= 2 && t < 2 + seconds) up += 0.1 * acceleration;
        lost += check.passes(limits, advanced(check_start, Seconds(t)), Metres(100), {0, 0, up}) ? 0 : 1;
    }
    return lost;
}

// Betaflight issue 14330: no satellites at full throttle with the model of 1 g, all with that of 4 g.
TEST(MotionCheck, LosesWhatTheModelDoesNotExpect) {
    EXPECT_GT(lost_in_a_climb(DynamicModel::airborne_1g, 2.5 * g, 3), 25);
    EXPECT_GT(lost_in_a_climb(DynamicModel::airborne_2g, 2.5 * g, 3), 15);
    EXPECT_EQ(lost_in_a_climb(DynamicModel::airborne_4g, 2.5 * g, 3), 0);
    EXPECT_EQ(lost_in_a_climb(DynamicModel::airborne_1g, 0.8 * g, 3), 0);
}

TEST(MotionCheck, LetsAKnockPassAndAPauseSayNothing) {
    EXPECT_EQ(lost_in_a_climb(DynamicModel::airborne_2g, 5 * g, 0.1), 0);
    MotionCheck check;
    const MotionLimits limits = motion_limits({.dynamic_model = DynamicModel::airborne_1g});
    EXPECT_TRUE(check.passes(limits, check_start, Metres(0), {0, 0, 0}));
    EXPECT_TRUE(check.passes(limits, advanced(check_start, Seconds(5)), Metres(0), {80, 0, 0}));
}

TEST(MotionCheck, KeepsTheLimitsOfHeightAndSpeed) {
    const MotionLimits limits = motion_limits({.dynamic_model = DynamicModel::pedestrian});
    EXPECT_TRUE(MotionCheck().passes(limits, check_start, Metres(8999), {20, 20, 19}));
    EXPECT_FALSE(MotionCheck().passes(limits, check_start, Metres(9001), {0, 0, 0}));
    EXPECT_FALSE(MotionCheck().passes(limits, check_start, Metres(0), {25, 20, 0}));
    EXPECT_FALSE(MotionCheck().passes(limits, check_start, Metres(0), {0, 0, -21}));
}

TEST(MotionLimits, GrowWithTheModel) {
    const auto limits = [](DynamicModel model) { return motion_limits({.dynamic_model = model}); };
    EXPECT_EQ(limits(DynamicModel::sea).height, Metres(500));
    EXPECT_EQ(limits(DynamicModel::portable).vertical_speed, MetresPerSecond(50));
}

// u-blox 8 / u-blox M8 receiver description (UBX-13003221), table of the dynamic platform models: no limit of speed.
TEST(MotionLimits, OfAirborneModelsAreTheCeilingAndTheAcceleration) {
    for (const auto model : {DynamicModel::airborne_1g, DynamicModel::airborne_2g, DynamicModel::airborne_4g}) {
        const MotionLimits limits = motion_limits({.dynamic_model = model, .airborne_ceiling = Metres(50'000)});
        EXPECT_EQ(limits.height, Metres(50'000));
        EXPECT_GT(limits.vertical_speed, MetresPerSecond(20'000));
        EXPECT_GT(limits.horizontal_speed, MetresPerSecond(500));
        EXPECT_LT(limits.acceleration, 4.1 * g);
    }
}

TEST(MotionLimits, AreThoseOfBoardsThatHaveDynamicModels) {
    const MotionLimits limits = motion_limits({.dynamic_model = DynamicModel::sea, .dynamic_limits = false});
    EXPECT_GT(limits.height, Metres(100'000));
    EXPECT_GT(limits.vertical_speed, MetresPerSecond(1000));
}

}  // namespace
}  // namespace skyloop
