/// What every generated path keeps: its velocity is the slope of its position, its acceleration that of its velocity
/// and without a step, and it begins and ends at rest.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "motion/trajectory/local_shape.hpp"

namespace skyloop::test {

/// The largest values that were seen on the way.
struct PathExtremes {
    double speed = 0, acceleration = 0, jerk = 0, climb = 0, sink = 0;
};

inline void expect_finite(const LocalMotion& m, double t) {
    ASSERT_TRUE(m.position.allFinite() && m.velocity.allFinite() && m.acceleration.allFinite()) << "t = " << t;
    ASSERT_TRUE(std::isfinite(m.heading) && std::isfinite(m.roll) && std::isfinite(m.pitch)) << "t = " << t;
}

/// @param horizon s, of an endless path
/// @param most_jerk m/s³, of which the steps of the acceleration are judged
inline PathExtremes expect_path_laws(const LocalShape& shape, double horizon, double most_jerk) {
    constexpr double step = 1e-4;
    constexpr int samples = 4000;
    const double end = std::min(horizon, shape.duration());
    std::mt19937_64 engine(7);
    std::uniform_real_distribution<double> anywhere(0, end);
    PathExtremes most;
    int failures = 0;
    for (int i = 0; i < samples && failures < 5; ++i) {
        const double t = anywhere(engine);
        if (t < step || t > end - step) continue;
        const LocalMotion before = shape.at(t - step), now = shape.at(t), after = shape.at(t + step);
        expect_finite(now, t);
        const Eigen::Vector3d slope = (after.position - before.position) / (2 * step);
        const Eigen::Vector3d bend = (after.velocity - before.velocity) / (2 * step);
        const double jerk = (after.acceleration - before.acceleration).norm() / (2 * step);
        const double scale = 1 + now.velocity.norm();
        const bool good = (slope - now.velocity).norm() < 1e-6 * scale + most_jerk * step * step &&
                          (bend - now.acceleration).norm() < most_jerk * step + 1e-5 * scale && jerk < 1.05 * most_jerk;
        EXPECT_TRUE(good) << "t = " << t << ", v " << now.velocity.transpose() << " slope " << slope.transpose()
                          << ", a " << now.acceleration.transpose() << " bend " << bend.transpose() << ", jerk "
                          << jerk;
        failures += good ? 0 : 1;
        most.speed = std::max(most.speed, now.velocity.norm());
        most.acceleration = std::max(most.acceleration, now.acceleration.norm());
        most.jerk = std::max(most.jerk, jerk);
        most.climb = std::max(most.climb, now.velocity.z());
        most.sink = std::max(most.sink, -now.velocity.z());
    }
    EXPECT_LT(shape.at(0).velocity.norm(), 1e-9);
    EXPECT_LT(shape.at(0).acceleration.norm(), 1e-9);
    EXPECT_LT((shape.at(-5).position - shape.at(0).position).norm(), 1e-9);
    if (std::isfinite(shape.duration())) {
        EXPECT_LT(shape.at(shape.duration()).velocity.norm(), 1e-6);
        EXPECT_LT(shape.at(shape.duration()).acceleration.norm(), 1e-6);
        EXPECT_LT((shape.at(shape.duration() + 1e6).position - shape.at(shape.duration()).position).norm(), 1e-9);
    }
    for (double t = 0; t < 86400; t += 97.3)
        expect_finite(shape.at(t), t);
    return most;
}

/// The fastest change of where it looks, rad/s.
inline double fastest_yaw(const LocalShape& shape, double horizon) {
    constexpr double step_s = 1e-3;
    double most = 0;
    for (double t = 0; t < std::min(horizon, shape.duration()); t += step_s)
        most = std::max(
            most, std::abs(std::remainder(shape.at(t + step_s).heading - shape.at(t).heading, 2 * std::numbers::pi)));
    return most / step_s;
}

}  // namespace skyloop::test
