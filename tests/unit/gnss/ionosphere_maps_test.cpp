#include "world/gnss/shell_ionosphere.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace skyloop {
namespace {

const GpsTime midnight = to_gps_time(2100, 0.0);

PiercePoint pierced(double latitude, double longitude) { return {Angle::degrees(latitude), Angle::degrees(longitude)}; }

// Two maps an hour apart over the whole globe in steps of 30° by 60°; the meridian at 180° is not repeated.
IonosphereMaps open_globe() {
    IonosphereMaps maps;
    maps.latitude = {Angle::degrees(60), Angle::degrees(-30), 5};
    maps.longitude = {Angle::degrees(-180), Angle::degrees(60), 6};
    for (int hour = 0; hour < 2; ++hour) {
        IonosphereMap map{midnight + std::chrono::hours(hour), {}};
        for (int i = 0; i < 5; ++i)
            for (int j = 0; j < 6; ++j)
                map.content_tecu.push_back(10 * i + j);
        maps.maps.push_back(map);
    }
    return maps;
}

TEST(MapContent, IsBilinearAndClosesAroundTheGlobe) {
    const IonosphereMaps maps = open_globe();
    const auto at = [&](double latitude, double longitude) {
        return map_content(maps, maps.maps.front(), pierced(latitude, longitude));
    };
    EXPECT_NEAR(at(60, -180)->value(), 0, 1e-9);
    EXPECT_NEAR(at(45, -90)->value(), 6.5, 1e-9);
    EXPECT_NEAR(at(0, 150)->value(), 22.5, 1e-9);  // between columns 5 and 0
    EXPECT_NEAR(at(0, 180)->value(), 20, 1e-9);
    EXPECT_NEAR(at(90, 0)->value(), 3, 1e-9);  // the last parallel holds for one step
    EXPECT_EQ(at(90, 0)->value(), at(60, 0)->value());
}

TEST(MapContent, ARegionEndsAtItsEdges) {
    IonosphereMaps maps = open_globe();
    maps.longitude = {Angle::degrees(0), Angle::degrees(2), 6};
    maps.latitude = {Angle::degrees(50), Angle::degrees(-2), 5};
    EXPECT_TRUE(map_content(maps, maps.maps[0], pierced(46, 10)));
    EXPECT_FALSE(map_content(maps, maps.maps[0], pierced(46, 11)));
    EXPECT_FALSE(map_content(maps, maps.maps[0], pierced(46, -1)));
    EXPECT_FALSE(map_content(maps, maps.maps[0], pierced(53, 5)));
}

TEST(MapContent, AMissingValueIsNoContentWhereItCounts) {
    IonosphereMaps maps = open_globe();
    maps.maps[0].content_tecu[0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(map_content(maps, maps.maps[0], pierced(50, -170)));
    EXPECT_TRUE(map_content(maps, maps.maps[0], pierced(50, -60)));
}

TEST(VerticalContent, TurnsWithTheSun) {
    const IonosphereMaps maps = open_globe();
    // Half an hour after the first map the Sun stands 7.5° further west.
    const auto value = vertical_content(maps, pierced(0, -100), midnight + std::chrono::minutes(30));
    EXPECT_NEAR(value->value(), 20 + 80.0 / 60, 1e-9);
    EXPECT_NEAR(vertical_content(maps, pierced(0, -60), midnight + std::chrono::hours(1))->value(), 22, 1e-9);
}

TEST(TurnedContent, GoesOnWithTheSunPastItsInstant) {
    const IonosphereMaps maps = open_globe();
    const IonosphereMap& last = maps.maps.back();
    // Four hours, and four days and four hours, are 60° of the Sun: a column of the grid.
    for (const int hours : {4, 100})
        EXPECT_NEAR(turned_content(maps, last, pierced(0, -60), last.time + std::chrono::hours(hours))->value(), 23,
                    1e-6);
    EXPECT_NEAR(turned_content(maps, last, pierced(0, -60), last.time - std::chrono::hours(4))->value(), 21, 1e-6);
    EXPECT_EQ(turned_content(maps, last, pierced(0, -60), last.time),
              vertical_content(maps, pierced(0, -60), last.time));
}

TEST(HeldContent, IsThatOfTheLastMapAfterIt) {
    const IonosphereMaps maps = open_globe();
    const GpsTime between = midnight + std::chrono::minutes(30), after = maps.maps.back().time + std::chrono::hours(4);
    EXPECT_EQ(held_content(maps, pierced(0, -100), between), vertical_content(maps, pierced(0, -100), between));
    EXPECT_NEAR(held_content(maps, pierced(0, -60), after)->value(), 23, 1e-6);
    EXPECT_FALSE(held_content({}, pierced(0, -60), after));
}

TEST(VerticalContent, HasNothingOutsideItsTime) {
    const IonosphereMaps maps = open_globe();
    EXPECT_FALSE(vertical_content(maps, pierced(0, 0), midnight - std::chrono::seconds(1)));
    EXPECT_FALSE(vertical_content(maps, pierced(0, 0), midnight + std::chrono::seconds(3601)));
    EXPECT_FALSE(vertical_content({}, pierced(0, 0), midnight));
}

}  // namespace
}  // namespace skyloop
