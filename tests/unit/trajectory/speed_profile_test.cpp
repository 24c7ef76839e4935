// S-curves: they end where they should, and keep their limits (FEEDS.md 2.1).
#include "motion/trajectory/vehicle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace skyloop {
namespace {

// The closed form of the time from rest to rest.
double rest_to_rest_time(double length, const SpeedLimits& l) {
    const double a = l.acceleration, j = l.jerk;
    double ramp = l.speed * j < a * a ? 2 * std::sqrt(l.speed / j) : a / j + l.speed / a;
    const double cruise = length / l.speed - ramp;
    if (cruise >= 0) return 2 * ramp + cruise;
    const double tj = length >= 2 * a * a * a / (j * j) ? a / j : std::cbrt(length / (2 * j));
    ramp = length >= 2 * a * a * a / (j * j) ? tj / 2 + std::sqrt(tj * tj / 4 + length / a) : 2 * tj;
    return 2 * ramp;
}

TEST(SpeedProfile, GoesFromRestToRestInTheShortestTime) {
    for (const double length : {0.01, 0.5, 3.0, 40.0, 1000.0, 1e5})
        for (const SpeedLimits& limits : {SpeedLimits{12, 4, 8}, {20, 2, 1}, {5, 1.5, 2}, {6, 0.5, 0.4}, {1.4, 1, 2}}) {
            SpeedProfile profile;
            profile.run(length, 0, limits);
            EXPECT_NEAR(profile.duration(), rest_to_rest_time(length, limits), 1e-6 * profile.duration());
            double speed = 0, acceleration = 0;
            for (int i = 0; i <= 2000; ++i) {
                const AlongWay along = profile.at(profile.duration() * i / 2000);
                speed = std::max(speed, along.speed);
                acceleration = std::max(acceleration, std::abs(along.acceleration));
                EXPECT_GE(along.speed, -1e-9);
            }
            EXPECT_LE(speed, limits.speed * (1 + 1e-9));
            EXPECT_LE(acceleration, limits.acceleration * (1 + 1e-9));
            const AlongWay end = profile.at(profile.duration());
            EXPECT_NEAR(end.way, length, 1e-9 * length);
            EXPECT_EQ(end.speed, 0);
            // Nothing jumps at the joints, the end included.
            const AlongWay near_end = profile.at(profile.duration() - 1e-7);
            EXPECT_NEAR(near_end.way, length, 1e-6);
            EXPECT_NEAR(near_end.speed, 0, 1e-6);
        }
}

TEST(SpeedProfile, ChangesItsSpeedWithinALength) {
    const SpeedLimits limits{30, 2, 1};
    for (const double length : {1.0, 10.0, 100.0, 1000.0}) {
        const double reached = fastest_after(5, length, limits);
        EXPECT_LE(speed_change_length(5, reached, limits), length * (1 + 1e-9));
        if (reached < limits.speed) {
            EXPECT_NEAR(speed_change_length(5, reached, limits), length, 1e-6 * length);
        }
        SpeedProfile profile(5);
        profile.run(length, reached, limits);
        EXPECT_NEAR(profile.length(), length, 1e-9);
        EXPECT_NEAR(profile.at(profile.duration() - 1e-9).way, length, 1e-6);
    }
    EXPECT_EQ(fastest_after(5, 0, limits), 5);
}

TEST(SpeedProfile, StandsAndGoesOnForEver) {
    SpeedProfile profile;
    profile.keep(10);
    profile.change(4, {4, 1, 1});
    profile.keep(std::numeric_limits<double>::infinity());
    EXPECT_EQ(profile.at(9.9).way, 0);
    EXPECT_TRUE(std::isinf(profile.duration()));
    const double before = profile.at(1e5).way;
    EXPECT_NEAR(profile.at(1e5 + 10).way - before, 40, 1e-6);
}

}  // namespace
}  // namespace skyloop
