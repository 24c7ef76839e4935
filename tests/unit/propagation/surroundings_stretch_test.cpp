// Where surroundings of their own begin and end.
#include "world/propagation/surroundings_stretch.hpp"

#include <gtest/gtest.h>

namespace {

using namespace skyloop;

SurroundingsStretch stretch_of(decltype(SurroundingsStretch::extent) extent, double ramp) {
    SurroundingsStretch stretch;
    stretch.extent = std::move(extent);
    stretch.ramp = ramp;
    return stretch;
}

StretchPlace after_way(const SurroundingsStretch& stretch, double metres) {
    Whereabouts antenna;
    antenna.travelled = Metres(metres);
    return place_in(stretch, antenna);
}

TEST(SurroundingsStretch, GrowsOverItsRampsAlongTheWay) {
    const auto stretch = stretch_of(StretchOfWay{Metres(100), Metres(300)}, 20);
    EXPECT_FALSE(after_way(stretch, 99.9).inside);
    EXPECT_TRUE(after_way(stretch, 100).inside);
    EXPECT_DOUBLE_EQ(after_way(stretch, 100).weight, 0);
    EXPECT_DOUBLE_EQ(after_way(stretch, 110).weight, 0.5);
    EXPECT_DOUBLE_EQ(after_way(stretch, 200).weight, 1);
    EXPECT_DOUBLE_EQ(after_way(stretch, 295).weight, 0.25);
    EXPECT_DOUBLE_EQ(after_way(stretch, 110).since, 10);
    EXPECT_DOUBLE_EQ(after_way(stretch, 110).left, 190);
    EXPECT_FALSE(after_way(stretch, 300.1).inside);
}

TEST(SurroundingsStretch, CountsTimeInSecondsAndItsOpeningsInMetres) {
    const auto stretch = stretch_of(StretchOfTime{Seconds(10), Seconds(20)}, 4);
    Whereabouts antenna;
    antenna.elapsed = Seconds(11);
    antenna.speed = MetresPerSecond(5);
    const StretchPlace place = place_in(stretch, antenna);
    EXPECT_DOUBLE_EQ(place.weight, 0.25);
    EXPECT_DOUBLE_EQ(place.since, 5);
    EXPECT_DOUBLE_EQ(place.left, 45);
    EXPECT_FALSE(place_in(stretch_of(StretchOfTime{Seconds(12), Seconds(20)}, 0), antenna).inside);
}

// A square of a hundredth of a degree at the equator, 1112 m to each side, across the meridian of 180°.
std::vector<Geodetic> square_at_the_date_line() {
    std::vector<Geodetic> corners;
    for (const auto& [latitude, longitude] :
         {std::pair{-0.005, 179.995}, {0.005, 179.995}, {0.005, -179.995}, {-0.005, -179.995}})
        corners.push_back(Geodetic::degrees(latitude, longitude, 0));
    return corners;
}

TEST(SurroundingsStretch, HoldsInsideAPolygon) {
    const EarthPolygon square(square_at_the_date_line());
    ASSERT_TRUE(check_polygon(square));
    const auto stretch = stretch_of(StretchOfPlace{{square}}, 100);
    Whereabouts antenna;
    antenna.heading = Angle::degrees(90);
    antenna.place = Geodetic::degrees(0, -179.996, 0);  // 111 m from the eastern edge
    const StretchPlace eastern = place_in(stretch, antenna);
    EXPECT_TRUE(eastern.inside);
    EXPECT_DOUBLE_EQ(eastern.weight, 1);
    EXPECT_NEAR(eastern.left, 111.2, 0.2);
    EXPECT_NEAR(eastern.since, 1000.8, 0.5);
    antenna.place = Geodetic::degrees(0.00482, 180, 0);  // 20 m from the northern edge
    EXPECT_NEAR(place_in(stretch, antenna).weight, 0.2, 0.005);
    antenna.place = Geodetic::degrees(0, 179.9949, 0);
    EXPECT_FALSE(place_in(stretch, antenna).inside);
}

TEST(SurroundingsStretch, HoldsInsideOneOfSeveralPolygonsButNotInTheirHoles) {
    // A hole of a thousandth of a degree to each side in the middle of the square, and another square 2 km to the
    // north.
    std::vector<Geodetic> hole, northern = square_at_the_date_line();
    for (const auto& [latitude, longitude] :
         {std::pair{-0.001, 179.999}, {0.001, 179.999}, {0.001, -179.999}, {-0.001, -179.999}})
        hole.push_back(Geodetic::degrees(latitude, longitude, 0));
    for (Geodetic& corner : northern)
        corner.latitude = corner.latitude + Angle::degrees(0.02);
    const EarthPolygon square(square_at_the_date_line(), {hole});
    const auto stretch = stretch_of(StretchOfPlace{{square, EarthPolygon(northern)}}, 100);
    Whereabouts antenna;
    antenna.heading = Angle::degrees(270);
    const auto at = [&](double latitude, double longitude) {
        antenna.place = Geodetic::degrees(latitude, longitude, 0);
        return place_in(stretch, antenna);
    };
    EXPECT_FALSE(at(0, 180).inside);
    EXPECT_NEAR(at(0, -179.9985).weight, 0.556, 0.005);  // 55.6 m from the hole
    EXPECT_NEAR(at(0, -179.9985).left, 55.6, 0.1);
    EXPECT_TRUE(at(0.02, 180).inside);
    EXPECT_FALSE(at(0.01, 180).inside);
}

TEST(SurroundingsStretch, RefusesPolygonsThatAreNone) {
    auto corners = square_at_the_date_line();
    std::swap(corners[1], corners[2]);
    const auto crossed = check_polygon(EarthPolygon(corners));
    ASSERT_FALSE(crossed);
    EXPECT_EQ(crossed.error().message, "has edges that cross; expected the corners in their order around the polygon");
    const auto flat = check_polygon(EarthPolygon({corners[0], corners[1], corners[0]}));
    ASSERT_FALSE(flat);
    EXPECT_EQ(flat.error().message, "has no area; expected corners of a polygon, around it");
}

}  // namespace
