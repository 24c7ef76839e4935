// One pose that every dialect must read the same: it catches every slip of an axis, a sign or an order.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "base/geo/simulator_frames.hpp"
#include "run/feed/feed_dialect.hpp"

namespace skyloop {

// Near Zürich, flying north-east (3 m/s north, 4 m/s east) and climbing with 2 m/s, nose up 10°, banked 20° to the
// right, heading 53.13°. Turn rates 0.1, 0.2, 0.3 rad/s about forward, right, down.
struct NorthEastClimb {
    static constexpr double latitude = 47.3977, longitude = 8.5456, height = 510;
    static constexpr double north = 3, east = 4, up = 2;
    static constexpr double roll = 20, pitch = 10, yaw = 53.13;
    // The quaternion of these angles, body to north, east, down, from the half angles' sines and cosines:
    // w = cr cp cy + sr sp sy, x = sr cp cy − cr sp sy, y = cr sp cy + sr cp sy, z = cr cp sy − sr sp cy.
    static std::array<double, 4> quaternion() {
        const auto half = [](double degrees) { return Angle::degrees(degrees / 2).rad(); };
        const double sr = std::sin(half(roll)), cr = std::cos(half(roll));
        const double sp = std::sin(half(pitch)), cp = std::cos(half(pitch));
        const double sy = std::sin(half(yaw)), cy = std::cos(half(yaw));
        return {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                cr * cp * sy - sr * sp * cy};
    }
};

// How well a dialect's numbers hold the pose.
struct PoseTolerance {
    double degrees = 1e-9, metres = 1e-6, mps = 1e-6, attitude_deg = 1e-4, rate = 1e-6;
    bool attitude = true, rates = true;
};

inline void expect_pose(const TruthSample& sample, const PoseTolerance& within) {
    using Pose = NorthEastClimb;
    const Geodetic place = to_geodetic(sample.position);
    EXPECT_NEAR(place.latitude.deg(), Pose::latitude, within.degrees);
    EXPECT_NEAR(place.longitude.deg(), Pose::longitude, within.degrees);
    EXPECT_NEAR(place.height.above_ellipsoid.value(), Pose::height, within.metres);
    ASSERT_TRUE(sample.velocity);
    const Eigen::Vector3d ned = ned_to_ecef(place).conjugate() * sample.velocity->vector();
    EXPECT_NEAR(ned.x(), Pose::north, within.mps);
    EXPECT_NEAR(ned.y(), Pose::east, within.mps);
    EXPECT_NEAR(ned.z(), -Pose::up, within.mps);
    ASSERT_EQ(sample.attitude.has_value(), within.attitude);
    if (sample.attitude) {
        EXPECT_NEAR(sample.attitude->roll().deg(), Pose::roll, within.attitude_deg);
        EXPECT_NEAR(sample.attitude->pitch().deg(), Pose::pitch, within.attitude_deg);
        EXPECT_NEAR(sample.attitude->yaw().deg(), Pose::yaw, within.attitude_deg);
    }
    ASSERT_EQ(sample.turn_rate.has_value(), within.rates);
    if (sample.turn_rate) {
        EXPECT_NEAR(sample.turn_rate->x(), 0.1, within.rate);
        EXPECT_NEAR(sample.turn_rate->y(), 0.2, within.rate);
        EXPECT_NEAR(sample.turn_rate->z(), 0.3, within.rate);
    }
    EXPECT_FALSE(sample.acceleration);  // specific force is none
}

// Without a geoid: heights above the sea stand for heights above the ellipsoid.
inline std::unique_ptr<FeedDialect> dialect_named(std::string_view name, const FeedContext& context = {}) {
    auto dialect = make_dialect(name, context);
    if (!dialect) throw std::invalid_argument("no dialect " + std::string(name));
    return dialect;
}

inline FeedNews hear_text(FeedDialect& dialect, std::string_view text, std::int64_t received_ns = 0) {
    return dialect.hear(to_bytes(text), received_ns);
}

}  // namespace skyloop
