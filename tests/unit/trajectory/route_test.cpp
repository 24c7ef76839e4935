// Places without times, flown.
#include "motion/trajectory/route.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "base/geo/local_frame.hpp"
#include "path_laws.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

const Geodetic route_origin = Geodetic::degrees(47, 8, 500);

Track route_of(const std::vector<Eigen::Vector3d>& places) {
    Track track;
    track.name = "r.gpx";
    const LocalFrame frame(route_origin);
    for (const Eigen::Vector3d& place : places) {
        TrackRow row;
        row.position = frame.to_ecef(Position<Enu>(place.x(), place.y(), place.z()));
        track.points.push_back(row);
    }
    track.route.emplace();
    track.route->why = "no times in it";
    return track;
}

// A wandering way with the noise of a receiver.
std::vector<Eigen::Vector3d> noisy_way(std::size_t count, double step_m, double noise_m) {
    std::mt19937_64 engine(11);
    std::normal_distribution<double> noise(0, noise_m), bend(0, 0.03);
    std::vector<Eigen::Vector3d> places;
    Eigen::Vector2d at(0, 0);
    double heading = 0, turn = 0;
    for (std::size_t i = 0; i < count; ++i) {
        turn = 0.9 * turn + bend(engine);
        heading += turn;
        at += step_m * Eigen::Vector2d(std::sin(heading), std::cos(heading));
        places.emplace_back(at.x() + noise(engine), at.y() + noise(engine), noise(engine));
    }
    return places;
}

TEST(Route, KeepsOnlyThePlacesThatMatter) {
    std::vector<Eigen::Vector3d> places;
    for (int i = 0; i <= 100; ++i)
        places.emplace_back(i < 50 ? i : 50, i < 50 ? 0 : i - 50, i == 20 ? 1.5 : 0);
    EXPECT_EQ(places_that_matter(places, 2), (std::vector<std::size_t>{0, 50, 100}));
    EXPECT_EQ(places_that_matter(places, 1), (std::vector<std::size_t>{0, 19, 20, 21, 50, 100}));
    EXPECT_TRUE(places_that_matter({}, 1).empty());
    EXPECT_EQ(places_that_matter(std::vector<Eigen::Vector3d>(1), 1), std::vector<std::size_t>{0});
}

TEST(Route, EveryPlaceLiesWithinTheToleranceOfTheWayBetweenThoseKept) {
    const auto places = noisy_way(5000, 3, 1);
    const auto kept = places_that_matter(places, 2.5);
    EXPECT_LT(kept.size(), 2500u);
    double farthest = 0;
    for (std::size_t k = 1; k < kept.size(); ++k)
        for (std::size_t i = kept[k - 1]; i < kept[k]; ++i) {
            const Eigen::Vector3d a = places[kept[k - 1]], leg = places[kept[k]] - a;
            const double along = std::clamp((places[i] - a).dot(leg) / leg.squaredNorm(), 0.0, 1.0);
            farthest = std::max(farthest, (places[i] - a - along * leg).norm());
        }
    EXPECT_LE(farthest, 2.5);
    EXPECT_GT(farthest, 1.5);
}

