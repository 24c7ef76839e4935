/// What every flown route keeps.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "motion/trajectory/route.hpp"

namespace skyloop::test {

/// How near a path passes to each waypoint that was kept, at most; it is looked at every tenth of a second. Of a long
/// route some hundred waypoints are looked at.
inline double farthest_from_waypoints(const FlownRoute& route) {
    constexpr double step_s = 0.1;
    constexpr std::size_t enough = 100;
    const std::size_t stride = 1 + route.waypoints.size() / enough;
    std::vector<double> nearest((route.waypoints.size() + stride - 1) / stride, 1e12);
    for (double t = 0; t <= route.shape->duration() + step_s; t += step_s) {
        const Eigen::Vector3d place = route.shape->at(t).position;
        for (std::size_t i = 0; i < nearest.size(); ++i)
            nearest[i] = std::min(nearest[i], (place - route.waypoints[i * stride].place).squaredNorm());
    }
    return std::sqrt(*std::max_element(nearest.begin(), nearest.end()));
}

/// Flies a route: it ends where it should, keeps the limits of its vehicle, and what goes straight in space passes
/// each place that was kept within the tolerance.
inline void expect_flown_route(const Track& track, const RouteSettings& settings) {
    const auto route = fly_route(track, settings);
    ASSERT_TRUE(route.has_value()) << route.error().message;
    if (!std::isfinite(route->shape->duration())) return;
    const VehicleLimits limits = usual_limits(route->vehicle);
    constexpr double step_s = 0.1;
    double fastest = 0, hardest = 0;
    for (double t = 0; t < route->shape->duration(); t += step_s) {
        const LocalMotion m = route->shape->at(t);
        ASSERT_TRUE(m.position.allFinite() && m.velocity.allFinite() && m.acceleration.allFinite());
        fastest = std::max(fastest, limits.is_steered() ? m.velocity.head<2>().norm() : m.velocity.norm());
        hardest = std::max(hardest, m.acceleration.norm());
    }
    const double speed = settings.speed.value_or(track.route->speed.value_or(limits.along.speed));
    EXPECT_LE(fastest, speed * 1.05);
    EXPECT_LE(hardest, std::hypot(limits.lateral, limits.along.acceleration) * 1.05);
    EXPECT_LT((route->shape->at(0).position - route->waypoints.front().place).head<2>().norm(), 1e-6);
    EXPECT_LT((route->shape->at(1e9).position - route->waypoints.back().place).head<2>().norm(), 1e-3);
    if (!limits.is_steered()) {
        EXPECT_LE(farthest_from_waypoints(*route), settings.tolerance + 0.5);
    }
}

}  // namespace skyloop::test
