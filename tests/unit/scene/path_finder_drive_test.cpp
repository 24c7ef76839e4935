// The finder over many epochs: what it remembers, what it finds ahead, and that threads change nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <string>

#include "closed_scenes.hpp"

namespace skyloop::test {
namespace {

using Drive = std::vector<std::vector<SatellitePaths>>;

constexpr double epoch_seconds = 0.1;

// North along a street at 12 m/s.
SceneObserver driver_at(int epoch) {
    const double time = epoch * epoch_seconds;
    return {advanced(scene_noon, Seconds(time)),
            {0.5 * std::sin(time), -40 + 12 * time, 1.6},
            {0.5 * std::cos(time), 12, 0}};
}

std::vector<SceneSatellite> moved_satellites(double time) {
    std::vector<SceneSatellite> satellites = scattered_satellites(40, 5);
    for (SceneSatellite& satellite : satellites)
        satellite.position += time * satellite.velocity;
    return satellites;
}

Drive driven(PathFinder& finder, int epochs) {
    Drive drive;
    for (int i = 0; i < epochs; ++i)
        drive.push_back(finder.epoch(driver_at(i), moved_satellites(i * epoch_seconds)));
    return drive;
}

// Every number of every path, so that drives can be compared by bytes.
std::string bytes_of(const Drive& drive) {
    std::string bytes;
    const auto append = [&bytes](const auto& value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
    };
    for (const auto& epoch : drive) {
        for (const SatellitePaths& satellite : epoch) {
            append(satellite.id.number);
            append(satellite.line_of_sight);
            for (const ScenePath& path : satellite.paths) {
                for (const std::uint32_t plane : path.planes)
                    append(plane);
                for (const double coordinate : path.arrival)
                    append(coordinate);
                append(path.excess);
                append(path.excess_rate);
            }
        }
    }
    return bytes;
}

// Paths as satellite and planes; those with few reflections.
std::set<std::pair<int, std::vector<std::uint32_t>>> keys_of(const std::vector<SatellitePaths>& epoch, int most = 4) {
    std::set<std::pair<int, std::vector<std::uint32_t>>> keys;
    for (const SatellitePaths& satellite : epoch)
        for (const ScenePath& path : satellite.paths)
            if (path.reflections() <= most)
                keys.insert({satellite.id.number, {path.planes.begin(), path.planes.end()}});
    return keys;
}

PathSearchSettings driving_settings(int threads) {
    PathSearchSettings settings;
    settings.rays = 8192;
    settings.threads = threads;
    return settings;
}

TEST(PathFinderDrive, GivesTheSameBytesWhateverTheNumberOfThreads) {
    const auto scene = built_scene(house_grid_city(6, 3));
    PathFinder alone(scene, driving_settings(0));
    const std::string expected = bytes_of(driven(alone, 25));
    EXPECT_GT(expected.size(), 20000U);
    for (const int threads : {1, 2, 4}) {
        SCOPED_TRACE(threads);
        PathFinder finder(scene, driving_settings(threads));
        EXPECT_EQ(bytes_of(driven(finder, 25)), expected);
        EXPECT_EQ(finder.counters().rays, alone.counters().rays);
        EXPECT_EQ(finder.counters().segments, alone.counters().segments);
        EXPECT_EQ(finder.counters().candidates, alone.counters().candidates);
        EXPECT_EQ(finder.counters().accepted, alone.counters().accepted);
    }
}

TEST(PathFinderDrive, FindsAheadNearlyAllThatASearchOnTheSpotFinds) {
    const auto scene = built_scene(house_grid_city(6, 3));
    PathFinder finder(scene, driving_settings(1));
    PathSearchSettings thorough = driving_settings(0);
    thorough.rays = 65536;
    thorough.search_ahead = false;
    std::size_t expected = 0;
    std::size_t found = 0;
    for (int i = 0; i < 25; ++i) {
        const std::vector<SceneSatellite> satellites = moved_satellites(i * epoch_seconds);
        const auto ahead = keys_of(finder.epoch(driver_at(i), satellites));
        PathFinder fresh(scene, thorough);
        const auto there = keys_of(fresh.epoch(driver_at(i), satellites));
        expected += there.size();
        for (const auto& key : there)
            found += ahead.count(key);
    }
    EXPECT_GT(expected, 300U);
    EXPECT_GT(static_cast<double>(found), 0.99 * static_cast<double>(expected)) << found << " of " << expected;
}

// How far the antenna goes from one epoch to the next is not known before the second one.
TEST(PathFinderDrive, SearchesOnTheSpotInTheSecondEpochAndAfterGaps) {
    const auto scene = built_scene(house_grid_city(6, 3));
    PathSearchSettings settings = driving_settings(0);
    settings.search_ahead = false;
    // 1 s apart, and with gaps that are longer than paths are remembered.
    for (const std::vector<int>& epochs : {std::vector{0, 10}, std::vector{0, 25, 50, 75}}) {
        PathFinder finder(scene, driving_settings(1)), at_once(scene, settings);
        for (const int epoch : epochs) {
            SCOPED_TRACE(epoch);
            const std::vector<SceneSatellite> satellites = moved_satellites(epoch * epoch_seconds);
            EXPECT_EQ(keys_of(finder.epoch(driver_at(epoch), satellites)),
                      keys_of(at_once.epoch(driver_at(epoch), satellites)));
            EXPECT_EQ(finder.counters().rays, at_once.counters().rays);
        }
    }
}

TEST(PathFinderDrive, HasPathsInTheFirstEpoch) {
    const auto scene = built_scene(house_grid_city(6, 3));
    PathFinder ahead(scene, driving_settings(1));
    PathSearchSettings settings = driving_settings(0);
    settings.search_ahead = false;
    PathFinder at_once(scene, settings);
    const auto found = keys_of(ahead.epoch(driver_at(0), moved_satellites(0)));
    EXPECT_GT(found.size(), 5U);
    EXPECT_EQ(found, keys_of(at_once.epoch(driver_at(0), moved_satellites(0))));
}

TEST(PathFinderDrive, SearchesAtOnceAfterAJump) {
    const auto scene = built_scene(house_grid_city(8, 3));
    PathFinder jumping(scene, driving_settings(1));
    driven(jumping, 2);
    SceneObserver elsewhere = driver_at(2);
    elsewhere.position.x() += 88;
    const auto found = keys_of(jumping.epoch(elsewhere, moved_satellites(0.2)));
    EXPECT_GT(jumping.counters().rays_last, 1000);

    PathSearchSettings thorough = driving_settings(0);
    thorough.rays = 65536;
    thorough.search_ahead = false;
    PathFinder fresh(scene, thorough);
    const auto there = keys_of(fresh.epoch(elsewhere, moved_satellites(0.2)));
    EXPECT_GT(there.size(), 10U);
    std::size_t common = 0;
    for (const auto& key : there)
        common += found.count(key);
    EXPECT_GE(static_cast<double>(common), 0.9 * static_cast<double>(there.size()));
}

TEST(PathFinderDrive, SendsFewRaysWhileTheAntennaStandsStill) {
    const auto scene = built_scene(house_grid_city(6, 3));
    PathSearchSettings settings = driving_settings(1);
    settings.rays = 65536;
    PathFinder finder(scene, settings);
    SceneObserver observer = driver_at(3);
    observer.velocity.setZero();
    const std::vector<SceneSatellite> satellites = moved_satellites(0);
    std::vector<SatellitePaths> last;
    int first_rays = 0;
    for (int i = 0; i < 10; ++i) {
        last = finder.epoch(observer, satellites);
        if (i == 0) first_rays = finder.counters().rays_last;
        observer.now += to_nanoseconds(Seconds(0.1));
    }
    EXPECT_GT(first_rays, 10000);
    EXPECT_LE(finder.counters().rays_last, 2048);
    EXPECT_GT(finder.counters().rays_last, 0);
    settings.search_ahead = false;
    PathFinder fresh(scene, settings);
    const auto there = keys_of(fresh.epoch(observer, satellites));
    const auto here = keys_of(last);
    EXPECT_TRUE(std::includes(here.begin(), here.end(), there.begin(), there.end()));
}

// A canyon whose far wall has a door: the path goes, and comes back from memory without a search that could find it.
TEST(PathFinderDrive, RemembersAPathThatIsGoneForAMoment) {
    CityModel city = empty_scene_city();
    add_wall(city, {30, -200}, {30, -1}, 0, 100);
    add_wall(city, {30, 1}, {30, 200}, 0, 100);
    const auto scene = built_scene(city);
    PathSearchSettings settings = search_of_everything();
    settings.search_ahead = true;
    settings.rays = 20000;
    const Eigen::Vector3d direction = heading(40, 180);
    const std::vector satellites{satellite_at(1, Eigen::Vector3d::Zero(), direction, infinitely_far)};
    const auto paths_after = [&](double gap_seconds) {
        PathFinder finder(scene, settings);
        SceneObserver observer{scene_noon, {0, -5, 1.5}, Eigen::Vector3d::Zero()};
        EXPECT_THAT(finder.epoch(observer, satellites)[0].paths, testing::SizeIs(1));
        observer.position.y() = 0;
        for (double time = 0; time < gap_seconds; time += 0.5) {
            observer.now += to_nanoseconds(Seconds(0.5));
            EXPECT_THAT(finder.epoch(observer, satellites)[0].paths, testing::IsEmpty());
        }
        return finder.counters().cached_last;
    };
    EXPECT_EQ(paths_after(1.5), 1);
    EXPECT_EQ(paths_after(3), 0);
}

TEST(PathFinderDrive, StandsTimeThatGoesBackwardsAndPositionsThatAreNoNumbers) {
    const auto scene = built_scene(house_grid_city(4, 3));
    PathFinder finder(scene, driving_settings(2));
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    driven(finder, 3);
    SceneObserver lost = driver_at(3);
    lost.position.y() = nothing;
    lost.velocity.z() = nothing;
    for (const SatellitePaths& found : finder.epoch(lost, moved_satellites(0))) {
        EXPECT_FALSE(found.line_of_sight);
        EXPECT_THAT(found.paths, testing::IsEmpty());
    }
    std::vector<SceneSatellite> satellites = moved_satellites(0);
    satellites[3].position.x() = nothing;
    satellites[4].velocity.x() = nothing;
    const auto found = finder.epoch(driver_at(0), satellites);
    EXPECT_FALSE(found[3].line_of_sight);
    EXPECT_GT(keys_of(found).size(), 0U);
    for (const ScenePath& path : found[4].paths)
        EXPECT_TRUE(std::isfinite(path.excess_rate));
    EXPECT_THAT(finder.epoch(driver_at(1), {}), testing::IsEmpty());
}

TEST(PathFinderDrive, EndsWhileASearchRuns) {
    const auto scene = built_scene(house_grid_city(6, 3));
    for (const int threads : {1, 3}) {
        PathFinder finder(scene, driving_settings(threads));
        driven(finder, 2);
        PathFinder moved = std::move(finder);
        EXPECT_THAT(moved.epoch(driver_at(2), moved_satellites(0.2)), testing::SizeIs(40));
    }
}

}  // namespace
}  // namespace skyloop::test