// Ten thousand places are planned in about a second, and every vehicle keeps its limits on them.
TEST(Route, ManyNoisyPlacesAreFlownWithinTheLimits) {
    const Track track = route_of(noisy_way(10'000, 3, 1));
    for (const VehicleClass vehicle : driven_vehicles) {
        SCOPED_TRACE(traits_of(vehicle).name);
        const auto begin = std::chrono::steady_clock::now();
        const auto route = fly_route(track, {vehicle, {}, 2, 0});
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        ASSERT_TRUE(route.has_value()) << route.error().message;
        EXPECT_LT(taken.count(), 20) << "on a loaded machine, without optimisation";
        RecordProperty(std::string(traits_of(vehicle).name), std::to_string(taken.count()));
        const VehicleLimits limits = usual_limits(vehicle);
        constexpr double no_step = 40;  // m/s³
        const auto most = test::expect_path_laws(*route->shape, 1e6, no_step);
        EXPECT_LE(most.speed, limits.along.speed * 1.07);
        EXPECT_LE(most.acceleration, std::hypot(limits.lateral, limits.along.acceleration) * 1.05);
        EXPECT_LE(most.climb, limits.climb * 1.01);
        EXPECT_LE(most.sink, limits.sink * 1.01);
    }
}

TEST(Route, TellsHowItIsFlown) {
    const Track track = route_of({{0, 0, 0}, {0, 100, 0}, {0, 200, 0.5}, {100, 200, 0}});
    const auto route = fly_route(track, {VehicleClass::rover, 3, 2, 0});
    ASSERT_TRUE(route.has_value()) << route.error().message;
    EXPECT_EQ(route->waypoints.size(), 3u);
    EXPECT_THAT(route->notes,
                testing::ElementsAre("no times in it: flown as a route of 4 points at 3 m/s, as a rover",
                                     HasSubstr("1 places lie within 2 m of the way between the other 3")));
    const RoutePath path(*route, to_gps_time(2300, 0));
    EXPECT_GT(path.duration().value(), 100);
    EXPECT_LT((path.at(to_gps_time(2300, 0)).position - track.points[0].position).length().value(), 1e-6);
    EXPECT_NEAR(path.at(advanced(to_gps_time(2300, 0), Seconds(20))).velocity.length().value(), 3, 1e-3)
        << "at a height of 500 m over the ellipsoid";
}

TEST(Route, OnePlaceIsStoodAt) {
    for (const std::vector<Eigen::Vector3d>& places :
         {std::vector<Eigen::Vector3d>{{3, 4, 5}}, std::vector<Eigen::Vector3d>{{3, 4, 5}, {3, 4, 5}}}) {
        const auto route = fly_route(route_of(places), {});
        ASSERT_TRUE(route.has_value()) << route.error().message;
        EXPECT_TRUE(std::isinf(route->shape->duration()));
        EXPECT_THAT(route->notes, testing::ElementsAre(HasSubstr("stood at")));
    }
}

TEST(Route, ASteeredVehiclePassesByWhereItCannotTurn) {
    const Track track = route_of({{0, 0, 0}, {0, 500, 0}, {5, 490, 300}, {10, 500, 0}, {0, 1200, 0}});
    const auto route = fly_route(track, {VehicleClass::plane, {}, 1, 0});
    ASSERT_TRUE(route.has_value()) << route.error().message;
    EXPECT_THAT(route->notes, testing::Contains(HasSubstr("a plane cannot turn there")));
    test::expect_path_laws(*route->shape, 1e6, 30);
}

TEST(Route, SaysWhatIsNoRoute) {
    const auto refused = [](const Track& track, const RouteSettings& settings) {
        const auto route = fly_route(track, settings);
        return route ? "accepted" : route.error().message;
    };
    const Track two = route_of({{0, 0, 0}, {0, 100, 0}});
    EXPECT_THAT(refused(two, {VehicleClass::plane, 5, 2, 0}), HasSubstr("the slowest of a plane is 12"));
    EXPECT_THAT(refused(two, {VehicleClass::fixed, {}, 2, 0}), HasSubstr("vehicle = \"fixed\" does not go"));
    Track far = two;
    far.points[1].position = to_ecef(Geodetic::degrees(-47, 100, 0));
    EXPECT_THAT(refused(far, {}), HasSubstr("from the first one of the route; expected at most 1000"));
    EXPECT_THAT(refused(route_of({{0, 0, 0}, {0, 0, 50}}), {VehicleClass::car, {}, 2, 0}),
                HasSubstr("all places lie above one another"));
}

// Circles and stops of plans: a multirotor stands, a plane circles for as long.
TEST(Route, PlansCircleAndStop) {
    Track track = route_of({{0, 0, 50}, {0, 600, 50}, {600, 600, 50}});
    track.route->stops.resize(3);
    track.route->stops[1].hold = 60;
    track.route->stops[1].radius = 100;
    const auto hovering = fly_route(track, {VehicleClass::multirotor, {}, 2, 0});
    ASSERT_TRUE(hovering.has_value()) << hovering.error().message;
    EXPECT_EQ(hovering->waypoints.size(), 3u);
    double stood = 0;
    for (double t = 1; t < hovering->shape->duration() - 1; t += 0.05)
        if (hovering->shape->at(t).velocity.norm() < 1e-9) stood += 0.05;
    EXPECT_NEAR(stood, 60, 0.5);
    const auto circling = fly_route(track, {VehicleClass::plane, {}, 2, 0});
    ASSERT_TRUE(circling.has_value()) << circling.error().message;
    test::expect_path_laws(*circling->shape, 1e6, 30);
    // 60 s at 20 m/s are two rounds of 628 m; on the second the distance from the centre is that of the circle.
    double nearest = 1e9, farthest = 0;
    for (double t = 55; t < 75; t += 0.1) {
        const double distance = (circling->shape->at(t).position - Eigen::Vector3d(0, 600, 50)).head<2>().norm();
        nearest = std::min(nearest, distance), farthest = std::max(farthest, distance);
    }
    EXPECT_GT(nearest, 97);
    EXPECT_LT(farthest, 103);
    track.points.resize(20, track.points[1]);
    track.route->stops.assign(20, {{}, 0, 1000, 100});
    const auto dizzy = fly_route(track, {});
    ASSERT_FALSE(dizzy.has_value());
    EXPECT_THAT(dizzy.error().message, HasSubstr("circles of more than 100000 corners"));
}

}  // namespace
}  // namespace skyloop
