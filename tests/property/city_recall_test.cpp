// The paths that a search by rays finds are all there are of few reflections, and no others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "support/exhaustive_paths.hpp"
#include "support/oracle_table.hpp"
#include "support/random_sky.hpp"
#include "world/city/city_file.hpp"
#include "world/scene/generated_city.hpp"

namespace skyloop::test {
namespace {

// What a receiver that stands for a moment has: this many searches of this many rays from one place, the lattice turned
// between them. One search alone finds some 99.9 % of the paths of up to four reflections.
constexpr int searches = 3;
constexpr int rays_of_search = 65536;
constexpr int satellites_of_sky = 40;

struct Recall {
    int all = 0, found = 0, extra = 0, single = 0;
};

bool same_path(const ScenePath& a, const ScenePath& b) {
    return a.planes.size() == b.planes.size() && std::abs(a.excess - b.excess) < 1e-6 &&
           (a.arrival - b.arrival).norm() < 1e-9;
}

bool holds(const std::vector<ScenePath>& paths, const ScenePath& path) {
    return std::any_of(paths.begin(), paths.end(), [&](const ScenePath& p) { return same_path(p, path); });
}

std::string described(const ScenePath& path) {
    std::string text = "by planes";
    for (const std::uint32_t plane : path.planes)
        text += " " + std::to_string(plane);
    return text + ", excess " + std::to_string(path.excess);
}

std::vector<SatellitePaths> searched_paths(const std::shared_ptr<const UrbanScene>& scene, SceneObserver observer,
                                           std::span<const SceneSatellite> sky) {
    PathSearchSettings settings;
    settings.rays = rays_of_search;
    settings.search_ahead = false;
    PathFinder finder(scene, settings);
    std::vector<SatellitePaths> found;
    for (int epoch = 0; epoch < searches; ++epoch) {
        found = finder.epoch(observer, sky);
        observer.now = observer.now + std::chrono::milliseconds(100);
    }
    return found;
}

void compare_at(const std::shared_ptr<const UrbanScene>& scene, const Eigen::Vector3d& place, int most,
                Recall& recall) {
    const auto sky = random_sky(satellites_of_sky, place, static_cast<std::uint64_t>(recall.all) + 77);
    SceneObserver observer;
    observer.now = to_gps_time(2300, 0.0);
    observer.position = place;
    const auto found = searched_paths(scene, observer, sky);
    PathSearchSettings few;
    few.most_reflections = most;
    const auto all = exhaustive_paths(*scene, observer, sky, few);
    ASSERT_EQ(found.size(), all.size());
    for (std::size_t s = 0; s < all.size(); ++s) {
        ASSERT_EQ(found[s].id, all[s].id);
        EXPECT_EQ(found[s].line_of_sight, all[s].line_of_sight);
        for (const ScenePath& path : all[s].paths) {
            const bool is_found = holds(found[s].paths, path);
            EXPECT_TRUE(is_found) << "missed at " << place.transpose() << ": " << described(path);
            ++recall.all;
            recall.found += is_found ? 1 : 0;
            recall.single += path.reflections() == 1 ? 1 : 0;
        }
        for (const ScenePath& path : found[s].paths) {
            if (path.reflections() > most) continue;
            const bool known = holds(all[s].paths, path);
            EXPECT_TRUE(known) << "extra at " << place.transpose() << ": " << described(path);
            recall.extra += known ? 0 : 1;
        }
    }
}

void expect_complete(const Recall& recall, int least) {
    EXPECT_EQ(recall.found, recall.all);
    EXPECT_EQ(recall.extra, 0);
    EXPECT_GE(recall.all, least);
    EXPECT_GT(recall.single, 0);
    EXPECT_GT(recall.all, recall.single);
    std::printf("paths %d, of one reflection %d, found %d, extra %d\n", recall.all, recall.single, recall.found,
                recall.extra);
}

TEST(CityRecall, OfUpToTwoReflectionsIsOneInRandomCities) {
    Recall recall;
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        GeneratedCitySettings settings;
        settings.triangles = 1000;
        settings.seed = seed;
        const GeneratedCity made = generated_city(settings, Geodetic{});
        const auto scene = UrbanScene::build(made.city);
        ASSERT_TRUE(scene);
        for (std::size_t i = 0; i < 4; ++i)
            compare_at(*scene, made.street_places[i], 2, recall);
    }
    expect_complete(recall, 60);
}

TEST(CityRecall, OfThreeReflectionsIsOneInASmallCity) {
    Recall recall;
    GeneratedCitySettings settings;
    settings.triangles = 500;
    settings.seed = 4;
    const GeneratedCity made = generated_city(settings, Geodetic{});
    const auto scene = UrbanScene::build(made.city);
    ASSERT_TRUE(scene);
    for (std::size_t i = 0; i < 4; ++i)
        compare_at(*scene, made.street_places[i], 3, recall);
    expect_complete(recall, 20);
}

// What stands within `radius` of a place, and all ground.
CityModel cut_out(const CityModel& city, const Eigen::Vector2d& middle, double radius) {
    CityModel part;
    part.origin = city.origin;
    part.materials = city.materials;
    for (const CityTriangle& t : city.triangles) {
        const std::array corners{city.vertices[t.corners[0]], city.vertices[t.corners[1]], city.vertices[t.corners[2]]};
        const Eigen::Vector3d centre = (corners[0] + corners[1] + corners[2]) / 3;
        if (t.kind == SurfaceKind::ground || (centre.head<2>() - middle).norm() < radius)
            part.add_triangle(corners, t.kind, t.material);
    }
    return part;
}

// Places over open ground with walls around.
std::vector<Eigen::Vector3d> open_places(const UrbanScene& scene, double radius, std::size_t count) {
    std::vector<Eigen::Vector3d> places;
    RandomStream random(5, "open places");
    for (int trial = 0; trial < 10'000 && places.size() < count; ++trial) {
        const double east = radius * (2 * random.uniform() - 1), north = radius * (2 * random.uniform() - 1);
        const auto ground = scene.ground_at(east, north), top = scene.top_at(east, north);
        if (!ground || !top || *top > *ground + 0.01) continue;
        const Eigen::Vector3d place(east, north, *ground + 1.6);
        int walls = 0;
        for (int k = 0; k < 16; ++k)
            walls += scene.blocked({place, {std::sin(k * 0.3927), std::cos(k * 0.3927), 0}}, 60) ? 1 : 0;
        if (walls >= 8) places.push_back(place);
    }
    return places;
}

TEST(CityRecall, OfUpToTwoReflectionsIsOneInMunich) {
    SKYLOOP_REQUIRE_SHARED(archive, "city/munich.tar.gz");
    const auto munich = read_city(archive, {});
    ASSERT_TRUE(munich) << munich.error().message;
    const auto scene = UrbanScene::build(cut_out(munich->model, {0, 0}, 200));
    ASSERT_TRUE(scene);
    const auto places = open_places(**scene, 100, 4);
    ASSERT_EQ(places.size(), 4U);
    Recall recall;
    for (const Eigen::Vector3d& place : places)
        compare_at(*scene, place, 2, recall);
    expect_complete(recall, 10);
}

}  // namespace
}  // namespace skyloop::test
