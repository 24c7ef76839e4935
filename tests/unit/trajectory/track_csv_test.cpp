// Tables of rows: every column that means something, and every table that is none.
#include "motion/trajectory/track_csv.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "support/flat_geoid.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

Track read_rows(std::string_view text) {
    auto track = read_track_csv(text, "t.csv", nullptr);
    EXPECT_TRUE(track.has_value()) << (track ? "" : track.error().message);
    return track ? std::move(*track) : Track{};
}

std::string refused(std::string_view text) {
    const auto track = read_track_csv(text, "t.csv", nullptr);
    EXPECT_FALSE(track.has_value()) << text;
    if (track) return {};
    EXPECT_EQ(track.error().message.find('\n'), std::string::npos);
    return track.error().message;
}

TEST(TrackCsv, LeavesOutPlacesThatTheRecorderDidNotKnow) {
    const Track track = read_rows(
        "t_s,lat_deg,lon_deg,h_ell_m,speed_mps,course_deg\n"
        "0,0,0,0,0,0\n1,0,0,0,0,0\n2,48,11,500,10,0\n3,48.00009,11,500,10,0\n");
    ASSERT_EQ(track.points.size(), 2U);
    EXPECT_EQ(track.points[0].line, 4U);
    EXPECT_NEAR(track.points[0].velocity->length().value(), 10, 1e-6) << "no climb out of the sea";
    EXPECT_THAT(track.notes, testing::Contains("2 of 4 rows are at latitude 0, longitude 0 (first in line 2) and were "
                                               "left out"));
    EXPECT_EQ(read_rows("t_s,lat_deg,lon_deg,h_ell_m\n0,0,0,5\n1,0,0,5\n").points.size(), 2U) << "all are there";
}

TEST(TrackCsv, DoesNotUseSpeedsInAnotherUnit) {
    std::string kmh = "time,lat,lon,h_ell_m,speed,course\n", mps = kmh;
    for (int i = 0; i < 12; ++i) {
        const double latitude = 48 + i * 10 / 111'200.0;  // 10 m in each second
        kmh += fmt::format("{},{:.7f},11,500,36,0\n", i, latitude);
        mps += fmt::format("{},{:.7f},11,500,10,0\n", i, latitude);
    }
    EXPECT_FALSE(read_rows(kmh).points[5].velocity);
    EXPECT_THAT(read_rows(kmh).notes, testing::Contains(HasSubstr("the speeds are 3.6 times those of the places")));
    EXPECT_TRUE(read_rows(mps).points[5].velocity);
}

TEST(TrackCsv, ReadsTimesOfEveryKind) {
    const Track counted = read_rows("t_s,lat_deg,lon_deg,h_ell_m\n0,47,8,500\n0.25,47,8,500\n");
    EXPECT_FALSE(counted.origin.has_value());
    EXPECT_EQ(counted.points.at(1).time, Nanoseconds(250'000'000));
    const GpsTime noon = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    for (const std::string row : {"utc,lat_deg,lon_deg,h_ell_m\n2024-03-05T13:00:00+01:00,47,8,500",
                                  "utc,lat_deg,lon_deg,h_ell_m\n2024-03-05 08:30:00.000-0330,47,8,500",
                                  "utc;lat_deg;lon_deg;h_ell_m\n2024-03-05T12:00:00Z;47;8;500",
                                  "unix_s lat_deg lon_deg h_ell_m\n1709640000  47 8 500",
                                  "gps_week,tow_s,lat_deg,lon_deg,h_ell_m\n2304,216018,47,8,500",
                                  "unix_ns\tlat_deg\tlon_deg\th_ell_m\n1709640000000000000\t47\t8\t500"}) {
        const Track track = read_rows(row);
        ASSERT_EQ(track.points.size(), 1u);
        EXPECT_EQ(*track.origin + track.points[0].time, noon) << row;
    }
}

