#include "world/scene/path_finder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "closed_scenes.hpp"
#include "support/oracle_table.hpp"

namespace skyloop::test {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

std::vector<int> reflection_counts(const SatellitePaths& paths) {
    std::vector<int> counts;
    for (const ScenePath& path : paths.paths)
        counts.push_back(path.reflections());
    return counts;
}

TEST(PathFinder, FindsTheOnePathOverAWall) {
    CityModel city = empty_scene_city();
    add_wall(city, {30, -500}, {30, 500}, 0, 200);
    const Eigen::Vector3d antenna(0, 0, 1.5);
    const Eigen::Vector3d direction = heading(40, 160);
    const auto found =
        paths_at(city, antenna, {satellite_at(7, antenna, direction, infinitely_far)}, search_of_everything());
    ASSERT_THAT(found, SizeIs(1));
    EXPECT_EQ(found[0].id, (SatelliteId{Constellation::gps, 7}));
    EXPECT_TRUE(found[0].line_of_sight);
    ASSERT_THAT(found[0].paths, SizeIs(1));
    EXPECT_NEAR(found[0].paths[0].excess, 2 * 30 * -direction.x(), 1e-6);
    const Eigen::Vector3d mirrored(-direction.x(), direction.y(), direction.z());
    EXPECT_LT((found[0].paths[0].arrival - mirrored).norm(), 1e-9);
}

TEST(PathFinder, AWallThatIsThereTwiceReflectsOnce) {
    for (std::uint8_t material = 0; material < 2; ++material) {
        CityModel city = empty_scene_city();
        city.materials = {"concrete", "glass"};
        add_wall(city, {30, -500}, {30, 500}, 0, 200);
        const std::size_t once = city.triangles.size();
        add_wall(city, {30, -500}, {30, 500}, 0, 200);
        for (std::size_t i = once; i < city.triangles.size(); ++i)
            city.triangles[i].material = material;
        const Eigen::Vector3d antenna(0, 0, 1.5), direction = heading(40, 160);
        const auto found =
            paths_at(city, antenna, {satellite_at(7, antenna, direction, infinitely_far)}, search_of_everything());
        ASSERT_THAT(found, SizeIs(1));
        EXPECT_TRUE(found[0].line_of_sight);
        ASSERT_THAT(found[0].paths, SizeIs(1)) << static_cast<int>(material);
        EXPECT_NEAR(found[0].paths[0].excess, 2 * 30 * -direction.x(), 1e-6);
    }
}

TEST(PathFinder, FollowsTheSphericalWaveOfASatellite) {
    CityModel city = empty_scene_city();
    add_wall(city, {300, -5000}, {300, 5000}, 0, 2000);
    const Eigen::Vector3d antenna(0, 0, 1.5);
    const Eigen::Vector3d direction = heading(40, 160);
    const auto satellite = satellite_at(7, antenna, direction, gps_distance);
    const auto found = paths_at(city, antenna, {satellite}, search_of_everything());
    ASSERT_THAT(found[0].paths, SizeIs(1));
    const Eigen::Vector3d image(600, 0, 1.5);
    EXPECT_NEAR(found[0].paths[0].excess, (satellite.position - image).norm() - gps_distance, 1e-6);
    // The plane wave is wrong by some millimetres.
    EXPECT_GT(std::abs(found[0].paths[0].excess - 600 * -direction.x()), 1e-3);
}

TEST(PathFinder, FindsNoReflectedPathOfASatelliteInSightUnlessAsked) {
    CityModel city = empty_scene_city();
    add_wall(city, {30, -500}, {30, 500}, 0, 200);
    PathSearchSettings settings = search_of_everything();
    settings.blocked_only = true;
    const auto satellite = satellite_at(7, Eigen::Vector3d::Zero(), heading(40, 160), gps_distance);
    const auto found = paths_at(city, {0, 0, 1.5}, {satellite}, settings);
    EXPECT_TRUE(found[0].line_of_sight);
    EXPECT_THAT(found[0].paths, IsEmpty());
}

TEST(PathFinder, FindsExactlyThreePathsInARightAngledCorner) {
    CityModel city = empty_scene_city();
    add_wall(city, {30, -300}, {30, 40}, 0, 300);
    add_wall(city, {-300, 40}, {30, 40}, 0, 300);
    const Eigen::Vector3d antenna(0, 0, 1.5);
    const Eigen::Vector3d direction = heading(30, -145);
    const auto found =
        paths_at(city, antenna, {satellite_at(1, antenna, direction, infinitely_far)}, search_of_everything());
    ASSERT_THAT(reflection_counts(found[0]), testing::ElementsAre(1, 1, 2));
    EXPECT_NEAR(found[0].paths[0].excess,
                60 * -direction.x() < 80 * -direction.y() ? 60 * -direction.x() : 80 * -direction.y(), 1e-6);
    EXPECT_NEAR(found[0].paths[2].excess, 60 * -direction.x() + 80 * -direction.y(), 1e-6);
}

TEST(PathFinder, CountsReflectionsBetweenParallelWallsUpToSixteen) {
    const Eigen::Vector3d antenna(7, 0, 1.5);
    const Eigen::Vector3d direction = heading(10, 17);
    for (const int reflections : {1, 2, 3, 5, 8, 12, 16}) {
        SCOPED_TRACE(reflections);
        const auto found = paths_at(canyon_for(reflections, 20, antenna, direction), antenna,
                                    {satellite_at(1, antenna, direction, infinitely_far)}, search_of_everything());
        ASSERT_THAT(reflection_counts(found[0]), testing::ElementsAre(reflections));
        EXPECT_NEAR(found[0].paths[0].excess, canyon_excess(reflections, 20, 7, direction.x()), 1e-6);
    }
}

TEST(PathFinder, SeesNothingOfASatelliteAfterSeventeenReflections) {
    const Eigen::Vector3d antenna(7, 0, 1.5);
    const Eigen::Vector3d direction = heading(10, 17);
    const std::vector satellites{satellite_at(1, antenna, direction, infinitely_far)};
    const auto found = paths_at(canyon_for(17, 20, antenna, direction), antenna, satellites, search_of_everything());
    EXPECT_FALSE(found[0].line_of_sight);
    EXPECT_THAT(found[0].paths, IsEmpty());
}

TEST(PathFinder, StopsAtTheNumberOfReflectionsThatWasSet) {
    const Eigen::Vector3d antenna(7, 0, 1.5);
    const Eigen::Vector3d direction = heading(10, 17);
    const std::vector satellites{satellite_at(1, antenna, direction, infinitely_far)};
    PathSearchSettings settings = search_of_everything();
    settings.most_reflections = 4;
    EXPECT_THAT(paths_at(canyon_for(5, 20, antenna, direction), antenna, satellites, settings)[0].paths, IsEmpty());
    settings.most_reflections = 5;
    EXPECT_THAT(paths_at(canyon_for(5, 20, antenna, direction), antenna, satellites, settings)[0].paths, SizeIs(1));
}

TEST(PathFinder, FindsSevenPathsInATrihedralWithReflectingGround) {
    CityModel city = empty_scene_city();
    add_wall(city, {30, -300}, {30, 40}, -300, 50);
    add_wall(city, {-300, 40}, {30, 40}, -300, 50);
    city.add_quad({Eigen::Vector3d(-300, -300, -2), {30, -300, -2}, {30, 40, -2}, {-300, 40, -2}}, SurfaceKind::ground);
    const Eigen::Vector3d antenna(0, 0, 1.5);
    const Eigen::Vector3d direction = Eigen::Vector3d(-0.6, -0.5, 0.5).normalized();
    const std::vector satellites{satellite_at(1, antenna, direction, infinitely_far)};
    PathSearchSettings settings = search_of_everything();
    settings.ground_reflects = true;
    const auto found = paths_at(city, antenna, satellites, settings);
    ASSERT_THAT(reflection_counts(found[0]), testing::ElementsAre(1, 1, 1, 2, 2, 2, 3));
    EXPECT_NEAR(found[0].paths[6].excess, (antenna - Eigen::Vector3d(60, 80, -5.5)).dot(direction), 1e-6);

    settings.ground_reflects = false;
    EXPECT_THAT(reflection_counts(paths_at(city, antenna, satellites, settings)[0]), testing::ElementsAre(1, 1, 2));
    settings.walls_reflect = false;
    EXPECT_THAT(paths_at(city, antenna, satellites, settings)[0].paths, IsEmpty());
}

TEST(PathFinder, FindsNoWayOutOfAClosedRoom) {
    CityModel city = empty_scene_city();
    for (const auto& [from, to] : {std::pair(Eigen::Vector2d(-20, -15), Eigen::Vector2d(25, -15)),
                                   {{25, -15}, {25, 18}},
                                   {{25, 18}, {-20, 18}},
                                   {{-20, 18}, {-20, -15}}})
        add_wall(city, from, to, -1, 30);
    for (const double height : {-1.0, 30.0})
        city.add_quad({Eigen::Vector3d(-20, -15, height), {25, -15, height}, {25, 18, height}, {-20, 18, height}},
                      SurfaceKind::wall);
    for (const SatellitePaths& found :
         paths_at(city, {1, 2, 1.5}, scattered_satellites(40, 7), search_of_everything(100000))) {
        EXPECT_FALSE(found.line_of_sight);
        EXPECT_THAT(found.paths, IsEmpty());
    }
}

TEST(PathFinder, FindsThePathsOfASlopedRoof) {
    // A facade that leans by 40° turns high elevations into low ones, which bands alone would miss.
    CityModel city = empty_scene_city();
    const double lean = std::tan(40 * std::numbers::pi / 180);
    city.add_quad(
        {Eigen::Vector3d(30, -500, 0), {30, 500, 0}, {30 + 200 * lean, 500, 200}, {30 + 200 * lean, -500, 200}},
        SurfaceKind::wall);
    const Eigen::Vector3d antenna(0, 0, 1.5);
    const auto scene = built_scene(city);
    const Eigen::Vector3d launch = heading(15, 10);
    const Eigen::Vector3d normal = scene->planes()[0].normal;
    const Eigen::Vector3d direction = launch - normal * (2 * normal.dot(launch));
    ASSERT_GT(direction.z(), 0.5);
    const auto found =
        paths_at(city, antenna, {satellite_at(1, antenna, direction, infinitely_far)}, search_of_everything(65536));
    ASSERT_THAT(found[0].paths, SizeIs(1));
    EXPECT_LT((found[0].paths[0].arrival - launch).norm(), 1e-9);
}

// Rows of the oracle hold for plane waves.
TEST(PathFinder, AgreesWithTheReflectionOracle) {
    SKYLOOP_REQUIRE_SHARED(table, "oracles/reflection_geometry.csv");
    for (const OracleRow& row : oracle_rows(table.filename().string())) {
        SCOPED_TRACE(row.id());
        const bool canyon = row.text("scene") == "canyon";
        const auto reflections = static_cast<int>(row.integer("n_reflections"));
        const Eigen::Vector3d antenna(row.number("w_m"), 0, 1.5);
        const Eigen::Vector3d direction = heading(row.number("el_deg"), row.number("rel_azimuth_deg"));
        const double width = canyon ? row.number("canyon_width_m") : 100;
        const auto found = paths_at(canyon_for(reflections, width, antenna, direction), antenna,
                                    {satellite_at(1, antenna, direction, infinitely_far)}, search_of_everything(65536));
        ASSERT_THAT(reflection_counts(found[0]), testing::ElementsAre(reflections));
        EXPECT_NEAR(found[0].paths[0].excess, row.number("extra_path_m"), row.number("tol_m"));
    }
}

TEST(PathFinder, FindsTheSameSixKilometresFromTheOrigin) {
    const Eigen::Vector3d away(4100, -4100, 0);
    const CityModel near = house_grid_city(6, 3);
    CityModel far = near;
    for (Eigen::Vector3d& vertex : far.vertices)
        vertex += away;
    std::vector<SceneSatellite> satellites = scattered_satellites(150, 5);
    const Eigen::Vector3d antenna(0, 13, 1.6);
    const auto here = paths_at(near, antenna, satellites, search_of_everything(65536));
    for (SceneSatellite& satellite : satellites)
        satellite.position += away;
    const auto there = paths_at(far, antenna + away, satellites, search_of_everything(65536));
    std::size_t compared = 0;
    for (std::size_t i = 0; i < here.size(); ++i) {
        EXPECT_EQ(here[i].line_of_sight, there[i].line_of_sight);
        ASSERT_EQ(reflection_counts(here[i]), reflection_counts(there[i]));
        for (std::size_t j = 0; j < here[i].paths.size(); ++j, ++compared)
            EXPECT_NEAR(here[i].paths[j].excess, there[i].paths[j].excess, 1e-9);
    }
    EXPECT_GT(compared, 40U);
}

TEST(PathFinder, GivesTheRateOfTheExcessAsItGrows) {
    const auto scene = built_scene(house_grid_city(6, 3));
    PathFinder finder(scene, search_of_everything(65536));
    const std::vector<SceneSatellite> satellites = scattered_satellites(150, 5);
    const SceneObserver observer{scene_noon, {0, 13, 1.6}, {3, 14, 0.5}};
    const auto found = finder.epoch(observer, satellites);
    constexpr double step = 0.05;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        for (const ScenePath& path : found[i].paths) {
            const auto excess_at = [&](double seconds) {
                return unfold(*scene, {path.planes.begin(), path.planes.size()},
                              observer.position + seconds * observer.velocity,
                              satellites[i].position + seconds * satellites[i].velocity)
                    .excess;
            };
            EXPECT_NEAR(path.excess_rate, (excess_at(step) - excess_at(-step)) / (2 * step), 1e-7);
            ++compared;
        }
    }
    EXPECT_GT(compared, 40U);
}

TEST(DefaultRays, AreFewerTheMoreEpochsThereAre) {
    EXPECT_EQ(default_rays(0), 65536);
    EXPECT_EQ(default_rays(1), 65536);
    EXPECT_EQ(default_rays(10), 65536);
    EXPECT_LT(default_rays(15), 65536);
    EXPECT_GT(default_rays(15), 16384);
    EXPECT_EQ(default_rays(25), 16384);
    EXPECT_EQ(default_rays(1000), 2048);
}

}  // namespace
}  // namespace skyloop::test
