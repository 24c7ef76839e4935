// What an engine's rays have found becomes what arrives.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "world/propagation/told_obstacles.hpp"

namespace {

using namespace skyloop;

constexpr SatelliteId told_satellite{Constellation::gps, 7};

Arrival arrival_under(const ToldPath& path, SatelliteId id = told_satellite) {
    auto told = std::make_shared<ToldPaths>();
    (*told)[told_satellite] = path;
    Arrivals arrivals;
    arrivals.satellites.resize(1);
    arrivals.satellites[0].id = id;
    arrivals.satellites[0].cn0 = DbHz(45);
    arrivals.satellites[0].foliage_loss = Decibels(1);
    ToldObstacles(told).apply(arrivals, {}, {});
    return arrivals.satellites[0];
}

ToldPath with_reflections(bool blocked) {
    ToldPath path;
    path.blocked = blocked;
    path.reflections.push_back({Metres(80), Decibels(-12)});
    path.reflections.push_back({Metres(30), Decibels(-6)});
    return path;
}

TEST(ToldObstacles, LeaveOthersAsTheyAre) {
    const Arrival other = arrival_under(with_reflections(true), {Constellation::gps, 8});
    EXPECT_TRUE(other.line_of_sight);
    EXPECT_EQ(other.paths, 1);
    EXPECT_FALSE(other.echoes_known);
    EXPECT_TRUE(other.cn0);
}

TEST(ToldObstacles, WeakenTheDirectRay) {
    ToldPath path;
    path.attenuation = Decibels(9);
    const Arrival arrival = arrival_under(path);
    EXPECT_TRUE(arrival.line_of_sight);
    EXPECT_TRUE(arrival.echoes_known);
    EXPECT_DOUBLE_EQ(arrival.foliage_loss.value(), 10);
    EXPECT_DOUBLE_EQ(arrival.reflection_loss.value(), 0);
}

TEST(ToldObstacles, AddEchoesToTheDirectRayStrongestFirst) {
    ToldPath path = with_reflections(false);
    path.attenuation = Decibels(4);
    const Arrival arrival = arrival_under(path);
    EXPECT_TRUE(arrival.line_of_sight);
    EXPECT_EQ(arrival.paths, 3);
    EXPECT_EQ(arrival.reflections, 0);
    ASSERT_EQ(arrival.echoes.size(), 2U);
    EXPECT_DOUBLE_EQ(arrival.echoes[0].excess.value(), 30);
    EXPECT_NEAR(arrival.echoes[0].amplitude, std::pow(10, (-6 + 4) / 20.0), 1e-12);
    EXPECT_NEAR(arrival.echoes[1].amplitude, std::pow(10, (-12 + 4) / 20.0), 1e-12);
    EXPECT_NEAR(arrival.echoes[0].phase.rad(), std::numbers::pi, 1e-12);
}

TEST(ToldObstacles, TrackTheStrongestReflectionOfABlockedSatellite) {
    const Arrival arrival = arrival_under(with_reflections(true));
    EXPECT_FALSE(arrival.line_of_sight);
    EXPECT_EQ(arrival.paths, 2);
    EXPECT_EQ(arrival.reflections, 1);
    EXPECT_DOUBLE_EQ(arrival.excess_path.value(), 30);
    EXPECT_DOUBLE_EQ(arrival.reflection_loss.value(), 6);
    ASSERT_EQ(arrival.echoes.size(), 1U);
    EXPECT_DOUBLE_EQ(arrival.echoes[0].excess.value(), 50);
    EXPECT_NEAR(arrival.echoes[0].amplitude, std::pow(10, -6 / 20.0), 1e-12);
    EXPECT_NEAR(arrival.echoes[0].phase.rad(), 0, 1e-12);
}

TEST(ToldObstacles, HideABlockedSatelliteWithoutReflections) {
    ToldPath path;
    path.blocked = true;
    const Arrival arrival = arrival_under(path);
    EXPECT_FALSE(arrival.line_of_sight);
    EXPECT_EQ(arrival.paths, 0);
    EXPECT_FALSE(arrival.cn0);
}

}  // namespace
