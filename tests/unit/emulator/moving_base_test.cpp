// The vector between two antennas, as its rover solves it.
#include "run/emulator/moving_base.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/geo/local_frame.hpp"

namespace skyloop {
namespace {

const GpsTime pair_start = to_gps_time(2400, 0);
const Geodetic pair_place = Geodetic::degrees(46, 30, 100);

// An antenna so far east, north and up of the base's place, with a fix.
Trace antenna_trace(const Position<Enu>& place, int second, FixType type = FixType::fix_3d) {
    Trace trace;
    trace.truth.time = pair_start + std::chrono::seconds(second);
    trace.truth.position = LocalFrame(pair_place).to_ecef(place);
    trace.truth.geodetic = to_geodetic(trace.truth.position);
    trace.epoch.fix.type = type;
    return trace;
}

const Position<Enu> at_base(0, 0, 0);

TEST(MovingBase, GivesTheTrueVectorWithAnError) {
    MovingBase pair(1);
    const Position<Enu> rover(0.6, 0.8, -0.25);
    double squares = 0, sum = 0;
    constexpr int epochs = 20000;
    for (int i = 0; i < epochs; ++i) {
        const auto relative = pair.relate(antenna_trace(at_base, i), antenna_trace(rover, i));
        ASSERT_TRUE(relative);
        EXPECT_TRUE(relative->base_moves);
        if (!relative->fixed) continue;
        EXPECT_NEAR(relative->deviation.value(), 0.005, 1e-5);
        EXPECT_NEAR(relative->east_m, 0.6, 0.03);
        EXPECT_NEAR(relative->down_m, 0.25, 0.03);
        sum += relative->north_m - 0.8;
        squares += std::pow(relative->north_m - 0.8, 2);
    }
    EXPECT_NEAR(std::sqrt(squares / epochs), 0.005, 0.001);
    EXPECT_NEAR(sum / epochs, 0, 0.001);
}

TEST(MovingBase, IsFloatUntilBothHaveHadAFixForLong) {
    MovingBase pair(1);
    const auto fixed_at = [&](int second, FixType base, FixType rover) {
        const auto relative =
            pair.relate(antenna_trace(at_base, second, base), antenna_trace({1, 0, 0}, second, rover));
        return relative ? std::string(relative->fixed ? "fixed" : "float") : "none";
    };
    EXPECT_EQ(fixed_at(0, FixType::none, FixType::fix_3d), "none");
    EXPECT_EQ(fixed_at(1, FixType::fix_3d, FixType::none), "none");
    EXPECT_EQ(fixed_at(2, FixType::fix_3d, FixType::fix_3d), "float");
    EXPECT_EQ(fixed_at(6, FixType::fix_3d, FixType::fix_3d), "float");
    EXPECT_EQ(fixed_at(7, FixType::fix_3d, FixType::fix_2d), "fixed");
    EXPECT_EQ(fixed_at(8, FixType::dead_reckoning, FixType::fix_3d), "none") << "nothing was measured";
    EXPECT_EQ(fixed_at(9, FixType::fix_3d, FixType::fix_3d), "float") << "searched anew";
    EXPECT_EQ(fixed_at(14, FixType::fix_3d, FixType::fix_3d), "fixed");
}

// Five epochs of the rover to one of its base.
TEST(MovingBase, HoldsTheFixBetweenEpochsOfASlowerBase) {
    MovingBase pair(1);
    const auto rover_at = [](double second, FixType type = FixType::fix_3d) {
        Trace trace = antenna_trace({1, 0, 0}, 0, type);
        trace.truth.time = advanced(pair_start, Seconds(second));
        return trace;
    };
    const auto last_until = [&](double second) {
        pair.hold(rover_at(second));
        return pair.fix_type();
    };
    EXPECT_EQ(last_until(-0.2), std::nullopt);
    for (int second = 0; second < 10; ++second) {
        const auto relative = pair.relate(antenna_trace(at_base, second), rover_at(second));
        ASSERT_TRUE(relative);
        EXPECT_EQ(relative->fixed, second >= 5) << second;
        const FixType expected = second < 5 ? FixType::rtk_float : FixType::rtk_fixed;
        for (const double later : {0.0, 0.2, 0.4, 0.6, 0.8})
            EXPECT_EQ(last_until(second + later), expected) << second + later;
    }
    EXPECT_EQ(last_until(19), FixType::rtk_fixed);
    EXPECT_EQ(last_until(19.2), std::nullopt) << "10 s after the base's last epoch";
    EXPECT_FALSE(pair.relate(antenna_trace(at_base, 20), rover_at(20))->fixed);
    pair.hold(rover_at(20.2, FixType::dead_reckoning));
    EXPECT_EQ(pair.fix_type(), std::nullopt) << "no fix of its own";
}

TEST(MovingBase, LongVectorsAreLessAccurate) {
    MovingBase pair(1, {{0.005, Seconds(30)}, {0.3, Seconds(30)}, 1e-6, Seconds(0)});
    const auto relative = pair.relate(antenna_trace(at_base, 0), antenna_trace({5000, 0, 0}, 0));
    ASSERT_TRUE(relative);
    EXPECT_NEAR(relative->deviation.value(), 0.010, 1e-5) << "one part per million more";
    EXPECT_TRUE(relative->fixed);
}

TEST(MovingBase, SeedsDiffer) {
    MovingBase one(1), same(1), other(2);
    const Trace base = antenna_trace(at_base, 0), rover = antenna_trace({1, 0, 0}, 0);
    const double north = one.relate(base, rover)->north_m;
    EXPECT_EQ(same.relate(base, rover)->north_m, north);
    EXPECT_NE(other.relate(base, rover)->north_m, north);
}

}  // namespace
}  // namespace skyloop
