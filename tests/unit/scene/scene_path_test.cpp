#include "world/scene/scene_path.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "closed_scenes.hpp"

namespace skyloop::test {
namespace {

constexpr std::array two_walls{0U, 1U};

// Walls at x = 30 and y = 40.
CityModel corner_city() {
    CityModel city = empty_scene_city();
    add_wall(city, {30, -300}, {30, 40}, 0, 300);
    add_wall(city, {-300, 40}, {30, 40}, 0, 300);
    return city;
}

// Which plane stands at right angles to an axis.
std::uint32_t plane_along(const UrbanScene& scene, int axis) {
    for (std::uint32_t i = 0; i < scene.planes().size(); ++i)
        if (std::abs(scene.planes()[i].normal[axis]) > 0.9) return i;
    ADD_FAILURE() << "no plane";
    return 0;
}

ScenePath corner_path(const UrbanScene& scene, const Eigen::Vector3d& antenna, const Eigen::Vector3d& satellite) {
    ScenePath path;
    path.planes.push_back(plane_along(scene, 0));
    path.planes.push_back(plane_along(scene, 1));
    const UnfoldedPath unfolded = unfold(scene, {path.planes.begin(), path.planes.size()}, antenna, satellite);
    path.arrival = unfolded.arrival;
    path.excess = unfolded.excess;
    return path;
}

TEST(Unfold, WithoutPlanesIsTheStraightLine) {
    const auto scene = built_scene(corner_city());
    const Eigen::Vector3d antenna(1, 2, 3);
    const Eigen::Vector3d satellite = antenna + gps_distance * heading(30, 100);
    const UnfoldedPath path = unfold(*scene, {}, antenna, satellite);
    EXPECT_EQ(path.excess, 0);
    EXPECT_LT((path.arrival - heading(30, 100)).norm(), 1e-15);
    EXPECT_EQ(path.arrival, path.departure);
}

TEST(Unfold, GivesTheLengthOverTheReflectionPointsOfTheSphericalWave) {
    const auto scene = built_scene(corner_city());
    const Eigen::Vector3d antenna(0, 0, 1.5);
    // Near enough that lengths can be subtracted without loss.
    const Eigen::Vector3d satellite = antenna + 1000 * heading(30, -145);
    const ScenePath path = corner_path(*scene, antenna, satellite);
    const std::vector<Eigen::Vector3d> points = reflection_points(*scene, path, antenna);
    ASSERT_EQ(points.size(), 2U);
    EXPECT_NEAR(points[0].x(), 30, 1e-12);
    EXPECT_NEAR(points[1].y(), 40, 1e-12);
    const double length =
        (points[0] - antenna).norm() + (points[1] - points[0]).norm() + (satellite - points[1]).norm();
    EXPECT_NEAR(path.excess, length - (satellite - antenna).norm(), 1e-10);
    EXPECT_LT((path.arrival - (points[0] - antenna).normalized()).norm(), 1e-13);
}

TEST(Unfold, DependsOnTheOrderOfPlanesThatAreNotAtRightAngles) {
    CityModel city = empty_scene_city();
    add_wall(city, {30, -30}, {30, 30}, 0, 30);
    add_wall(city, {-30, 20}, {0, 40}, 0, 30);
    const auto scene = built_scene(city);
    ASSERT_EQ(scene->planes().size(), 2U);
    const Eigen::Vector3d satellite = gps_distance * heading(30, -145);
    constexpr std::array turned{1U, 0U};
    const UnfoldedPath one = unfold(*scene, two_walls, Eigen::Vector3d::Zero(), satellite);
    const UnfoldedPath other = unfold(*scene, turned, Eigen::Vector3d::Zero(), satellite);
    EXPECT_GT(std::abs(one.excess - other.excess), 1);
}

TEST(Unfold, LosesNothingAtTheDistanceOfASatellite) {
    const auto scene = built_scene(corner_city());
    const Eigen::Vector3d antenna(0, 0, 1.5);
    const Eigen::Vector3d direction = heading(25, 160);
    const std::array wall{plane_along(*scene, 0)};
    // |S − P'| − |S − P| in extended precision.
    const Eigen::Vector3d satellite = antenna + gps_distance * direction;
    const auto length = [&satellite](const Eigen::Vector3d& from) {
        const Eigen::Matrix<long double, 3, 1> way = (satellite.cast<long double>() - from.cast<long double>());
        return std::sqrt(way.squaredNorm());
    };
    const Eigen::Vector3d image(60, 0, 1.5);
    EXPECT_NEAR(unfold(*scene, wall, antenna, satellite).excess, static_cast<double>(length(image) - length(antenna)),
                1e-10);
}

}  // namespace
}  // namespace skyloop::test