TEST(TrackCsv, CountsBesideDatesGiveTheSteps) {
    const Track track = read_rows(
        "t_s,utc,lat_deg,lon_deg,h_ell_m\n100.25,2024-03-05T12:00:00.25Z,47,8,500\n100.5,,47,8,500\n"
        "100.75,2024-03-05T12:00:00.75Z,47,8,500\n");
    const GpsTime noon = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    ASSERT_EQ(track.points.size(), 3u);
    EXPECT_EQ(*track.origin + track.points[1].time, noon + std::chrono::milliseconds(500));
    EXPECT_THAT(track.notes, testing::ElementsAre("times count by t_s; what GPS time that is follows from utc"));
    // Dates that are cut to whole seconds: the latest of them tells most.
    const Track cut = read_rows(
        "t_ms,utc,lat_deg,lon_deg,h_ell_m\n0,2024-03-05T12:00:00Z,47,8,500\n600,2024-03-05T12:00:00Z,47,8,500\n"
        "1200,2024-03-05T12:00:01Z,47,8,500\n");
    EXPECT_EQ(*cut.origin + cut.points[2].time, noon + std::chrono::milliseconds(1200));
    const Track other = read_rows(
        "t_s,unix_s,lat_deg,lon_deg,h_ell_m\n0,1709640000,47,8,500\n10,1709640000,47,8,500\n20,1709640000,47,8,500\n");
    EXPECT_FALSE(other.origin.has_value());
    EXPECT_THAT(other.notes, testing::ElementsAre("times are those of t_s alone: unix_s does not run with it"));
}

TEST(TrackCsv, ReadsPlacesAndVelocities) {
    const Track track = read_rows(
        "# a comment\nt_s,lat_e7,lon_e7,h_ell_ft,speed_kmh,course_deg,climb_mps\n"
        "0,470000000,80000000,1000,36,90,2\n1,nan,80000000,1000,36,90,2\n");
    ASSERT_EQ(track.points.size(), 1u);
    const Geodetic place = to_geodetic(track.points[0].position);
    EXPECT_NEAR(place.latitude.deg(), 47, 1e-9);
    EXPECT_NEAR(place.height.above_ellipsoid.value(), 304.8, 1e-6);
    const Eigen::Vector3d enu = LocalFrame(place).to_enu(*track.points[0].velocity).vector();
    EXPECT_LT((enu - Eigen::Vector3d(10, 0, 2)).norm(), 1e-9);
    EXPECT_THAT(track.notes, testing::ElementsAre("1 of 2 rows have no place and were left out"));
}

TEST(TrackCsv, WithoutAClimbItIsTheSlopeOfTheHeights) {
    for (const std::string columns : {"speed_mps,course_deg", "vn_mps,ve_mps"}) {
        const std::string told = columns == "speed_mps,course_deg" ? "5,90" : "0,5";
        std::string text = "t_s,lat_deg,lon_deg,h_ell_m," + columns + "\n";
        for (int i = 0; i < 4; ++i)
            text += std::to_string(0.5 * i) + ",47,8," + std::to_string(500 + i) + "," + told + "\n";
        const Track track = read_rows(text);
        ASSERT_EQ(track.points.size(), 4u);
        for (const TrackRow& row : track.points) {
            ASSERT_TRUE(row.velocity) << columns;
            const Eigen::Vector3d v = LocalFrame(to_geodetic(row.position)).to_enu(*row.velocity).vector();
            EXPECT_LT((v - Eigen::Vector3d(5, 0, 2)).norm(), 1e-6) << columns;
        }
    }
    const Track track = read_rows(
        "t_s,lat_deg,lon_deg,h_ell_m,speed_mps,course_deg,climb_mps\n0,47,8,500,5,90,\n"
        "1,47,8,501,5,90,1\n");
    EXPECT_FALSE(track.points[0].velocity) << "a climb that a row leaves out is its neighbours' to tell";
    EXPECT_TRUE(track.points[1].velocity);
}

