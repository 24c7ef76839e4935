#include "world/scene/generated_city.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>

namespace skyloop {
namespace {

const Geodetic generated_city_origin = Geodetic::degrees(46.4774, 30.7326, 50);

using PointKey = std::tuple<double, double, double>;

PointKey point_key(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

const Eigen::Vector3d& corner(const CityModel& city, const CityTriangle& triangle, std::size_t k) {
    return city.vertices[triangle.corners[k]];
}

double area(const CityModel& city, const CityTriangle& t) {
    const Eigen::Vector3d& a = corner(city, t, 0);
    return (corner(city, t, 1) - a).cross(corner(city, t, 2) - a).norm() / 2;
}

// How many triangles other than the ground's have an edge from one point to another, to the last bit.
std::map<std::pair<PointKey, PointKey>, int> edges(const CityModel& city) {
    std::map<std::pair<PointKey, PointKey>, int> count;
    for (const CityTriangle& t : city.triangles) {
        if (t.kind == SurfaceKind::ground) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            auto a = point_key(corner(city, t, k)), b = point_key(corner(city, t, (k + 1) % 3));
            ++count[std::minmax(a, b)];
        }
    }
    return count;
}

void expect_sound(const CityModel& city) {
    for (const CityTriangle& t : city.triangles) {
        for (const std::uint32_t index : t.corners)
            ASSERT_LT(index, city.vertices.size());
        ASSERT_LT(t.material, city.materials.size());
        ASSERT_GT(area(city, t), 1e-4);
    }
    for (const Eigen::Vector3d& v : city.vertices)
        ASSERT_TRUE(v.allFinite());
}

// Every edge joins two facets but for those that stand on the ground.
void expect_closed(const CityModel& city) {
    std::size_t on_ground = 0;
    for (const auto& [edge, facets] : edges(city)) {
        const bool low = std::get<2>(edge.first) == 0 && std::get<2>(edge.second) == 0;
        on_ground += low ? 1 : 0;
        ASSERT_EQ(facets, low ? 1 : 2) << std::get<0>(edge.first) << ' ' << std::get<1>(edge.first) << ' '
                                       << std::get<2>(edge.first);
    }
    EXPECT_GT(on_ground, 0U);
}

bool above(const CityModel& city, const CityTriangle& t, const Eigen::Vector3d& place) {
    const auto side = [&](std::size_t k) {
        const Eigen::Vector3d &a = corner(city, t, k), &b = corner(city, t, (k + 1) % 3);
        return (b.x() - a.x()) * (place.y() - a.y()) - (b.y() - a.y()) * (place.x() - a.x());
    };
    const double s0 = side(0), s1 = side(1), s2 = side(2);
    return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

bool under_a_roof(const CityModel& city, const Eigen::Vector3d& place) {
    return std::any_of(city.triangles.begin(), city.triangles.end(),
                       [&](const CityTriangle& t) { return t.kind == SurfaceKind::roof && above(city, t, place); });
}

bool same_bytes(const CityModel& a, const CityModel& b) {
    if (a.vertices.size() != b.vertices.size() || a.triangles.size() != b.triangles.size()) return false;
    for (std::size_t i = 0; i < a.vertices.size(); ++i)
        if (std::memcmp(a.vertices[i].data(), b.vertices[i].data(), 3 * sizeof(double)) != 0) return false;
    for (std::size_t i = 0; i < a.triangles.size(); ++i) {
        const CityTriangle &s = a.triangles[i], &t = b.triangles[i];
        if (s.corners != t.corners || s.kind != t.kind || s.material != t.material) return false;
    }
    return true;
}

GeneratedCity city_of(std::size_t triangles, bool windows = false, std::uint64_t seed = 1) {
    GeneratedCitySettings settings;
    settings.triangles = triangles;
    settings.windows = windows;
    settings.seed = seed;
    return generated_city(settings, generated_city_origin);
}

TEST(GeneratedCity, HasAboutTheNumberOfTrianglesAskedFor) {
    for (const std::size_t wanted : {10'000U, 100'000U, 1'000'000U})
        EXPECT_NEAR(static_cast<double>(city_of(wanted).city.triangles.size()), static_cast<double>(wanted), 10);
    // One house with windows has some thousands.
    for (const std::size_t wanted : {50'000U, 1'000'000U})
        EXPECT_NEAR(static_cast<double>(city_of(wanted, true).city.triangles.size()), static_cast<double>(wanted),
                    8'000);
    EXPECT_GE(city_of(0).city.triangles.size(), 10U);
    EXPECT_GE(city_of(1, true).city.triangles.size(), 10U);
}

TEST(GeneratedCity, HousesAreClosedAndNoTriangleIsDegenerate) {
    for (const bool windows : {false, true}) {
        const GeneratedCity made = city_of(40'000, windows);
        expect_sound(made.city);
        expect_closed(made.city);
    }
}

TEST(GeneratedCity, TheSameSeedGivesTheSameBytesAndAnotherAnotherCity) {
    for (const bool windows : {false, true}) {
        const GeneratedCity a = city_of(20'000, windows, 7), b = city_of(20'000, windows, 7);
        EXPECT_TRUE(same_bytes(a.city, b.city));
        EXPECT_EQ(a.street_places, b.street_places);
        EXPECT_FALSE(same_bytes(a.city, city_of(20'000, windows, 8).city));
    }
}

TEST(GeneratedCity, StreetPlacesLieBetweenTheHousesOfItsInnerHalf) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        GeneratedCitySettings settings;
        settings.seed = seed;
        settings.turned_blocks = seed == 3 ? 1 : 0.15;
        const GeneratedCity made = generated_city(settings, generated_city_origin);
        double reach = 0;
        for (const CityTriangle& t : made.city.triangles)
            if (t.kind != SurfaceKind::ground)
                for (std::size_t k = 0; k < 3; ++k)
                    reach = std::max(reach, corner(made.city, t, k).head<2>().cwiseAbs().maxCoeff());
        ASSERT_GE(made.street_places.size(), 100U);
        for (const Eigen::Vector3d& place : made.street_places) {
            EXPECT_FALSE(under_a_roof(made.city, place)) << place.transpose();
            EXPECT_DOUBLE_EQ(place.z(), 1.6);
            EXPECT_LE(place.head<2>().cwiseAbs().maxCoeff(), reach / 2 + 20);
        }
    }
}

TEST(GeneratedCity, StreetPlacesSeeHousesAround) {
    // Of 16 directions most meet a wall within 60 m: these are streets, not fields.
    const GeneratedCity made = city_of(10'000);
    int walled = 0;
    for (std::size_t i = 0; i < 20; ++i) {
        int near = 0;
        for (int k = 0; k < 16; ++k) {
            const double a = k * 3.14159265358979 / 8;
            for (double r = 1; r < 60; r += 3)
                if (under_a_roof(made.city, made.street_places[i] + r * Eigen::Vector3d(std::sin(a), std::cos(a), 0))) {
                    ++near;
                    break;
                }
        }
        walled += near >= 8 ? 1 : 0;
    }
    EXPECT_GE(walled, 15);
}

TEST(GeneratedCity, GroundAndWindowsComeAsAskedFor) {
    GeneratedCitySettings settings;
    settings.ground = false;
    const auto kinds = [](const CityModel& city) {
        std::set<SurfaceKind> all;
        for (const CityTriangle& t : city.triangles)
            all.insert(t.kind);
        return all;
    };
    EXPECT_FALSE(kinds(generated_city(settings, generated_city_origin).city).contains(SurfaceKind::ground));
    settings.ground = true;
    EXPECT_TRUE(kinds(generated_city(settings, generated_city_origin).city).contains(SurfaceKind::ground));
    // Half of a cell's width and of its height is pane.
    const CityModel windowed = city_of(50'000, true).city;
    const auto glass = std::find(windowed.materials.begin(), windowed.materials.end(), "glass");
    ASSERT_NE(glass, windowed.materials.end());
    const auto pane = static_cast<std::uint8_t>(glass - windowed.materials.begin());
    const auto panes = std::count_if(windowed.triangles.begin(), windowed.triangles.end(),
                                     [&](const CityTriangle& t) { return t.material == pane; });
    EXPECT_GE(panes * 9, static_cast<std::ptrdiff_t>(windowed.triangles.size() * 95 / 100));
}

TEST(StreetCanyonScene, StandsAlongItsAzimuthAtItsWidth) {
    StreetCanyonSettings settings;
    settings.azimuth_deg = 30;
    settings.left_height = 25;
    const CityModel city = street_canyon(settings, generated_city_origin);
    expect_sound(city);
    expect_closed(city);
    const double azimuth = 30 * 3.14159265358979 / 180;
    const Eigen::Vector2d along(std::sin(azimuth), std::cos(azimuth)), right(std::cos(azimuth), -std::sin(azimuth));
    double left_wall = -1e9, right_wall = 1e9, left_top = 0, right_top = 0, end = 0;
    for (const CityTriangle& t : city.triangles) {
        if (t.kind == SurfaceKind::ground) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const Eigen::Vector3d& p = corner(city, t, k);
            const double across = p.head<2>().dot(right);
            double &wall = across < 0 ? left_wall : right_wall, &top = across < 0 ? left_top : right_top;
            wall = across < 0 ? std::max(wall, across) : std::min(wall, across);
            top = std::max(top, p.z());
            end = std::max(end, std::abs(p.head<2>().dot(along)));
        }
    }
    EXPECT_NEAR(left_wall, -10, 1e-9);
    EXPECT_NEAR(right_wall, 10, 1e-9);
    EXPECT_EQ(left_top, 25);
    EXPECT_EQ(right_top, 40);
    EXPECT_NEAR(end, 200, 1e-9);
}

TEST(StreetCanyonScene, SideStreetsAreGapsOfTheirWidth) {
    StreetCanyonSettings settings;
    settings.gap_every = 50;
    settings.gap_width = 12;
    const CityModel city = street_canyon(settings, generated_city_origin);
    expect_closed(city);
    for (double north = -199.5; north < 200; north += 1) {
        const double beside = std::abs(std::remainder(north, 50.0));
        EXPECT_EQ(under_a_roof(city, {15, north, 0}), beside < 19) << north;
        EXPECT_EQ(under_a_roof(city, {-15, north, 0}), beside < 19) << north;
        EXPECT_FALSE(under_a_roof(city, {0, north, 0}));
    }
    settings.right_height = 0;
    EXPECT_FALSE(under_a_roof(street_canyon(settings, generated_city_origin), {15, 0, 0}));
}

TEST(DemoCity, HasWhatItsDescriptionPromises) {
    const CityModel city = demo_city(generated_city_origin);
    expect_sound(city);
    EXPECT_NEAR(static_cast<double>(city.triangles.size()), 2000, 200);
    std::set<std::string> used;
    std::set<SurfaceKind> kinds;
    double highest = 0;
    for (const CityTriangle& t : city.triangles) {
        used.insert(city.materials[t.material]);
        kinds.insert(t.kind);
        highest = std::max(highest, corner(city, t, 2).z());
    }
    EXPECT_EQ(used, (std::set<std::string>{"concrete", "brick", "glass", "metal"}));
    EXPECT_EQ(kinds.size(), 3U);
    EXPECT_GE(highest, 100);
    ASSERT_EQ(city.foliage.size(), 1U);
    EXPECT_GE(city.foliage[0].ring.size(), 3U);
    EXPECT_LT(city.foliage[0].base, city.foliage[0].top);
    EXPECT_FALSE(under_a_roof(city, {0, 0, 0}));     // the square
    EXPECT_FALSE(under_a_roof(city, {46, 120, 0}));  // the avenue
    EXPECT_TRUE(under_a_roof(city, {46, 68, 0}));    // the arch over it
    EXPECT_TRUE(same_bytes(city, demo_city(generated_city_origin)));
}

TEST(DemoCity, HousesAreClosedButForTheArch) {
    const CityModel city = demo_city(generated_city_origin);
    std::size_t open = 0;
    for (const auto& [edge, facets] : edges(city)) {
        ASSERT_LE(facets, 2);
        const bool low = std::get<2>(edge.first) == 0 && std::get<2>(edge.second) == 0;
        if (!low && facets == 1) ++open;
    }
    EXPECT_EQ(open, 2U * (12 + 2));  // its two faces: twelve ribs and two legs each
}

}  // namespace
}  // namespace skyloop
