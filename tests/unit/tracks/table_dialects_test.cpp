// Tables of other programs: each is recognised, and its units, axes, datum and clock are taken as its maker says.
#include <gmock/gmock.h>

#include "base/core/files.hpp"
#include "base/geo/local_frame.hpp"
#include "support/oracle_table.hpp"
#include "track_reading.hpp"

namespace skyloop {
namespace {

using test::height_of;
using test::place_of;
using test::refusal_of_track;
using test::track_of;
using test::utc_of;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

Eigen::Vector3d enu_velocity(const Track& track, std::size_t row) {
    EXPECT_TRUE(track.points.at(row).velocity.has_value());
    return LocalFrame(place_of(track, row)).to_enu(*track.points[row].velocity).vector();
}

TEST(TableDialects, ReadMotionOfGpsSdrSimInBothForms) {
    const Track geodetic = track_of("0.0,47.5,8.25,500\n0.1,47.6,8.25,501\n");
    EXPECT_EQ(geodetic.format, "motion of gps-sdr-sim, geodetic");
    EXPECT_FALSE(geodetic.origin.has_value());
    EXPECT_EQ(geodetic.points.at(1).time, std::chrono::milliseconds(100));
    EXPECT_NEAR(height_of(geodetic, 1), 501, 1e-4);  // above the ellipsoid
    const Track ecef = track_of("0.0,4278990.1,635702.3,4672339.5\n0.1,4278990.2,635702.3,4672339.5\n");
    EXPECT_EQ(ecef.format, "motion of gps-sdr-sim, ECEF");
    EXPECT_EQ(ecef.points.at(1).position.vector().x(), 4278990.2);
    EXPECT_THAT(refusal_of_track("0.0,4278990.1,635702.3,4672339.5\n0.1,1,2,3\n"),
                HasSubstr("t.txt:2: the place lies 4 m from the Earth's centre"));
    EXPECT_THAT(refusal_of_track("0.0,47.5,8.25,500\n0.1,47,x\n"),
                HasSubstr("t.txt:2: cell 3 is 'x'; expected a number"));
}

TEST(TableDialects, ReadSolutionsOfRtklib) {
    const std::string head = "% program   : RTKLIB\n% (lat/lon/height=WGS84/ellipsoidal,Q=1:fix)\n";
    const std::string tail = "   1   8   0.01 0.01 0.01 0.0 0.0 0.0   0.00    3.0\n";
    const Track gpst = track_of(head +
                                "%  GPST  latitude(deg) longitude(deg)  height(m)   Q  ns\n"
                                "2024/03/05 12:00:18.000   47.5   8.25   500.0" +
                                tail);
    EXPECT_EQ(utc_of(gpst, 0), "2024-03-05T12:00:00.000Z");
    EXPECT_NEAR(height_of(gpst, 0), 500, 1e-4);
    const Track utc = track_of(head +
                               "%  UTC  latitude(deg) longitude(deg)  height(m)\n"
                               "2024/03/05 12:00:00.000   47.5   8.25   500.0" +
                               tail);
    EXPECT_EQ(utc_of(utc, 0), "2024-03-05T12:00:00.000Z");
    const Track week = track_of(head +
                                "%  GPST  latitude(deg) longitude(deg)  height(m)\n"
                                "2304 216018.000   47.5   8.25   500.0" +
                                tail);
    EXPECT_EQ(utc_of(week, 0), "2024-03-05T12:00:00.000Z");
    const Track sexagesimal = track_of(head +
                                       "%  GPST  latitude(d'\") longitude(d'\")  height(m)\n"
                                       "2304,216018.0,-0,30,00.0,8,15,00.0,500.0,1,8,0,0,0,0,0,0,0,0\n");
    EXPECT_NEAR(place_of(sexagesimal, 0).latitude.deg(), -0.5, 1e-12);
    const Track ecef = track_of(head +
                                "%  GPST  x-ecef(m) y-ecef(m) z-ecef(m)\n"
                                "2304 216018.000 4278990.1 635702.3 4672339.5" +
                                tail);
    EXPECT_NEAR(ecef.points.at(0).position.vector().z(), 4672339.5, 1e-6);
    const Track moving = track_of(head +
                                  "%  GPST  latitude(deg) longitude(deg)  height(m)\n2304 216018.000 47.5 8.25 500 1 8 "
                                  "0 0 0 0 0 0 0 0 1.5 2.5 -0.5 0 0 0 0 0 0\n");
    EXPECT_LT((enu_velocity(moving, 0) - Eigen::Vector3d(2.5, 1.5, -0.5)).norm(), 1e-9);
    const Track above_sea = track_of(
        "% (lat/lon/height=WGS84/geodetic)\n%  GPST  latitude(deg) longitude(deg)  height(m)\n"
        "2304 216018.000   47.5   8.25   500.0" +
        tail);
    EXPECT_NEAR(height_of(above_sea, 0), 510, 1e-4);
    EXPECT_THAT(refusal_of_track(head + "%  GPST  e-baseline(m) n-baseline(m) u-baseline(m)\n2304 1 1 1 1 1 1\n"),
                HasSubstr("a solution of baselines"));
    EXPECT_THAT(refusal_of_track(head + "%  GPST  latitude(deg) longitude(deg)  height(m)\nyesterday 1 2 3 4 5\n"),
                HasSubstr("t.txt:4: the time is 'yesterday"));
}

// As receivers and tools write them that leave the header out.
TEST(TableDialects, ReadSolutionsOfRtklibWithoutAHeader) {
    const std::string tail = "   1  12   0.0270   0.0193   0.0440  -0.0115  -0.0122  -0.0107   0.79    3.9\n";
    for (const std::string time : {"2024/03/05 12:00:18.000", "2304 216018.000"}) {
        const Track track = track_of(time + "   47.500000000    8.250000000   500.0000" + tail, "t.LLH");
        EXPECT_EQ(track.format, "RTKLIB solution");
        EXPECT_EQ(utc_of(track, 0), "2024-03-05T12:00:00.000Z");
        EXPECT_NEAR(height_of(track, 0), 500, 1e-4);
        EXPECT_THAT(track.notes, Contains("no header: taken as GPST, degrees, metres above the ellipsoid"));
    }
}

TEST(TableDialects, ReadTumWithAnOrigin) {
    const Geodetic origin = Geodetic::degrees(47.5, 8.25, 500);
    // Nose to the north: forward is ENU's y, a quarter turn about up; w last.
    const std::string rows =
        "# timestamp tx ty tz qx qy qz qw\n1709640000.123456 100 200 30 0 0 0.70710678 0.70710678\n";
    const Track track = track_of(rows, "t.txt", origin);
    EXPECT_EQ(track.format, "TUM");
    EXPECT_EQ(utc_of(track, 0), "2024-03-05T12:00:00.123Z");
    const Eigen::Vector3d enu = LocalFrame(origin).to_enu(track.points.at(0).position).vector();
    EXPECT_LT((enu - Eigen::Vector3d(100, 200, 30)).norm(), 1e-6);
    ASSERT_TRUE(track.points[0].attitude.has_value());
    EXPECT_NEAR(track.points[0].attitude->yaw().deg(), 0, 1e-4);
    EXPECT_NEAR(track.points[0].attitude->roll().deg(), 0, 1e-4);
    // Pitched up by 10 degrees, nose to the east: a turn about left, which is north, by −10.
    const Track up = track_of("0 0 0 0 0 -0.08715574 0 0.99619470\n", "t.txt", origin);
    EXPECT_FALSE(up.origin.has_value());
    EXPECT_NEAR(up.points.at(0).attitude->yaw().deg(), 90, 1e-4);
    EXPECT_NEAR(up.points.at(0).attitude->pitch().deg(), 10, 1e-4);
    EXPECT_THAT(refusal_of_track(rows), HasSubstr("local metres (time, x, y, z and a quaternion); expected "
                                                  "trajectory.origin"));
}

TEST(TableDialects, ReadEurocToTheNanosecond) {
    const Geodetic origin = Geodetic::degrees(47.5, 8.25, 500);
    const std::string rows =
        "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w []\n1709640000123456789,1,2,3,1\n";
    const Track track = track_of(rows, "t.csv", origin);
    EXPECT_EQ(track.points.at(0).time.count() % 1'000'000'000, 123'456'789);
    EXPECT_EQ(utc_of(track, 0), "2024-03-05T12:00:00.123Z");
    EXPECT_THAT(refusal_of_track(rows), HasSubstr("local metres (EuRoC)"));
}

TEST(TableDialects, TellEurocsGroundTruthFromItsSensors) {
    const Geodetic origin = Geodetic::degrees(47.5, 8.25, 500);
    // state_groundtruth_estimate0/data.csv
    const Track truth = track_of(
        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n"
        "1709640000123456789,1,2,3,1,0,0,0\n",
        "data.csv", origin);
    EXPECT_EQ(truth.format, "EuRoC");
    EXPECT_EQ(utc_of(truth, 0), "2024-03-05T12:00:00.123Z");
    const Eigen::Vector3d enu = LocalFrame(origin).to_enu(truth.points.at(0).position).vector();
    EXPECT_LT((enu - Eigen::Vector3d(1, 2, 3)).norm(), 1e-6);
    // imu0/data.csv
    const auto sensor =
        read_track(test::bytes_of("#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1]"
                                  "\n1709640000123456789,0.1,0.2,0.3\n"),
                   "data.csv", {nullptr, origin});
    ASSERT_FALSE(sensor.has_value());
    EXPECT_THAT(sensor.error().message, HasSubstr("no places (EuRoC, '#timestamp [ns],w_RS_S_x"));
}

TEST(TableDialects, ReadOxtsOfKitti) {
    std::string row = "47.5 8.25 500 0.1 0.2 1.5707963267948966 3 4 5 0 -1";
    for (int i = 11; i < 30; ++i)
        row += " 0";
    const Track track = track_of(row + "\n" + row + "\n");
    EXPECT_EQ(track.points.at(1).time, std::chrono::milliseconds(100));
    EXPECT_LT((enu_velocity(track, 0) - Eigen::Vector3d(4, 3, -1)).norm(), 1e-9);
    EXPECT_NEAR(track.points[0].attitude->yaw().deg(), 0, 1e-9);
    EXPECT_NEAR(track.points[0].attitude->roll().rad(), 0.1, 1e-9);
    EXPECT_NEAR(track.points[0].attitude->pitch().rad(), -0.2, 1e-9);
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("taken at 10 Hz")));
}

TEST(TableDialects, ReadInertialExplorerOfUrbanNav) {
    // Nose to the east; 0.5 m/s to the right, 10 forward, 0.25 up.
    const Track track = track_of(
        "1709640000.00 2304.0 216018.00  47 30 00.0  -8 15 00.0  500.0  0.5 10.0 0.25  0 0 0  0.0 0.0 90.0  1\n");
    EXPECT_EQ(track.format, "Inertial Explorer");
    EXPECT_EQ(utc_of(track, 0), "2024-03-05T12:00:00.000Z");
    EXPECT_NEAR(place_of(track, 0).longitude.deg(), -8.25, 1e-9);
    EXPECT_NEAR(height_of(track, 0), 500, 1e-4);
    EXPECT_LT((enu_velocity(track, 0) - Eigen::Vector3d(10, -0.5, 0.25)).norm(), 1e-9);
    EXPECT_NEAR(track.points[0].attitude->yaw().deg(), 90, 1e-9);
}

TEST(TableDialects, ReadUnicsvOfGpsbabel) {
    const Track track = track_of(
        "No,Latitude,Longitude,Altitude,Speed,Course,Date,Time\n"
        "1,47.5,8.25,500.0,10.00,90.0,2024/03/05,12:00:00\n"
        "2,47.5,8.2501,500.0,10.00,90.0,2024/03/05,12:00:00.750\n3,,,,,,2024/03/05,12:00:02\n");
    ASSERT_EQ(track.points.size(), 2u);
    EXPECT_EQ(utc_of(track, 1), "2024-03-05T12:00:00.750Z");
    EXPECT_NEAR(height_of(track, 0), 510, 1e-4);
    EXPECT_LT((enu_velocity(track, 0) - Eigen::Vector3d(10, 0, 0)).norm(), 1e-6);
    EXPECT_THAT(refusal_of_track("Latitude;Longitude;Altitude;Date;Time\n47,5;8,25;500;2024/03/05;12:00:00\n"),
                HasSubstr("t.txt:2: latitude is '47,5'; expected a number with a decimal point"));
}

// The names of unicsv with units that others write behind them.
TEST(TableDialects, TablesLikeUnicsvKeepTheirUnitsAndTellWhatIsNotRead) {
    const Track track = track_of(
        "Date,Time,Latitude,Longitude,Altitude (ft),Speed (km/h),Course,Battery (%)\n"
        "2024-03-05,12:00:00,47.5,8.25,1000,36,90,80\n2024-03-05,12:00:01,47.5,8.25,1000,36,90,80\n");
    EXPECT_NEAR(height_of(track, 0), 314.8, 1e-4);
    EXPECT_LT((enu_velocity(track, 0) - Eigen::Vector3d(10, 0, 0)).norm(), 1e-6);
    EXPECT_THAT(track.notes, ElementsAre("columns without a meaning here: battery (%)"));
    EXPECT_THAT(refusal_of_track("Date,Time,Latitude,Longitude,Alt (furlong)\n2024-03-05,12:00:00,47,8,500\n"),
                HasSubstr("the column 'alt (furlong)' is not known; expected Altitude"));
}

// Loggers write degrees without a sign and the hemisphere in a column of its own, or behind the number.
TEST(TableDialects, LettersOfTheHemisphereTurnTheSign) {
    const Track track = track_of(
        "INDEX,DATE,TIME,LATITUDE,N/S,LONGITUDE,E/W,ALTITUDE\n1,2024/03/05,12:00:00,33.9,S,18.4,W,100\n"
        "2,2024/03/05,12:00:01,33.8,N,18.3,E,100\n");
    ASSERT_EQ(track.points.size(), 2u);
    EXPECT_NEAR(place_of(track, 0).latitude.deg(), -33.9, 1e-9);
    EXPECT_NEAR(place_of(track, 0).longitude.deg(), -18.4, 1e-9);
    EXPECT_NEAR(place_of(track, 1).latitude.deg(), 33.8, 1e-9);
    EXPECT_THAT(track.notes,
                ElementsAre("n/s is taken as the hemisphere of latitude", "e/w is taken as the hemisphere of longitude",
                            "columns without a meaning here: index"));
    EXPECT_THAT(refusal_of_track("Date,Time,Latitude,N/S,Longitude,E/W\n2024/03/05,12:00:00,33.9,X,18.4,W\n"),
                HasSubstr("t.txt:2: n/s is 'X'; expected N or S"));
    EXPECT_THAT(refusal_of_track("Date,Time,Latitude,Longitude,Altitude,side\n2024/03/05,12:00:00,33.9,18.4,100,S\n"),
                HasSubstr("t.txt: the column 'side' has 'S' (first in line 2), which may be a hemisphere"));
    for (const std::string place : {"33.9S,18.4W", "S 33.9,W 18.4",
                                    "33\xC2\xB0"
                                    "54'0\"S,18\xC2\xB0"
                                    "24'0\"W",
                                    "-33 54,-18 24 0"}) {
        const Track written =
            track_of("Date,Time,Latitude,Longitude,Altitude\n2024-03-05,12:00:00," + place + ",500\n");
        EXPECT_NEAR(place_of(written, 0).latitude.deg(), -33.9, 1e-9) << place;
        EXPECT_NEAR(place_of(written, 0).longitude.deg(), -18.4, 1e-9) << place;
    }
    EXPECT_THAT(refusal_of_track("Date,Time,Latitude,Longitude\n2024-03-05,12:00:00,33.9E,18.4\n"),
                HasSubstr("t.txt:2: latitude is '33.9E'; expected a number"));
}

TEST(TableDialects, LettersOfTheHemisphereTurnTheSignInOtherTables) {
    const Track hazer = track_of(
        "NAM, NUM, FIX, TIM, LAT, LATDIR, LON, LONDIR, MSL\n\"neon\", 1, 3, 1709640000.25, 33.9, S, 18.4W, , 500.0\n");
    EXPECT_NEAR(place_of(hazer, 0).latitude.deg(), -33.9, 1e-9);
    EXPECT_NEAR(place_of(hazer, 0).longitude.deg(), -18.4, 1e-9);
    const Track phone =
        track_of("# Fix,Provider,Latitude,Longitude,Altitude,UnixTimeMillis\nFix,gps,33.9S,18.4W,548,1709640000000\n");
    EXPECT_NEAR(place_of(phone, 0).latitude.deg(), -33.9, 1e-9);
    const Track own =
        track_of("t_s,lat_deg,lat_dir,lon_deg,lon_dir,h_ell_m\n0,33.9,S,18.4,W,500\n1,33.9,S,18.4,W,500\n", "t.csv");
    EXPECT_NEAR(place_of(own, 0).latitude.deg(), -33.9, 1e-9);
    EXPECT_NEAR(place_of(own, 0).longitude.deg(), -18.4, 1e-9);
    const Track other = track_of(
        "time;Latitude;NS;Longitude;EW;elevation\n2024-03-05 12:00:00;33\xC2\xB0"
        "54.0';S;18 24 0;W;500\n",
        "t.csv");
    EXPECT_NEAR(place_of(other, 0).latitude.deg(), -33.9, 1e-9);
    EXPECT_NEAR(place_of(other, 0).longitude.deg(), -18.4, 1e-9);
    EXPECT_THAT(refusal_of_track("t_s,lat_deg,lon_deg,h_ell_m,side\n0,33.9,18.4,500,W\n", "t.csv"),
                HasSubstr("t.csv: the column 'side' has 'W' (first in line 2)"));
    EXPECT_THAT(refusal_of_track("t_s,lat_e7,lon_e7,h_ell_m\n0,339000000S,184000000,500\n", "t.csv"),
                HasSubstr("t.csv:2: lat_e7 is '339000000S'; expected a number"));
}

TEST(TableDialects, LettersOfTheHemisphereTurnTheSignInXml) {
    const Track gpx = track_of(
        "<gpx><trk><trkseg><trkpt lat=\"33.9S\" lon=\"W 18 "
        "24\"><time>2024-03-05T12:00:00Z</time></trkpt></trkseg></trk></gpx>",
        "t.gpx");
    EXPECT_NEAR(place_of(gpx, 0).latitude.deg(), -33.9, 1e-9);
    EXPECT_NEAR(place_of(gpx, 0).longitude.deg(), -18.4, 1e-9);
    const Track kml = track_of(
        "<kml><Placemark><LineString><coordinates>18.4W,33.9S,100 "
        "18.5W,33.9S,100</coordinates></LineString></Placemark></kml>",
        "t.kml");
    EXPECT_NEAR(place_of(kml, 0).latitude.deg(), -33.9, 1e-9);
    EXPECT_NEAR(place_of(kml, 0).longitude.deg(), -18.4, 1e-9);
}

// A logger's file near Cape Town.
TEST(TableDialects, ALoggersFileLiesInItsHemisphere) {
    SKYLOOP_REQUIRE_SHARED(path, "reports/b01_hemisphere_unicsv.csv");
    const auto text = read_text_file(path);
    ASSERT_TRUE(text);
    const Track track = track_of(*text, "b01.csv");
    EXPECT_NEAR(place_of(track, 0).latitude.deg(), -33.9, 1e-9);
    EXPECT_NEAR(place_of(track, 0).longitude.deg(), -18.4, 1e-9);
}

// As gpsbabel writes names and comments that hold commas and quotes.
TEST(TableDialects, ReadCellsInQuotesAsOne) {
    const Track track = track_of(
        "No,Latitude,Longitude,Name,Altitude,Description,Date,Time\n"
        "1,47.500000,8.250000,\"Alm, 12\",500.0,\"a \"\"b\"\", 7\",2024/03/05,12:00:00\n");
    ASSERT_EQ(track.points.size(), 1u);
    EXPECT_NEAR(height_of(track, 0), 510, 1e-4);
    EXPECT_EQ(utc_of(track, 0), "2024-03-05T12:00:00.000Z");
    EXPECT_THAT(refusal_of_track("Latitude,Longitude,Altitude,Date,Time\n47,5,8,25,500,2024/03/05,12:00:00\n"),
                HasSubstr("t.txt:2: 7 cells under 5 names"));
}

TEST(TableDialects, ReadTheReceiversFixesOfGnssLogger) {
    const std::string head =
        "# Header\n# Fix,Provider,LatitudeDegrees,LongitudeDegrees,AltitudeMeters,SpeedMps,AccuracyMeters,"
        "BearingDegrees,UnixTimeMillis\nRaw,1,2,3\n";
    const Track track = track_of(head +
                                 "Fix,GPS,47.5,8.25,548.0,10.0,3.0,90.0,1709640000000\n"
                                 "Fix,FLP,47.6,8.25,548.0,10.0,3.0,90.0,1709640000500\n"
                                 "NMEA,$GPGGA\nFix,GPS,47.5,8.2501,548.0,,3.0,,1709640001250\n");
    ASSERT_EQ(track.points.size(), 2u);
    EXPECT_EQ(utc_of(track, 1), "2024-03-05T12:00:01.250Z");
    EXPECT_NEAR(height_of(track, 0), 548, 1e-4);
    EXPECT_THAT(track.notes, Contains("1 fixes of the provider flp are not part of the path"));
    const Track old = track_of(
        "# Fix,Provider,Latitude,Longitude,Altitude,Speed,Accuracy,(UTC)TimeInMs\n"
        "Fix,gps,47.5,8.25,548.0,10.0,3.0,1709640000000\n");
    EXPECT_EQ(utc_of(old, 0), "2024-03-05T12:00:00.000Z");
}

TEST(TableDialects, ReadTheLogOfAGarminG1000) {
    const std::string text =
        "#airframe_info, log_version=\"1.00\"\n#yyy-mm-dd, hh:mm:ss\n  Lcl Date, Lcl Time, UTCOfst,     Latitude,    "
        "Longitude,  AltMSL, GndSpd, Pitch,  Roll,   HDG,   TRK, AltGPS, MagVar, VSpdG\n"
        "2024-03-05, 13:00:00,  +01:00,   47.5000000, 8.2500000,  1500.0,  100.0,  2.0, -5.0, 350.0, 80.0, 1640.42, "
        "10.0, "
        "600.0\n2024-03-05, 13:00:01,  +01:00,  ,  ,  1500.0,  , , , , , , ,\n";
    const Track track = track_of(text);
    ASSERT_EQ(track.points.size(), 1u);
    EXPECT_EQ(utc_of(track, 0), "2024-03-05T12:00:00.000Z");
    EXPECT_NEAR(height_of(track, 0), 500, 1e-2);
    EXPECT_LT((enu_velocity(track, 0) - Eigen::Vector3d(51.4444, 0, 3.048)).norm(), 1e-3);  // true course 90
    EXPECT_NEAR(track.points[0].attitude->yaw().deg(), 0, 1e-9);
    EXPECT_NEAR(track.points[0].attitude->roll().deg(), -5, 1e-9);
    EXPECT_THAT(track.notes, Contains(HasSubstr("1 of 2 rows have no place")));
}

TEST(TableDialects, ReadTheTableOfHazer) {
    const Track track = track_of(
        "NAM, NUM, FIX, SYS, SAT, CLK, TIM, LAT, LON, HAC, MSL, GEO, VAC, SOG, COG\n"
        "\"neon\", 1, 3, 0, 11, 1709640001.1, 1709640000.250000000, 47.5, 8.25, 0., 500.0, 548.0, 0., 19.43844, 90.\n"
        "\"neon\", 2, 0, 0, 11, 1709640002.1, 1709640001.000000000, 0.0, 0.0, 0., 0.0, 0.0, 0., 0.0, 0.\n");
    ASSERT_EQ(track.points.size(), 1u);
    EXPECT_EQ(utc_of(track, 0), "2024-03-05T12:00:00.250Z");
    EXPECT_NEAR(height_of(track, 0), 548, 1e-4);
    EXPECT_LT((enu_velocity(track, 0) - Eigen::Vector3d(10, 0, 0)).norm(), 1e-4);
}

TEST(TableDialects, LeaveTheNativeTableAlone) {
    const Track track = track_of("t_s,lat_deg,lon_deg,h_ell_m\n0,47.5,8.25,500\n1,47.5,8.25,500\n", "t.csv");
    EXPECT_EQ(track.points.size(), 2u);
    EXPECT_THAT(refusal_of_track(""), HasSubstr("no line with the names of the columns"));
}

}  // namespace
}  // namespace skyloop
