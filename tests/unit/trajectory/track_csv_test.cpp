// Tables of rows: every column that means something, and every table that is none.
#include "skyloop/trajectory/track_csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "skyloop/geo/local_frame.hpp"
#include "skyloop/time/utc_time.hpp"

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

TEST(TrackCsv, ReadsTimesOfEveryKind) {
    const Track counted = read_rows("t_s,lat_deg,lon_deg,h_ell_m\n0,47,8,500\n0.25,47,8,500\n");
    EXPECT_FALSE(counted.origin.has_value());
    EXPECT_EQ(counted.points.at(1).time, Nanoseconds(250'000'000));
    const GpsTime noon = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    for (const std::string row : {"utc;lat_deg;lon_deg;h_ell_m\n2024-03-05T12:00:00Z;47;8;500",
                                  "unix_s lat_deg lon_deg h_ell_m\n1709640000  47 8 500",
                                  "gps_week,tow_s,lat_deg,lon_deg,h_ell_m\n2304,216018,47,8,500",
                                  "unix_ns\tlat_deg\tlon_deg\th_ell_m\n1709640000000000000\t47\t8\t500"}) {
        const Track track = read_rows(row);
        ASSERT_EQ(track.points.size(), 1u);
        EXPECT_EQ(*track.origin + track.points[0].time, noon) << row;
    }
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

TEST(TrackCsv, ReadsTheRecordingsOfThisProgram) {
    const Track track = read_rows(
        "time_utc,gps_week,tow_s,true_lat_deg,lat_deg,lon_deg,height_m,vel_north_mps,vel_east_mps,vel_down_mps\n"
        "2024-03-05T12:00:00.000Z,2304,216018.000,47,47,8,500,1,2,3\n");
    ASSERT_EQ(track.points.size(), 1u);
    EXPECT_TRUE(track.points[0].velocity.has_value());
    EXPECT_THAT(track.notes, testing::ElementsAre("columns without a meaning here: true_lat_deg"));
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
