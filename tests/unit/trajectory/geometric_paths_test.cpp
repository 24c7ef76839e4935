#include "motion/trajectory/geometric_paths.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/geo/local_frame.hpp"

namespace skyloop {
namespace {

const GpsTime path_start = to_gps_time(2200, 1000.0);

// The path's own velocity against the difference of its positions.
void expect_consistent(const Trajectory& path, GpsTime time) {
    const Seconds step(0.01);
    const auto before = path.at(advanced(time, -step));
    const auto after = path.at(advanced(time, step));
    const Eigen::Vector3d slope = (after.position - before.position).vector() / (2 * step.value());
    EXPECT_LT((slope - path.at(time).velocity.vector()).norm(), 1e-3);
}

TEST(FixedPoint, StandsStill) {
    const FixedPoint path(Geodetic::degrees(46.4775, 30.7326, 77));
    const TruthState a = path.at(path_start);
    const TruthState b = path.at(advanced(path_start, Seconds(1e5)));
    EXPECT_EQ((a.position - b.position).vector().norm(), 0);
    EXPECT_EQ(a.velocity.vector().norm(), 0);
    EXPECT_NEAR(a.geodetic.latitude.deg(), 46.4775, 1e-12);
}

TEST(Waypoints, RunsItsLegsAtTheirSpeedsAndHolds) {
    const Geodetic a = Geodetic::degrees(47, 8, 400);
    const Geodetic b = Geodetic::degrees(47.01, 8, 500);
    const Geodetic c = Geodetic::degrees(47.01, 8.02, 500);
    const Waypoints path(path_start,
                         {{a, MetresPerSecond(20), Seconds(5)}, {b, MetresPerSecond(10), Seconds(3)}, {c, {}, {}}});
    EXPECT_EQ(path.at(advanced(path_start, Seconds(4))).velocity.vector().norm(), 0);
    const LocalFrame frame(a);
    const TruthState moving = path.at(advanced(path_start, Seconds(10)));
    const Eigen::Vector3d v = frame.to_enu(moving.velocity).vector();
    EXPECT_NEAR(v.y(), 20, 0.01);
    EXPECT_NEAR(std::hypot(v.x(), v.y()), 20, 0.01);
    EXPECT_GT(v.z(), 1);
    for (const double t : {10.0, 40.0, 80.0, 150.0})
        expect_consistent(path, advanced(path_start, Seconds(t)));
    const TruthState end = path.at(advanced(path_start, path.duration() + Seconds(100)));
    EXPECT_NEAR(end.geodetic.longitude.deg(), 8.02, 1e-9);
    EXPECT_EQ(end.velocity.vector().norm(), 0);
}

TEST(Waypoints, ClimbsStraightUp) {
    const Geodetic a = Geodetic::degrees(-33, 151, 0);
    const Geodetic b = Geodetic::degrees(-33, 151, 100);
    const Waypoints path(path_start, {{a, MetresPerSecond(5), {}}, {b, {}, {}}});
    EXPECT_NEAR(path.duration().value(), 20, 1e-9);
    const TruthState state = path.at(advanced(path_start, Seconds(10)));
    EXPECT_NEAR(state.geodetic.height.above_ellipsoid.value(), 50, 1e-6);
    EXPECT_NEAR(LocalFrame(a).to_enu(state.velocity).vector().z(), 5, 1e-6);
}

TEST(Waypoints, CrossesTheDateLineAndThePole) {
    for (const auto& [a, b] : {std::pair{Geodetic::degrees(10, 179.99, 0), Geodetic::degrees(10, -179.99, 0)},
                               std::pair{Geodetic::degrees(89.99, 0, 0), Geodetic::degrees(89.99, 180, 0)}}) {
        const Waypoints path(path_start, {{a, MetresPerSecond(50), {}}, {b, {}, {}}});
        EXPECT_LT(path.duration().value(), 60);
        expect_consistent(path, advanced(path_start, path.duration() * 0.3));
    }
}

TEST(Circle, KeepsItsRadiusAndSpeed) {
    const Circle::Shape shape{Geodetic::degrees(52, 13, 80), Metres(250), MetresPerSecond(15), Angle::degrees(90)};
    const Circle path(path_start, shape);
    const LocalFrame frame(shape.centre);
    EXPECT_NEAR(frame.to_enu(path.at(path_start).position).vector().x(), 250, 0.01);
    // Clockwise: from the east point it goes south.
    EXPECT_NEAR(frame.to_enu(path.at(path_start).velocity).vector().y(), -15, 0.01);
    for (const double t : {7.0, 33.0, 99.0}) {
        const TruthState state = path.at(advanced(path_start, Seconds(t)));
        EXPECT_NEAR(frame.to_enu(state.position).vector().head<2>().norm(), 250, 0.01);
        EXPECT_NEAR(state.velocity.vector().norm(), 15, 0.01);
        EXPECT_NEAR(state.geodetic.height.above_ellipsoid.value(), 80, 1e-6);
        expect_consistent(path, advanced(path_start, Seconds(t)));
    }
}

}  // namespace
}  // namespace skyloop
