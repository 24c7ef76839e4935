// Files that recorders, phones, aircraft and converters have written. Rows, first and last times and places are those
// that Python's csv and xml.etree, and gpsbabel 1.8, find in them.
#include <gmock/gmock.h>

#include "base/core/files.hpp"
#include "flown_route.hpp"
#include "support/oracle_table.hpp"
#include "track_reading.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

struct RealRow {
    std::string utc;
    double latitude_deg = 0, longitude_deg = 0;
    std::optional<double> sea_level_m{}, ellipsoidal_m{};
};

struct RealTrack {
    std::string file;
    std::string format;
    std::size_t rows = 0;
    RealRow first, last;
    bool velocities = false;
    std::size_t repeated = 0;  // rows whose time is that of the one before
};

void PrintTo(const RealTrack& track, std::ostream* out) { *out << track.file; }

class RealTracks : public testing::TestWithParam<RealTrack> {};

void expect_row(const Track& track, std::size_t row, const RealRow& expected) {
    EXPECT_EQ(test::utc_of(track, row), expected.utc);
    const Geodetic place = test::place_of(track, row);
    EXPECT_NEAR(place.latitude.deg(), expected.latitude_deg, 6e-8);
    EXPECT_NEAR(place.longitude.deg(), expected.longitude_deg, 6e-8);
    const double height = place.height.above_ellipsoid.value();
    const double geoid = expected.sea_level_m ? 10 : 0;  // of track_of()
    EXPECT_NEAR(height, expected.sea_level_m.value_or(0) + expected.ellipsoidal_m.value_or(0) + geoid, 1e-3);
}

TEST_P(RealTracks, Load) {
    const RealTrack& expected = GetParam();
    SKYLOOP_REQUIRE_SHARED(path, "tracks/" + expected.file);
    const auto text = read_text_file(path);
    ASSERT_TRUE(text.has_value());
    Track track = test::track_of(*text, expected.file);
    EXPECT_EQ(track.format, expected.format);
    ASSERT_EQ(track.points.size(), expected.rows);
    expect_row(track, 0, expected.first);
    expect_row(track, track.points.size() - 1, expected.last);
    EXPECT_EQ(track.points.at(expected.rows / 2).velocity.has_value(), expected.velocities);
    ASSERT_TRUE(clean_track(track, Seconds(10)).has_value());
    EXPECT_EQ(track.points.size(), expected.rows - expected.repeated);
}

INSTANTIATE_TEST_SUITE_P(
    Files, RealTracks,
    testing::Values(
        RealTrack{"around-visnjan-with-car.gpx",
                  "GPX 1.1",
                  104,
                  {"2020-12-18T06:15:50.000Z", 45.273518851, 13.7142099626, 211.15},
                  {"2020-12-18T06:24:24.000Z", 45.2733349521, 13.7139970623, 210.67}},
        RealTrack{"bike~gpx.gpx",
                  "GPX 1.0",
                  1812,
                  {"2013-04-30T19:23:57.000Z", 40.781704467, -73.960900549, 58.2},
                  {"2013-04-30T19:54:11.000Z", 40.781994397, -73.960528979, 58.4}},
        RealTrack{"igc1_baro.gpx",
                  "GPX 1.0",
                  637,
                  {"2004-04-24T02:16:00.000Z", 0, 0, 829.0},
                  {"2004-04-24T04:55:00.000Z", 0, 0, 330.0}},
        RealTrack{"nmea.gpx",
                  "GPX 1.0",
                  154,
                  {"2004-08-07T03:29:08.379Z", 42.530485, -88.121721667, {}, 209.8 - 34.2},
                  {"2004-08-07T03:31:41.370Z", 42.530516667, -88.121758333, {}, 221.4 - 34.2},
                  true},
        RealTrack{"track-with-empty-segment.gpx",
                  "GPX 1.1",
                  9,
                  {"2013-07-06T17:26:26.000Z", 50.7772126, 6.0819695, 191.5999756},
                  {"2013-07-06T17:27:42.000Z", 50.7776715, 6.0827203, 191.5999756}},
        RealTrack{"google_ext.kml",
                  "KML",
                  451,
                  {"2014-05-25T18:30:59.000Z", 30.244696, -97.8586, 274.2},
                  {"2014-05-25T20:13:09.000Z", 30.227217, -97.89716, 320.7}},
        RealTrack{"garmin_g1000.csv",
                  "Garmin G1000",
                  442,
                  {"2014-03-29T22:50:22.000Z", 40.2171326, -111.7177124, {}, 4448.0 * 0.3048},
                  {"2014-03-29T22:57:57.000Z", 40.2122955, -111.7098999, {}, 5414.3 * 0.3048},
                  true},
        RealTrack{"vehicle.csv",
                  "Hazer",
                  2647,
                  {"2020-09-17T15:05:04.000Z", 39.7943158, -105.1533988, {}, 1710.6},
                  {"2020-09-17T15:49:10.000Z", 39.7943156, -105.1533543, {}, 1685.3},
                  true},
        RealTrack{
            "UrbanNav_whampoa.txt",
            "Inertial Explorer",
            1539,
            {"2021-05-21T06:28:44.000Z", 22 + 18.0 / 60 + 5.61075 / 3600, 114 + 11.0 / 60 + 25.11071 / 3600, {}, 2.894},
            {"2021-05-21T06:54:22.000Z", 22 + 18.0 / 60 + 5.61514 / 3600, 114 + 11.0 / 60 + 25.11320 / 3600, {}, 3.029},
            true},
        RealTrack{"20221027-Crosscall-nmea.txt",
                  "NMEA",
                  2628,
                  {"2022-10-27T11:09:51.000Z", 49 + 30.154390 / 60, 5 + 56.935613 / 60, {}, 299.0 + 48},
                  {"2022-10-27T11:57:24.000Z", 49 + 30.246574 / 60, 5 + 56.864853 / 60, {}, 344.0 + 48},
                  true,
                  1},
        RealTrack{"NmeaSampleData.txt.gz",
                  "NMEA",
                  4469,
                  {"2005-09-25T23:52:34.000Z", 39 + 25.9702 / 60, -(119 + 45.9354 / 60), {}, 1378.6 - 22.1},
                  {"2005-09-26T02:56:32.000Z", 39 + 26.5007 / 60, -(119 + 46.1986 / 60), {}, 1366.7 - 22.0},
                  true}));