TEST(TrackCsv, SeparatorsBetweenQuotesSeparateNothing) {
    const Track track = read_rows(
        "comment,t_s,\"lat_deg\",lon_deg,h_ell_m\n\"a, b\",0.0,47,8,500\n"
        "\"say \"\"a, b\"\"\",1,47,8,500\n5\" pipe,2,47,8,500\n");
    ASSERT_EQ(track.points.size(), 3u);
    EXPECT_EQ(track.points[1].time, std::chrono::seconds(1));
    EXPECT_EQ(track.points[2].time, std::chrono::seconds(2));
}

TEST(TrackCsv, RefusesRowsWithMoreCellsThanNames) {
    EXPECT_THAT(refused("t_s,lat_deg,lon_deg,h_ell_m\n0,47,0001,8,5000,500,0\n"),
                HasSubstr("t.csv:2: 7 cells under 4 names; expected one for each: numbers with a decimal point"));
    EXPECT_THAT(refused("t_s,lat_deg,lon_deg,h_ell_m\n0,47,8,500,7\n"), HasSubstr("5 cells under 4 names"));
    EXPECT_EQ(read_rows("t_s,lat_deg,lon_deg,h_ell_m\n0,47,8,500,,\n").points.size(), 1u);
}

TEST(TrackCsv, BlanksAndTabsMayBeMixed) {
    const Track track = read_rows("t_s lat_deg lon_deg  h_ell_m\n\t0  47.5\t8.5 \t 500\n");
    EXPECT_NEAR(to_geodetic(track.points.at(0).position).longitude.deg(), 8.5, 1e-9);
}

TEST(TrackCsv, ReadsTheRecordingsOfThisProgram) {
    const Track track = read_rows(
        "time_utc,gps_week,tow_s,true_lat_deg,lat_deg,lon_deg,height_m,vel_north_mps,vel_east_mps,vel_down_mps\n"
        "2024-03-05T12:00:00.000Z,2304,216018.000,47,47,8,500,1,2,3\n");
    ASSERT_EQ(track.points.size(), 1u);
    EXPECT_TRUE(track.points[0].velocity.has_value());
    EXPECT_THAT(track.notes, testing::ElementsAre("columns without a meaning here: true_lat_deg"));
}

