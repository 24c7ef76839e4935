#include "support/exhaustive_paths.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "support/random_sky.hpp"
#include "world/scene/generated_city.hpp"

namespace skyloop::test {
namespace {

const Eigen::Vector3d exhaustive_antenna(0, 0, 2);

// An upright wall from −1 to 1 km along `along`, through `middle`, 100 m high.
void add_long_wall(CityModel& city, const Eigen::Vector3d& middle, const Eigen::Vector3d& along) {
    const Eigen::Vector3d a = middle - 1000 * along, b = middle + 1000 * along, up(0, 0, 100);
    city.add_quad({a, b, b + up, a + up}, SurfaceKind::wall);
}

SceneSatellite satellite_towards(const Eigen::Vector3d& direction) {
    SceneSatellite satellite;
    satellite.position = exhaustive_antenna + 2.2e7 * direction.normalized();
    return satellite;
}

std::vector<ScenePath> all_paths(const CityModel& city, const SceneSatellite& satellite, int most,
                                 bool ground_reflects = false) {
    const auto scene = UrbanScene::build(city);
    EXPECT_TRUE(scene);
    PathSearchSettings settings;
    settings.blocked_only = false;
    settings.most_reflections = most;
    settings.ground_reflects = ground_reflects;
    SceneObserver observer;
    observer.position = exhaustive_antenna;
    return exhaustive_paths(**scene, observer, std::span(&satellite, 1), settings).at(0).paths;
}

// The excess of a plane wave; a sphere of 22,000 km differs by the distance's square over twice that.
void expect_excess(const ScenePath& path, double plane_wave) { EXPECT_NEAR(path.excess, plane_wave, 1e-4); }

TEST(ExhaustivePaths, OneWallGivesOnePathOfTwiceItsDistance) {
    CityModel city;
    add_long_wall(city, {12, 0, 0}, {0, 1, 0});
    const Eigen::Vector3d u = Eigen::Vector3d(-0.6, 0.3, 0.5).normalized();
    const auto paths = all_paths(city, satellite_towards(u), 3);
    ASSERT_EQ(paths.size(), 1U);
    EXPECT_EQ(paths[0].reflections(), 1);
    expect_excess(paths[0], 2 * 12 * -u.x());
    EXPECT_LT((paths[0].arrival - Eigen::Vector3d(-u.x(), u.y(), u.z())).norm(), 1e-5);
    // From behind the wall there is nothing to reflect.
    EXPECT_TRUE(all_paths(city, satellite_towards({0.6, 0.3, 0.9}), 3).empty());
}

TEST(ExhaustivePaths, ARightAngleGivesThreePathsAndWithTheGroundSeven) {
    CityModel city;
    add_long_wall(city, {20, 0, 0}, {0, 1, 0});
    add_long_wall(city, {0, 30, 0}, {1, 0, 0});
    const Eigen::Vector3d u = Eigen::Vector3d(-0.5, -0.4, 0.3).normalized();
    const auto paths = all_paths(city, satellite_towards(u), 3);
    ASSERT_EQ(paths.size(), 3U);
    const double east = -2 * 20 * u.x(), north = -2 * 30 * u.y();
    expect_excess(paths[0], std::min(east, north));
    expect_excess(paths[1], std::max(east, north));
    EXPECT_EQ(paths[2].reflections(), 2);
    expect_excess(paths[2], east + north);

    city.add_quad({{{-3000, -3000, 0}, {3000, -3000, 0}, {3000, 3000, 0}, {-3000, 3000, 0}}}, SurfaceKind::ground);
    const auto grounded = all_paths(city, satellite_towards(u), 3, true);
    ASSERT_EQ(grounded.size(), 7U);
    EXPECT_EQ(grounded[6].reflections(), 3);
    expect_excess(grounded[6], east + north + 2 * 2 * u.z());
    EXPECT_EQ(all_paths(city, satellite_towards(u), 2, true).size(), 6U);
}

TEST(ExhaustivePaths, ParallelWallsReflectThreeTimes) {
    // Walls at −10 and 10 m; the images of the antenna at 0 lie at ±20, ±40, ±60.
    CityModel city;
    add_long_wall(city, {10, 0, 0}, {0, 1, 0});
    add_long_wall(city, {-10, 0, 0}, {0, 1, 0});
    // It meets them after 10, 30 and 50 m, at 87 m the third time, and 70 m after the antenna is over the wall.
    const Eigen::Vector3d u = Eigen::Vector3d(-1, 0, 1.7).normalized();
    const auto paths = all_paths(city, satellite_towards(u), 3);
    ASSERT_EQ(paths.size(), 1U);
    EXPECT_EQ(paths[0].reflections(), 3);
    expect_excess(paths[0], 60 * -u.x());
    EXPECT_TRUE(all_paths(city, satellite_towards(u), 2).empty());
}

TEST(ExhaustivePaths, TheRateIsTheExcessesDerivative) {
    GeneratedCitySettings small;
    small.triangles = 600;
    const GeneratedCity made = generated_city(small, Geodetic{});
    const auto scene = UrbanScene::build(made.city);
    ASSERT_TRUE(scene);
    PathSearchSettings settings;
    settings.most_reflections = 2;
    SceneObserver observer;
    observer.velocity = {7, -4, 0.5};
    int compared = 0;
    for (std::size_t place = 0; place < 10; ++place) {
        auto sky = random_sky(12, made.street_places[place], place);
        for (SceneSatellite& satellite : sky)
            satellite.velocity = {1500, 2000, -1800};
        const auto at = [&](double seconds) {
            SceneObserver moved = observer;
            moved.position = made.street_places[place] + seconds * observer.velocity;
            auto later = sky;
            for (SceneSatellite& satellite : later)
                satellite.position += seconds * satellite.velocity;
            return exhaustive_paths(**scene, moved, later, settings);
        };
        const auto before = at(-0.005), now = at(0), after = at(0.005);
        for (std::size_t s = 0; s < now.size(); ++s) {
            if (before[s].paths.size() != now[s].paths.size() || after[s].paths.size() != now[s].paths.size()) continue;
            for (std::size_t i = 0; i < now[s].paths.size(); ++i, ++compared)
                EXPECT_NEAR(now[s].paths[i].excess_rate, (after[s].paths[i].excess - before[s].paths[i].excess) / 0.01,
                            1e-4);
        }
    }
    EXPECT_GE(compared, 5);
}

}  // namespace
}  // namespace skyloop::test
