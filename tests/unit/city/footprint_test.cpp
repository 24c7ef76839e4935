#include "world/city/footprint.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/core/random.hpp"

namespace skyloop::test {
namespace {

using Ring = std::vector<Eigen::Vector2d>;

double ring_area(const Ring& ring) {
    double sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
        sum += a.x() * b.y() - a.y() * b.x();
    }
    return std::abs(sum) / 2;
}

std::vector<Eigen::Vector2d> points_of(const Footprint& footprint) {
    Ring points = footprint.outer;
    for (const Ring& hole : footprint.holes)
        points.insert(points.end(), hole.begin(), hole.end());
    return points;
}

/// Sum of the areas of the triangles: larger than the polygon's where they overlap, smaller where they leave gaps.
double covered_area(const Footprint& footprint) {
    const Ring points = points_of(footprint);
    double sum = 0;
    for (const auto& [a, b, c] : triangulated(footprint)) {
        const Eigen::Vector2d u = points.at(b) - points.at(a), v = points.at(c) - points.at(a);
        sum += std::abs(u.x() * v.y() - u.y() * v.x()) / 2;
    }
    return sum;
}

/// A ring around `centre` whose radius changes at random between the two from corner to corner.
Ring star(const Eigen::Vector2d& centre, std::pair<double, double> radii, int corners, std::uint64_t seed) {
    RandomStream random(seed, "star");
    Ring ring;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        const double radius = radii.first + (radii.second - radii.first) * random.uniform();
        ring.emplace_back(centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    return ring;
}

Ring rectangle(double east, double north, double width, double depth) {
    return {{east, north}, {east + width, north}, {east + width, north + depth}, {east, north + depth}};
}

TEST(Triangulated, CoversASquareInEitherSenseClosedOrNot) {
    Footprint square{rectangle(10, 20, 4, 3), {}};
    EXPECT_EQ(triangulated(square).size(), 2u);
    EXPECT_DOUBLE_EQ(covered_area(square), 12);
    std::reverse(square.outer.begin(), square.outer.end());
    EXPECT_DOUBLE_EQ(covered_area(square), 12);
    square.outer.push_back(square.outer.front());
    EXPECT_DOUBLE_EQ(covered_area(square), 12);
}

TEST(Triangulated, CoversStarsWithStarsAsHoles) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        Footprint footprint{star({1000, -500}, {50, 100}, 5 + static_cast<int>(seed), seed), {}};
        double area = ring_area(footprint.outer);
        for (int k = 0; k < static_cast<int>(seed % 5); ++k) {
            const double angle = 2 * std::numbers::pi * k / 5;
            const Eigen::Vector2d centre =
                Eigen::Vector2d(1000, -500) + 24 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
            footprint.holes.push_back(star(centre, {2, 13}, 4 + static_cast<int>(seed) % 17, seed * 8 + 1));
            area -= ring_area(footprint.holes.back());
        }
        ASSERT_NEAR(covered_area(footprint), area, 1e-6 * area) << "seed " << seed;
    }
}

TEST(Triangulated, CoversACombOfThousandsOfCorners) {
    Ring comb;
    for (int i = 0; i < 2000; ++i) {
        comb.emplace_back(i, 0);
        comb.emplace_back(i + 0.5, 100);
    }
    comb.emplace_back(2000, 0);
    comb.emplace_back(2000, -1);
    comb.emplace_back(0, -1);
    const Footprint footprint{comb, {}};
    EXPECT_NEAR(covered_area(footprint), ring_area(comb), 1e-6 * ring_area(comb));
}

TEST(Triangulated, CoversASieveOfManyHoles) {
    Footprint sieve{rectangle(0, 0, 100, 100), {}};
    for (int i = 0; i < 20; ++i)
        for (int k = 0; k < 20; ++k)
            sieve.holes.push_back(rectangle(5.0 * i + 1, 5.0 * k + 1, 3, 3));
    EXPECT_NEAR(covered_area(sieve), 10000 - 400 * 9, 1e-6);
}

TEST(Triangulated, ToleratesRepeatedPointsAndCollinearRuns) {
    const Footprint footprint{
        {{0, 0}, {0, 0}, {2, 0}, {4, 0}, {4, 0}, {4, 0}, {4, 3}, {3, 3}, {2, 3}, {0, 3}, {0, 1}, {0, 0}}, {}};
    EXPECT_DOUBLE_EQ(covered_area(footprint), 12);
}

TEST(Triangulated, CoversRingsThatTouchThemselves) {
    // Two squares joined at a corner, and a courtyard that touches the outline.
    const Footprint bow{{{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}}, {}};
    EXPECT_DOUBLE_EQ(covered_area(bow), 2);
    const Footprint court{rectangle(0, 0, 4, 4), {{{0, 2}, {2, 1}, {2, 3}}}};
    EXPECT_DOUBLE_EQ(covered_area(court), 14);
}

TEST(Triangulated, CoversBothHalvesOfABowTie) {
    const Footprint bow{{{0, 0}, {4, 4}, {4, 0}, {0, 4}}, {}};
    const double covered = covered_area(bow);
    EXPECT_GT(covered, 4);
    EXPECT_LE(covered, 16.001);
}