TEST(TrackCsv, UnderstandsTheNamesAndUnitsOfOthers) {
    const Track track = read_rows(
        "time(millisecond),latitude,longitude,altitude(feet),Ellipsoidal Height [ft],Speed(mph),course (deg)\n"
        "1000,47,8,0,1000,10,90\n");
    ASSERT_EQ(track.points.size(), 1u);
    EXPECT_EQ(track.points[0].time, Nanoseconds(1'000'000'000));
    EXPECT_NEAR(to_geodetic(track.points[0].position).height.above_ellipsoid.value(), 304.8, 1e-6);
    EXPECT_THAT(track.notes, testing::Contains("altitude(feet) is taken above sea level"));
    // Better names go before others, and the format's own before all.
    const Track named = read_rows("t_s,time(s),lat_deg,lon_deg,alt_m,h_ell_m,flags\n1,7,47,8,1,500,3\n");
    EXPECT_EQ(named.points.at(0).time, Nanoseconds(1'000'000'000));
    EXPECT_THAT(named.notes, testing::Contains("columns without a meaning here: time(s), flags"));
    EXPECT_EQ(read_rows("datetime(utc),lat,lon,h_ell_m\n2024-03-05 12:00:00,47,8,1").points.size(), 1u);
    EXPECT_THAT(refused("time(fortnight),lat,lon,h_ell_m\n1,47,8,1"), HasSubstr("no column says the time"));
}

// Tables of GPSLogger for Android and its like.
TEST(TrackCsv, ATimeWithoutAUnitIsWhatItsFirstRowShows) {
    const std::string names = "latitude,longitude,h_ell_m\n", place = ",47,8,500\n";
    constexpr std::int64_t posix_s = 1709640000;  // 2024-03-05 12:00:00 UTC
    const auto time_of = [&](const std::string& name, const std::string& cell) {
        const Track track = read_rows(name + "," + names + cell + place);
        EXPECT_THAT(track.notes, testing::Contains(HasSubstr(name + " tells no unit, and is taken as")));
        return track.origin.value_or(GpsTime{}) + track.points.at(0).time;
    };
    const GpsTime noon = from_posix(std::chrono::seconds(posix_s), LeapSeconds::announced());
    for (const std::string name : {"time", "Timestamp", "datetime", "date time"}) {
        EXPECT_EQ(time_of(name, "2024-03-05T12:00:00.000Z"), noon);
        EXPECT_EQ(time_of(name, "2024-03-05 14:00:00+02:00"), noon);
    }
    for (const std::string zeros : {"", "000", "000000", "000000000"})
        EXPECT_EQ(time_of("timestamp", std::to_string(posix_s) + zeros), noon);
    EXPECT_EQ(read_rows("time," + names + "2.5" + place).points.at(0).time, Nanoseconds(2'500'000'000));
    EXPECT_THAT(refused("time," + names + "noon" + place),
                HasSubstr("no column says the time, for that of time is in no form or unit that is known; expected"));
}

TEST(TrackCsv, LengthsSpeedsAndCoursesWithoutAUnitAreInMetresAndDegrees) {
    const Track track = read_rows("t_s,lat,lon,height above ellipsoid,bearing,speed,roll\n0,47,8,500,90,2,1\n");
    const auto& point = track.points.at(0);
    EXPECT_NEAR(to_geodetic(point.position).height.above_ellipsoid.value(), 500, 1e-6);
    ASSERT_TRUE(point.velocity.has_value());
    EXPECT_NEAR(point.velocity->vector().norm(), 2, 1e-9);
    EXPECT_THAT(track.notes, testing::Contains("speed tells no unit, and is taken in m/s"));
    EXPECT_THAT(track.notes, testing::Contains("bearing tells no unit, and is taken in degrees"));
    EXPECT_THAT(track.notes, testing::Contains("columns without a meaning here: roll"));
}

TEST(TrackCsv, ReadsTheReceiverOfBetaflightsRecorder) {
    for (const std::string names :
         {"GPS_altitude, GPS_speed, GPS_ground_course", "GPS_altitude (m), GPS_speed (m/s), GPS_ground_course (deg)"}) {
        const auto geoid = test::flat_geoid(10);
        const auto track = read_track_csv(
            "time (us), GPS_numSat, GPS_coord[0], GPS_coord[1], " + names + "\n31000000, 12, 47.5, 8.25, 500, 2, 90\n",
            "bf.gps.csv", &*geoid);
        ASSERT_TRUE(track.has_value()) << track.error().message;
        EXPECT_EQ(track->points.at(0).time, std::chrono::seconds(31));
        const Geodetic place = to_geodetic(track->points[0].position);
        EXPECT_NEAR(place.latitude.deg(), 47.5, 1e-9);
        EXPECT_NEAR(place.longitude.deg(), 8.25, 1e-9);
        EXPECT_NEAR(place.height.above_ellipsoid.value(), 510, 1e-4);
        EXPECT_TRUE(track->points[0].velocity.has_value());
    }
}

TEST(TrackCsv, TakesItsNamesInCapitals) {
    const Track track = read_rows("T_S,LAT_DEG,LON_DEG,H_ELL_M,Fix\n0,47.5,8.5,500,3D\n");
    EXPECT_NEAR(to_geodetic(track.points.at(0).position).height.above_ellipsoid.value(), 500, 1e-6);
    EXPECT_EQ(read_rows("t_s,lat,lng,h_ell_m\n0,47.5,8.5,500\n").points.size(), 1u);
}

TEST(TrackCsv, ReadsLocalMetresQuaternionsAndResets) {
    const std::string rows =
        "t_s,n_m,e_m,d_m,qw,qx,qy,qz,reset\n0,100,200,-30,0.70710678,0,0,0.70710678,4\n"
        "1,100,200,-30,1,0,0,0,4\n2,100,200,-30,1,0,0,0,5\n";
    const Geodetic origin = Geodetic::degrees(47, 8, 500);
    const auto track = read_track_csv(rows, "t.csv", nullptr, origin);
    ASSERT_TRUE(track.has_value()) << track.error().message;
    const Eigen::Vector3d enu = LocalFrame(origin).to_enu(track->points.at(0).position).vector();
    EXPECT_LT((enu - Eigen::Vector3d(200, 100, 30)).norm(), 1e-6);
    EXPECT_NEAR(track->points[0].attitude->yaw().deg(), 90, 1e-5);
    EXPECT_FALSE(track->points[1].jump);
    EXPECT_TRUE(track->points[2].jump);
    EXPECT_THAT(refused(rows), HasSubstr("t.csv:1: local metres; expected trajectory.origin"));
    const auto unlike = read_track_csv("t_s,n_m,e_m,u_m,qw,qx,qy,qz\n0,1,1,1,2,0,0,0\n", "t.csv", nullptr, origin);
    ASSERT_FALSE(unlike.has_value());
    EXPECT_THAT(unlike.error().message, HasSubstr("t.csv:2: the length of the quaternion is 2; expected 1"));
}

TEST(TrackCsv, ATableWithoutTimesIsARoute) {
    const Track track = read_rows("lat_deg,lon_deg,h_ell_m\n47,8,1\n47.1,8,2\n");
    ASSERT_TRUE(track.route.has_value());
    EXPECT_EQ(track.points.size(), 2u);
    EXPECT_THAT(track.route->why, HasSubstr("no column says the time"));
}

TEST(TrackCsv, RefusesWhatIsNoTrackInOneLine) {
    const std::string head = "t_s,lat_deg,lon_deg,h_ell_m\n";
    EXPECT_THAT(refused(""), HasSubstr("t.csv: no line with the names of the columns"));
    EXPECT_THAT(refused("a,b\n1,2"), HasSubstr("t.csv:1: no column says the time"));
    EXPECT_THAT(refused("t_s,b\n1,2"), HasSubstr("t.csv:1: no columns say the place"));
    EXPECT_THAT(refused("t_s,lat_deg,lon_deg\n1,2,3"), HasSubstr("t.csv:1: no column says the height"));
    EXPECT_THAT(refused("t_s,t_ms,lat_deg\n"), HasSubstr("columns t_s and t_ms say the same"));
    EXPECT_THAT(refused("t_s;lat_deg;lon_deg;h_ell_m\n0;47,3977;8,5;500"),
                HasSubstr("t.csv:2: lat_deg is '47,3977'; expected a number with a decimal point"));
    EXPECT_THAT(refused(head + "0,inf,8,500"), HasSubstr("t.csv:2: lat_deg is 'inf'"));
    EXPECT_THAT(refused(head + "0,91,8,500"), HasSubstr("t.csv:2: latitude is 91"));
    EXPECT_THAT(refused(head + "1e300,47,8,500"), HasSubstr("t.csv:2: t_s is '1e300'"));
    EXPECT_THAT(refused("t_s,x_ecef_m,y_ecef_m,z_ecef_m\n0,1,2,3"), HasSubstr("t.csv:2: the place lies 4 m from"));
    EXPECT_THAT(refused("utc,lat_deg,lon_deg,h_ell_m\nyesterday,47,8,5"), HasSubstr("t.csv:2: utc: "));
    EXPECT_THAT(refused("t_s,lat_deg,lon_deg,alt_msl_m\n0,47,8,5"),
                HasSubstr("t.csv:1: alt_msl_m needs the geoid, whose grid is not there"));
    EXPECT_THAT(refused("t_s,lat_deg,lon_deg,h_ell_m,vn_mps\n0,47,8,5,1e9"),
                HasSubstr("vn_mps is '1e9'; expected at most"));
    EXPECT_THAT(refused(std::string(100000, 'x')), HasSubstr("a line of 100000 characters"));
}

}  // namespace
}  // namespace skyloop
