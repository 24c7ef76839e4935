#include "world/propagation/ray_traced_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/geo/local_frame.hpp"
#include "modern_sky.hpp"
#include "world/propagation/diffraction.hpp"

namespace skyloop::test {
namespace {

const SatelliteId g01{Constellation::gps, 1};
const double to_degrees = Angle::radians(1).deg();

/// Metal walls 400 m wide across the meridian, by metres north of the antenna and height over it; they reach 5 m down.
struct Wall {
    double north, height;
};

CityModel walls(std::initializer_list<Wall> all) {
    CityModel city;
    city.origin = odessa_place;
    const std::uint8_t metal = city.material_index("metal");
    for (const auto& [north, height] : all)
        city.add_quad({Eigen::Vector3d(-200, north, -5), {200, north, -5}, {200, north, height}, {-200, north, height}},
                      SurfaceKind::wall, metal);
    return city;
}

void add_ground(CityModel& city, double up) {
    city.add_quad({Eigen::Vector3d(-300, -300, up), {300, -300, up}, {300, 300, up}, {-300, 300, up}},
                  SurfaceKind::ground, city.material_index("metal"));
}

/// Mirrors that nothing weakens but the rejection of 10 dB, and an antenna that hears alike from everywhere.
RayTracedSceneSettings plain_settings(SceneProfile profile) {
    RayTracedSceneSettings settings;
    settings.profile = profile;
    settings.antenna = AntennaPattern(Decibels(0), Decibels(0), 1);
    settings.wall_roughness = Metres(0);
    settings.diffraction = false;
    settings.scattering.coefficient = 0;
    settings.search.rays = 8192;
    settings.search.ground_reflects = profile == SceneProfile::modern;
    return settings;
}

struct Outcome {
    Arrival arrival;
    std::optional<std::string> notice;
};

Outcome outcome(const CityModel& city, const RayTracedSceneSettings& settings, double azimuth_deg,
                double elevation_deg) {
    auto scene = UrbanScene::build(city);
    EXPECT_TRUE(scene);
    RayTracedScene effect(*scene, settings);
    SkyView sky;
    sky.satellites.push_back(satellite_at(g01, azimuth_deg, elevation_deg));
    const TruthState truth = truth_of(odessa_place, april_noon);
    return {after(effect, sky, truth).satellites.front(), effect.notice()};
}

Arrival by_article(const CityModel& city, double azimuth_deg, double elevation_deg) {
    return outcome(city, plain_settings(SceneProfile::baseline), azimuth_deg, elevation_deg).arrival;
}

Arrival by_rays(const CityModel& city, double azimuth_deg, double elevation_deg) {
    return outcome(city, plain_settings(SceneProfile::modern), azimuth_deg, elevation_deg).arrival;
}

TEST(ArticleScene, WhatIsInSightHasNoMultipath) {
    const Arrival a = by_article(walls({{20, 60}}), 180, 30);
    EXPECT_TRUE(a.line_of_sight);
    EXPECT_EQ(a.paths, 1);
    EXPECT_EQ(a.reflections, 0);
    EXPECT_EQ(a.excess_path.value(), 0);
    EXPECT_EQ(a.reflection_loss.value(), 0);
    EXPECT_TRUE(a.echoes.empty());
    EXPECT_FALSE(a.echoes_known);
}

TEST(ArticleScene, WhatHasNoPathIsHidden) {
    const Arrival a = by_article(walls({{20, 60}}), 0, 30);
    EXPECT_FALSE(a.line_of_sight);
    EXPECT_EQ(a.paths, 0);
    EXPECT_FALSE(a.cn0);
}

TEST(ArticleScene, FewestReflectionsHalveThePower) {
    const Arrival a = by_article(walls({{20, 15}, {-10, 60}}), 0, 30);
    EXPECT_FALSE(a.line_of_sight);
    EXPECT_EQ(a.paths, 1);
    EXPECT_EQ(a.reflections, 1);
    EXPECT_NEAR(a.excess_path.value(), 2 * 10 * std::cos(Angle::degrees(30).rad()), 1e-4);
    EXPECT_NEAR(a.reflection_loss.value(), 10 * std::log10(2.0), 1e-12);
    const Arrival twice = by_article(walls({{20, 32}, {-10, 60}}), 0, 30);
    EXPECT_EQ(twice.reflections, 2);
    EXPECT_NEAR(twice.excess_path.value(), 60 * std::cos(Angle::degrees(30).rad()), 1e-4);
    EXPECT_NEAR(twice.reflection_loss.value(), 20 * std::log10(2.0), 1e-12);
}

TEST(ModernScene, AnEchoComesFromTheMirroredSatellite) {
    const Arrival a = by_rays(walls({{20, 60}}), 180, 30);
    EXPECT_TRUE(a.line_of_sight);
    EXPECT_TRUE(a.echoes_known);
    EXPECT_EQ(a.paths, 2);
    EXPECT_EQ(a.excess_path.value(), 0);
    EXPECT_EQ(a.reflection_loss.value(), 0);
    ASSERT_EQ(a.echoes.size(), 1U);
    const Echo& echo = a.echoes.front();
    EXPECT_NEAR(std::remainder(echo.from.azimuth.deg(), 360), 0, 1e-4);
    EXPECT_NEAR(echo.from.elevation.deg(), 30, 1e-4);
    EXPECT_NEAR(echo.excess.value(), 2 * 20 * std::cos(Angle::degrees(30).rad()), 1e-4);
    EXPECT_NEAR(echo.amplitude, std::sqrt(0.1), 0.01) << "the other hand, 10 dB weaker";
    EXPECT_EQ(echo.reflections, 1);
}

TEST(ModernScene, TheGroundEchoesFromBelow) {
    CityModel city;
    city.origin = odessa_place;
    add_ground(city, -2);
    RayTracedSceneSettings settings = plain_settings(SceneProfile::modern);
    const Arrival level = outcome(city, settings, 90, 30).arrival;
    ASSERT_EQ(level.echoes.size(), 1U);
    EXPECT_NEAR(level.echoes[0].from.elevation.deg(), -30, 1e-4);
    EXPECT_NEAR(level.echoes[0].excess.value(), 2 * 2 * 0.5, 1e-4);
    settings.antenna = AntennaPattern();
    const Arrival patch = outcome(city, settings, 90, 30).arrival;
    ASSERT_EQ(patch.echoes.size(), 1U);
    const double gain = AntennaPattern().gain({{}, Angle::degrees(-30)}).value() -
                        AntennaPattern().gain({{}, Angle::degrees(30)}).value();
    EXPECT_NEAR(patch.echoes[0].amplitude / level.echoes[0].amplitude, std::pow(10, gain / 20), 1e-6);
    EXPECT_LT(gain, -15);
    EXPECT_TRUE(by_article(city, 90, 30).echoes.empty());
}

TEST(ModernScene, WithoutSightTheStrongestRayIsTracked) {
    const Arrival a = by_rays(walls({{20, 15}, {-10, 20}}), 0, 30);
    EXPECT_FALSE(a.line_of_sight);
    EXPECT_EQ(a.reflections, 1);
    EXPECT_NEAR(a.excess_path.value(), 2 * 10 * std::cos(Angle::degrees(30).rad()), 1e-4);
    EXPECT_NEAR(a.reflection_loss.value(), 10, 0.2);
    EXPECT_NE(a.excess_rate.value(), 0);
    EXPECT_TRUE(a.echoes.empty());
    // Where the walls let it, two mirrors turn the hand back: the longer ray is the stronger one.
    const Arrival twice = by_rays(walls({{20, 15}, {-10, 60}}), 0, 30);
    EXPECT_EQ(twice.reflections, 2);
    EXPECT_NEAR(twice.reflection_loss.value(), 0, 0.1);
    ASSERT_FALSE(twice.echoes.empty());
    EXPECT_EQ(twice.echoes[0].reflections, 1);
    EXPECT_NEAR(twice.echoes[0].excess.value(), -40 * std::cos(Angle::degrees(30).rad()), 1e-4);
    EXPECT_NEAR(twice.echoes[0].amplitude, std::sqrt(0.1), 0.01);
}

TEST(ModernScene, ARayBendsOverTheRoof) {
    RayTracedSceneSettings settings = plain_settings(SceneProfile::modern);
    settings.diffraction = true;
    const Arrival a = outcome(walls({{20, 15}}), settings, 0, 30).arrival;
    EXPECT_FALSE(a.line_of_sight);
    EXPECT_EQ(a.paths, 1);
    EXPECT_EQ(a.reflections, 0);
    const double detour = std::atan2(15, 20) - Angle::degrees(30).rad();
    EXPECT_NEAR(a.excess_path.value(), 25 * (1 - std::cos(detour)), 1e-3);
    EXPECT_NEAR(
        a.reflection_loss.value(),
        knife_edge_loss(knife_edge_parameter(Angle::radians(detour), Metres(25), Hertz(carrier_frequency_l1))).value(),
        0.01);
    EXPECT_EQ(outcome(walls({{20, 200}}), settings, 0, 5).arrival.paths, 0) << "deep in the shadow nothing arrives";
}

TEST(ModernScene, StrengthDoesNotJumpAtTheShadow) {
    RayTracedSceneSettings settings = plain_settings(SceneProfile::modern);
    settings.diffraction = true;
    const double edge = std::atan2(15, 20) * to_degrees;
    const Arrival lit = outcome(walls({{20, 15}}), settings, 0, edge + 0.02).arrival;
    const Arrival dark = outcome(walls({{20, 15}}), settings, 0, edge - 0.02).arrival;
    EXPECT_TRUE(lit.line_of_sight);
    EXPECT_FALSE(dark.line_of_sight);
    EXPECT_NEAR(lit.reflection_loss.value(), 6, 0.1);
    EXPECT_NEAR(dark.reflection_loss.value(), 6, 0.1);
    EXPECT_EQ(outcome(walls({{20, 15}}), settings, 0, edge + 6).arrival.reflection_loss.value(), 0);
}

// An edge 1.1 m away weakens the wave up to 13° beside it.
TEST(ModernScene, ANearEdgeWeakensTheDirectRayUntilItPassesClear) {
    RayTracedSceneSettings settings = plain_settings(SceneProfile::modern);
    settings.diffraction = true;
    const double edge = std::atan2(1, 0.5) * to_degrees;
    for (const double beside : {1.0, 5.0, 7.9, 8.1, 10.0, 12.0, 12.9, 14.0, 20.0}) {
        const Arrival a = outcome(walls({{0.5, 1}}), settings, 0, edge + beside).arrival;
        EXPECT_TRUE(a.line_of_sight);
        const double v =
            knife_edge_parameter(Angle::degrees(-beside), Metres(std::hypot(1, 0.5)), Hertz(carrier_frequency_l1));
        EXPECT_NEAR(a.reflection_loss.value(), knife_edge_loss(v).value(), 0.02) << beside;
    }
}

TEST(ModernScene, TreesWeakenTheDirectRay) {
    CityModel city = walls({{-150, 1}});
    city.foliage.push_back({{{-50, 10}, {50, 10}, {50, 20}, {-50, 20}}, -5, 60});
    const Arrival through = by_rays(city, 0, 30), past = by_rays(city, 180, 30);
    EXPECT_NEAR(through.foliage_loss.value(), 0.8 * 10 / std::cos(Angle::degrees(30).rad()), 1e-3);
    EXPECT_EQ(past.foliage_loss.value(), 0);
    RayTracedSceneSettings settings = plain_settings(SceneProfile::modern);
    settings.crowns = {0.1, Decibels(12), 2};
    EXPECT_NEAR(outcome(city, settings, 0, 30).arrival.foliage_loss.value(),
                2 * 0.1 * 10 / std::cos(Angle::degrees(30).rad()), 1e-3);
    settings.crowns.factor = 0;
    EXPECT_EQ(outcome(city, settings, 0, 30).arrival.foliage_loss.value(), 0);
}

TEST(ModernScene, NoWoodIsDarkerThanTheLimit) {
    CityModel city = walls({{-150, 1}});
    city.foliage.push_back({{{-900, -900}, {900, -900}, {900, 900}, {-900, 900}}, -5, 60});
    RayTracedSceneSettings settings = plain_settings(SceneProfile::modern);
    EXPECT_NEAR(outcome(city, settings, 0, 5).arrival.foliage_loss.value(), 12, 1e-12);
    settings.crowns = {0.8, Decibels(5), 0.5};
    EXPECT_NEAR(outcome(city, settings, 0, 5).arrival.foliage_loss.value(), 2.5, 1e-12);
}

TEST(ModernScene, TheLimitIsOneForCrownsAllAroundAndThoseOfTheScene) {
    CityModel city = walls({{-150, 1}});
    city.foliage.push_back({{{-900, 10}, {900, 10}, {900, 900}, {-900, 900}}, -5, 60});
    auto scene = UrbanScene::build(city);
    ASSERT_TRUE(scene);
    RayTracedScene effect(*scene, plain_settings(SceneProfile::modern));
    SkyView sky;
    sky.satellites.push_back(satellite_at(g01, 0, 20));
    Arrivals arrivals;
    arrivals.satellites.resize(1);
    arrivals.satellites[0].foliage_loss = Decibels(9);
    effect.apply(arrivals, sky, truth_of(odessa_place, april_noon));
    EXPECT_NEAR(arrivals.satellites[0].foliage_loss.value(), 12, 1e-12);
}

/// Crowns 100 m wide across the meridian, between metres north of the antenna and metres above it.
FoliageVolume grove(double south, double north, double base = -5, double top = 60) {
    return {{{-50, south}, {50, south}, {50, north}, {-50, north}}, base, top};
}

double decibels_of(double amplitude) { return 20 * std::log10(amplitude); }

TEST(ModernScene, AnEchoPassesTheTreesBeforeItsWallTwice) {
    CityModel city = walls({{30, 60}});
    const double open = by_rays(city, 180, 30).echoes.at(0).amplitude;
    city.foliage.push_back(grove(10, 20));
    RayTracedSceneSettings settings = plain_settings(SceneProfile::modern);
    settings.crowns = {0.1, Decibels(12), 1};
    const Arrival thin = outcome(city, settings, 180, 30).arrival;
    EXPECT_EQ(thin.foliage_loss.value(), 0) << "the direct ray comes from the other side";
    ASSERT_EQ(thin.echoes.size(), 1U);
    EXPECT_NEAR(decibels_of(thin.echoes[0].amplitude / open), -0.1 * 2 * 10 / std::cos(Angle::degrees(30).rad()), 1e-3);
    const Arrival thick = by_rays(city, 180, 30);
    ASSERT_EQ(thick.echoes.size(), 1U);
    EXPECT_NEAR(decibels_of(thick.echoes[0].amplitude / open), -12, 1e-6);
}

TEST(ModernScene, AWoodAllAroundWeakensDirectRayAndEchoAlike) {
    CityModel city = walls({{30, 60}});
    const double open = by_rays(city, 180, 30).echoes.at(0).amplitude;
    city.foliage.push_back({{{-900, -900}, {900, -900}, {900, 900}, {-900, 900}}, -5, 60});
    const Arrival a = by_rays(city, 180, 30);
    EXPECT_NEAR(a.foliage_loss.value(), 12, 1e-12);
    ASSERT_EQ(a.echoes.size(), 1U);
    EXPECT_NEAR(a.echoes[0].amplitude, open, 1e-6);
}

TEST(ModernScene, TreesWeakenAReflectedRayThatIsTracked) {
    CityModel city = walls({{20, 15}, {-10, 20}});
    const double open = by_rays(city, 0, 30).reflection_loss.value();
    city.foliage.push_back(grove(-6, -3));
    const Arrival a = by_rays(city, 0, 30);
    EXPECT_EQ(a.reflections, 1);
    EXPECT_NEAR(a.reflection_loss.value() - open, 0.8 * 2 * 3 / std::cos(Angle::degrees(30).rad()), 1e-3);
}

TEST(ModernScene, CrownsBehindAnEdgeCountWhereTheBentRayGoes) {
    RayTracedSceneSettings settings = plain_settings(SceneProfile::modern);
    settings.diffraction = true;
    settings.crowns = {0.1, Decibels(12), 1};
    // The ray rises to the edge as steeply as 15 m in 20, and behind it as the line to the satellite does: 100 m
    // further north it is 73 m up, and straight on it would be 90 m.
    CityModel city = walls({{20, 15}});
    const double open = outcome(city, settings, 0, 30).arrival.reflection_loss.value();
    CityModel on_the_way = city, straight_on = city;
    on_the_way.foliage.push_back(grove(120, 140, 60, 88));
    straight_on.foliage.push_back(grove(120, 140, 89, 200));
    EXPECT_NEAR(outcome(on_the_way, settings, 0, 30).arrival.reflection_loss.value() - open,
                0.1 * 20 / std::cos(Angle::degrees(30).rad()), 1e-3);
    EXPECT_NEAR(outcome(straight_on, settings, 0, 30).arrival.reflection_loss.value(), open, 1e-9);
}

/// A house around the antenna.
CityModel closed_room() {
    CityModel city = walls({{8, 10}, {-8, 10}});
    for (const double east : {-9.0, 9.0})
        city.add_quad({Eigen::Vector3d(east, -9, -5), {east, 9, -5}, {east, 9, 10}, {east, -9, 10}}, SurfaceKind::wall);
    city.add_quad({Eigen::Vector3d(-9, -9, 10), {9, -9, 10}, {9, 9, 10}, {-9, 9, 10}}, SurfaceKind::roof);
    return city;
}

TEST(RayTracedScene, SaysWhenTheAntennaIsInsideOrBelow) {
    for (const SceneProfile profile : {SceneProfile::baseline, SceneProfile::modern}) {
        const Outcome inside = outcome(closed_room(), plain_settings(profile), 90, 40);
        ASSERT_TRUE(inside.notice);
        EXPECT_NE(inside.notice->find("inside a building"), std::string::npos) << *inside.notice;
        EXPECT_NE(inside.notice->find("10.0 m"), std::string::npos) << *inside.notice;
        EXPECT_EQ(inside.arrival.paths, 0);
        EXPECT_FALSE(inside.arrival.cn0);
        CityModel meadow;
        meadow.origin = odessa_place;
        add_ground(meadow, 3);
        const Outcome below = outcome(meadow, plain_settings(profile), 90, 40);
        EXPECT_EQ(below.arrival.paths, 0);
    }
    EXPECT_FALSE(outcome(walls({{20, 60}}), plain_settings(SceneProfile::modern), 0, 30).notice)
        << "hidden, but under the sky";
}

TEST(RayTracedScene, AYardThatIsOpenAboveIsNoRoom) {
    CityModel yard = walls({{2.5, 30}, {-2.5, 30}});
    for (const double east : {-2.5, 2.5})
        yard.add_quad({Eigen::Vector3d(east, -2.5, -5), {east, 2.5, -5}, {east, 2.5, 30}, {east, -2.5, 30}},
                      SurfaceKind::wall);
    // South, north and south wall 4, 13 and 22 m up; then out over the north one.
    for (const SceneProfile profile : {SceneProfile::baseline, SceneProfile::modern}) {
        const Outcome in_yard = outcome(yard, plain_settings(profile), 0, 60);
        EXPECT_FALSE(in_yard.notice);
        EXPECT_FALSE(in_yard.arrival.line_of_sight);
        EXPECT_EQ(in_yard.arrival.paths, 1);
        EXPECT_EQ(in_yard.arrival.reflections, 3);
    }
}

TEST(RayTracedScene, BelowTheGroundIsNoCellar) {
    CityModel meadow;
    meadow.origin = odessa_place;
    // Wide enough for the flattest ray of the look around.
    meadow.add_quad({Eigen::Vector3d(-2e4, -2e4, 3), {2e4, -2e4, 3}, {2e4, 2e4, 3}, {-2e4, 2e4, 3}},
                    SurfaceKind::ground);
    const Outcome below = outcome(meadow, plain_settings(SceneProfile::modern), 90, 40);
    ASSERT_TRUE(below.notice);
    EXPECT_NE(below.notice->find("3.0 m below the ground"), std::string::npos) << *below.notice;
}

TEST(RayTracedScene, AnAntennaOnTheGroundIsUnderTheSky) {
    for (const double ground : {-0.001, 0.0, 0.04}) {
        CityModel meadow;
        meadow.origin = odessa_place;
        meadow.add_quad(
            {Eigen::Vector3d(-2e4, -2e4, ground), {2e4, -2e4, ground}, {2e4, 2e4, ground}, {-2e4, 2e4, ground}},
            SurfaceKind::ground);
        for (const double elevation : {5.0, 40.0, 89.0}) {
            const Outcome on = outcome(meadow, plain_settings(SceneProfile::modern), 90, elevation);
            EXPECT_FALSE(on.notice) << ground;
            EXPECT_TRUE(on.arrival.line_of_sight) << ground << ' ' << elevation;
        }
    }
}

// ---- The edges themselves.

TEST(SceneEdges, LieWhereTheWallEnds) {
    CityModel city;
    city.origin = odessa_place;
    city.add_quad({Eigen::Vector3d(-5, 20, -5), {3, 20, -5}, {3, 20, 40}, {-5, 20, 40}}, SurfaceKind::wall);
    const auto scene = UrbanScene::build(city);
    ASSERT_TRUE(scene);
    const std::vector<SceneEdge> edges = edges_around_obstacle(**scene, {{0, 0, 0}, {0, 1, 0}});
    ASSERT_EQ(edges.size(), 2U) << "the top is more than 45° up";
    EXPECT_NEAR(edges[0].detour.rad(), std::atan2(3, 20), 1e-4);
    EXPECT_NEAR(edges[0].distance.value(), std::hypot(3, 20), 1e-2);
    EXPECT_NEAR(edges[1].detour.rad(), std::atan2(5, 20), 1e-4);
    EXPECT_GT(edges[0].direction.x(), 0);
    EXPECT_LT(edges[1].direction.x(), 0);
    const std::vector<SceneEdge> beside =
        edges_near_sight(**scene, {{0, 0, 0}, Eigen::Vector3d(4, 20, 0).normalized()}, Hertz(carrier_frequency_l1));
    ASSERT_EQ(beside.size(), 1U);
    EXPECT_NEAR(beside[0].detour.rad(), std::atan2(4, 20) - std::atan2(3, 20), 1e-4);
}

// The top of a wall to which the line to the satellite is oblique.
TEST(SceneEdges, BendWhereTheWayOverAnObliqueEdgeIsShortest) {
    const auto wall_with_ends = [](double south, double north) {
        CityModel city;
        city.origin = odessa_place;
        city.add_quad({Eigen::Vector3d(20, south, -5), {20, north, -5}, {20, north, 28.5}, {20, south, 28.5}},
                      SurfaceKind::wall);
        return city;
    };
    const double azimuth = 0.5, elevation = 0.5;
    const SceneRay line{
        {0, 0, 0},
        {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth), std::sin(elevation)}};
    const double slant = line.direction.y();
    const double shortest = std::hypot(20, 28.5) * slant / std::sqrt(1 - slant * slant);
    struct Case {
        double south, north, bend, within;
    };
    for (const Case& c : {Case{-3000, 3000, shortest, 1e-6}, Case{-3000, shortest - 4, shortest - 4, 0.15}}) {
        const auto scene = UrbanScene::build(wall_with_ends(c.south, c.north));
        ASSERT_TRUE(scene);
        const std::vector<SceneEdge> edges = edges_around_obstacle(**scene, line);
        ASSERT_FALSE(edges.empty());
        const Eigen::Vector3d place = edges[0].distance.value() * edges[0].direction;
        EXPECT_LT((place - Eigen::Vector3d(20, c.bend, 28.5)).norm(), c.within) << place.transpose();
        EXPECT_NEAR(edges[0].detour.rad(), std::acos(edges[0].direction.dot(line.direction)), 1e-9);
        for (std::size_t i = 1; i < edges.size(); ++i)
            EXPECT_GT((edges[i].distance.value() * edges[i].direction - place).norm(), 1) << "an edge counts once";
    }
}

TEST(SceneEdges, AnObliqueEdgeBesideTheLineCountsOnce) {
    CityModel city;
    city.origin = odessa_place;
    city.add_quad({Eigen::Vector3d(20, -3000, -5), {20, 3000, -5}, {20, 3000, 28.5}, {20, -3000, 28.5}},
                  SurfaceKind::wall);
    const auto scene = UrbanScene::build(city);
    ASSERT_TRUE(scene);
    const double azimuth = 0.5, elevation = 0.65;  // the wall ends 0.6 up there
    const SceneRay line{
        {0, 0, 0},
        {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth), std::sin(elevation)}};
    const std::vector<SceneEdge> edges = edges_near_sight(**scene, line, Hertz(carrier_frequency_l1));
    ASSERT_EQ(edges.size(), 1U);
    const double slant = line.direction.y();
    const Eigen::Vector3d bend(20, std::hypot(20, 28.5) * slant / std::sqrt(1 - slant * slant), 28.5);
    EXPECT_LT((edges[0].distance.value() * edges[0].direction - bend).norm(), 1e-6);
}

TEST(SceneEdges, NoRayBendsTwice) {
    CityModel city = walls({{20, 15}, {60, 40}});
    const auto scene = UrbanScene::build(city);
    ASSERT_TRUE(scene);
    // Over the near wall the far one still stands in the way of a low satellite.
    const auto low = edges_around_obstacle(**scene, {{0, 0, 0}, {0, std::cos(0.2), std::sin(0.2)}});
    EXPECT_TRUE(low.empty());
}

}  // namespace
}  // namespace skyloop::test