TEST(Triangulated, FindsNothingInPolygonsWithoutArea) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Ring& ring : {Ring{}, Ring{{1, 1}}, Ring{{0, 0}, {1, 1}}, Ring{{0, 0}, {1, 1}, {2, 2}, {3, 3}},
                             Ring{{5, 5}, {5, 5}, {5, 5}}, Ring{{0, 0}, {nan, 0}, {1, 1}},
                             Ring{{0, 0}, {1e300, 0}, {1e300, 1e300}}, Ring{{0, 0}, {1, 0}, {0, 0}, {1, 0}}})
        EXPECT_TRUE(triangulated({ring, {}}).empty()) << ring.size();
}

TEST(Triangulated, LeavesOutHolesThatLieOutside) {
    const Footprint footprint{rectangle(0, 0, 4, 4), {rectangle(-10, 1, 2, 2)}};
    EXPECT_NEAR(covered_area(footprint), 16, 1e-9);
}

TEST(AddExtruded, MakesAClosedPrismWithoutFloor) {
    CityModel city;
    ASSERT_TRUE(add_extruded(city, {rectangle(0, 0, 10, 20), {rectangle(2, 2, 3, 4)}}, 5, 17, 0));
    std::array<double, 3> area{};
    for (const CityTriangle& t : city.triangles) {
        const Eigen::Vector3d a = city.vertices[t.corners[0]], b = city.vertices[t.corners[1]],
                              c = city.vertices[t.corners[2]];
        area[static_cast<std::size_t>(t.kind)] += (b - a).cross(c - a).norm() / 2;
        EXPECT_GE(std::min({a.z(), b.z(), c.z()}), 5);
        EXPECT_LE(std::max({a.z(), b.z(), c.z()}), 17);
    }
    EXPECT_DOUBLE_EQ(area[static_cast<std::size_t>(SurfaceKind::wall)], (60 + 14) * 12);
    EXPECT_DOUBLE_EQ(area[static_cast<std::size_t>(SurfaceKind::roof)], 200 - 12);
    EXPECT_EQ(area[static_cast<std::size_t>(SurfaceKind::ground)], 0);
}

double roof_area_of(const CityModel& city) {
    double area = 0;
    for (const CityTriangle& t : city.triangles) {
        const Eigen::Vector3d a = city.vertices[t.corners[0]], b = city.vertices[t.corners[1]],
                              c = city.vertices[t.corners[2]];
        if (t.kind == SurfaceKind::roof) area += (b - a).cross(c - a).norm() / 2;
    }
    return area;
}

TEST(AddExtruded, CoversAllLoopsOfARingThatCrossesItself) {
    CityModel bow;
    ASSERT_TRUE(add_extruded(bow, {{{0, 0}, {4, 4}, {4, 0}, {0, 4}, {0, 0}}, {}}, 0, 9));
    EXPECT_NEAR(roof_area_of(bow), 8, 1e-9) << "two triangles, 4 m wide and 2 m high";
    // A five-pointed star drawn without lifting the pen: its points and its middle, a pentagon.
    Ring pentagram;
    for (int i = 0; i < 5; ++i)
        pentagram.emplace_back(std::sin(0.8 * std::numbers::pi * i), std::cos(0.8 * std::numbers::pi * i));
    CityModel star_city;
    ASSERT_TRUE(add_extruded(star_city, {pentagram, {}}, 0, 9));
    EXPECT_GT(roof_area_of(star_city), 1.12);
}

TEST(AddExtruded, AddsNothingWithoutAreaOrHeight) {
    CityModel city;
    EXPECT_FALSE(add_extruded(city, {{{0, 0}, {1, 1}, {2, 2}}, {}}, 0, 9));
    EXPECT_FALSE(add_extruded(city, {rectangle(0, 0, 1, 1), {}}, 9, 9));
    EXPECT_FALSE(add_extruded(city, {rectangle(0, 0, 1, 1), {}}, 0, std::numeric_limits<double>::infinity()));
    EXPECT_TRUE(city.vertices.empty() && city.triangles.empty());
}

TEST(AddPolygon, KeepsTheAreaOfASlopedPolygonWithAHole) {
    const Eigen::AngleAxisd turn(0.7, Eigen::Vector3d(1, 2, 3).normalized());
    std::vector<std::vector<Eigen::Vector3d>> rings(2);
    for (const Eigen::Vector2d& p : rectangle(0, 0, 10, 8))
        rings[0].push_back(turn * Eigen::Vector3d(p.x(), p.y(), 50));
    for (const Eigen::Vector2d& p : rectangle(3, 3, 2, 2))
        rings[1].push_back(turn * Eigen::Vector3d(p.x(), p.y(), 50));
    CityModel city;
    ASSERT_TRUE(add_polygon(city, rings, SurfaceKind::roof, 0));
    double area = 0;
    for (const CityTriangle& t : city.triangles) {
        EXPECT_EQ(t.kind, SurfaceKind::roof);
        const Eigen::Vector3d a = city.vertices[t.corners[0]];
        area += (city.vertices[t.corners[1]] - a).cross(city.vertices[t.corners[2]] - a).norm() / 2;
    }
    EXPECT_NEAR(area, 76, 1e-9);
    EXPECT_FALSE(add_polygon(city, {{{0, 0, 0}, {0, 0, 5}, {0, 0, 9}}}, SurfaceKind::wall));
    EXPECT_FALSE(add_polygon(city, {}, SurfaceKind::wall));
}

}  // namespace
}  // namespace skyloop::test