// Files without times that can be used: flown as routes.
struct RealRoute {
    std::string file, why;
    std::size_t places = 0;
    RealRow first, last;  // without times
};

void PrintTo(const RealRoute& route, std::ostream* out) { *out << route.file; }

void expect_place(const Track& track, std::size_t row, const RealRow& expected) {
    const Geodetic place = test::place_of(track, row);
    EXPECT_NEAR(place.latitude.deg(), expected.latitude_deg, 6e-8);
    EXPECT_NEAR(place.longitude.deg(), expected.longitude_deg, 6e-8);
    const double geoid = expected.sea_level_m ? 10 : 0;  // of track_of()
    EXPECT_NEAR(place.height.above_ellipsoid.value(),
                expected.sea_level_m.value_or(0) + expected.ellipsoidal_m.value_or(0) + geoid, 1e-3);
}

class RealRoutes : public testing::TestWithParam<RealRoute> {};

TEST_P(RealRoutes, LoadAndAreFlown) {
    const RealRoute& expected = GetParam();
    SKYLOOP_REQUIRE_SHARED(path, "tracks/" + expected.file);
    const auto text = read_text_file(path);
    ASSERT_TRUE(text.has_value());
    const Track track = test::track_of(*text, expected.file);
    ASSERT_EQ(track.points.size(), expected.places);
    expect_place(track, 0, expected.first);
    expect_place(track, track.points.size() - 1, expected.last);
    ASSERT_TRUE(track.route.has_value());
    EXPECT_EQ(track.route->why, expected.why);
    for (const VehicleClass vehicle : driven_vehicles) {
        SCOPED_TRACE(traits_of(vehicle).name);
        test::expect_flown_route(track, {vehicle, {}, 2, 0});
    }
}

INSTANTIATE_TEST_SUITE_P(Files, RealRoutes,
                         testing::Values(RealRoute{"Mojstrovka.gpx",
                                                   "183 of 184 times are equal: the file's times are not used",
                                                   184,
                                                   {"", 46.434981, 13.748273, 1614.678},
                                                   {"", 46.435231, 13.748253, 1643.51208}},
                                         RealRoute{"unicode.gpx",
                                                   "no times in it",
                                                   6,
                                                   {"", 45.757933259, 14.294899916, -0.114380},
                                                   {"", 45.765583254, 14.361333288, -0.114380}},
                                         RealRoute{"skydrop.kml",
                                                   "no times in it",
                                                   1329,
                                                   {"", 48.2662716, 8.5155383, 768},
                                                   {"", 48.2666850, 8.5141550, 753}},
                                         RealRoute{"gpx1.0_with_all_fields.gpx",
                                                   "one place alone",
                                                   1,
                                                   {"", 10.1, -20.2, {}, 11.1 + 13},
                                                   {"", 10.1, -20.2, {}, 11.1 + 13}}));

// A log on a table, whose autopilot knows its height alone: 678 records, x and y 0, z at first 0.098385 m.
TEST(RealTracks, LocalPositionsAreLaidOutFromAnOrigin) {
    SKYLOOP_REQUIRE_SHARED(path, "tracks/sample.ulg");
    const auto text = read_text_file(path);
    ASSERT_TRUE(text.has_value());
    EXPECT_THAT(test::refusal_of_track(*text, "sample.ulg"), HasSubstr("expected trajectory.origin = [latitude"));
    Track track = test::track_of(*text, "sample.ulg", Geodetic::degrees(47, 8, 500));
    ASSERT_EQ(track.points.size(), 678u);
    EXPECT_FALSE(track.route.has_value());
    EXPECT_NEAR(test::place_of(track, 0).latitude.deg(), 47, 1e-9);
    EXPECT_NEAR(test::height_of(track, 0), 500 - 0.098385, 1e-5);
    EXPECT_THAT(track.notes,
                testing::Contains(HasSubstr("678 of 678 records of vehicle_local_position say that they are "
                                            "not valid")));
    ASSERT_TRUE(clean_track(track, Seconds(10)).has_value());
    EXPECT_EQ(track.points.size(), 678u);
}

// Counted by pyulog and pymavlink's own readers, as flight_logs_test.cpp has them.
TEST(RealTracks, LogsOfAutopilotsLoad) {
    for (const auto& [file, rows] : {std::pair{"sample_log_small.ulg", 32u}, std::pair{"test.BIN", 24u}}) {
        SKYLOOP_REQUIRE_SHARED(path, std::string("tracks/") + file);
        const auto text = read_text_file(path);
        ASSERT_TRUE(text.has_value());
        EXPECT_EQ(test::track_of(*text, file).points.size(), rows);
    }
}

}  // namespace
}  // namespace skyloop
