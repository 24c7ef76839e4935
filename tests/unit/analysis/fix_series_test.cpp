#include "study/analysis/fix_series.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "base/time/utc_time.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string fixes_header =
    "time_utc,gps_week,tow_s,true_lat_deg,true_lon_deg,true_height_m,lat_deg,lon_deg,height_m,east_error_m,"
    "north_error_m,up_error_m,vel_north_mps,vel_east_mps,vel_down_mps,speed_mps,course_deg,fix_type,satellites_used,"
    "satellites_visible,gdop,pdop,hdop,vdop,tdop,h_acc_m,v_acc_m\n";
const std::string fix_row =
    "2010-07-01T12:00:00.000Z,1590,388815.000,46.4775,30.7326,77.0,46.47751,30.73262,78.5,1.5,1.1,1.5,0,0,0,0,0,3d,8,"
    "11,"
    "2.1,1.8,1.0,1.5,1.0,2.5,3.5\n";
const std::string no_fix_row =
    "2010-07-01T12:00:01.000Z,1590,388816.000,46.4775,30.7326,77.0,,,,,,,,,,,,none,0,11,,,,,,,\n";

// The sentence with its checksum and line end.
std::string nmea(const std::string& payload) {
    unsigned sum = 0;
    for (const char c : payload)
        sum ^= static_cast<unsigned char>(c);
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02X", sum & 0xffu);
    return "$" + payload + "*" + digits + "\r\n";
}

std::string message_of(const std::string& text) {
    const auto series = parse_fix_series(text, "a.csv");
    return series ? "no error" : series.error().message;
}

TEST(FixSeries, reads_our_fixes_table_with_truth_and_missing_fixes) {
    const auto series = parse_fix_series(fixes_header + fix_row + no_fix_row, "fixes.csv");
    ASSERT_TRUE(series) << series.error().message;
    ASSERT_EQ(series->samples.size(), 2u);
    EXPECT_EQ(series->fixes(), 1u);
    EXPECT_TRUE(series->dated);
    EXPECT_EQ(series->interval, Seconds(1));
    const FixSample& first = series->samples[0];
    EXPECT_TRUE(first.has_fix);
    EXPECT_NEAR(first.position.latitude.deg(), 46.47751, 1e-12);
    EXPECT_NEAR(first.position.longitude.deg(), 30.73262, 1e-12);
    EXPECT_EQ(first.position.height.above_ellipsoid.value(), 78.5);
    ASSERT_TRUE(first.truth);
    EXPECT_NEAR(first.truth->latitude.deg(), 46.4775, 1e-12);
    EXPECT_EQ(first.time, to_gps_time(1590, 388815.0));
    EXPECT_EQ(first.satellites_used, 8);
    EXPECT_FALSE(series->samples[1].has_fix);
    EXPECT_TRUE(series->samples[1].truth);
}

TEST(FixSeries, reads_weeks_of_the_next_centuries) {
    std::string row = fix_row;
    row.replace(row.find(",1590,"), 6, ",11450,");
    const auto series = parse_fix_series(fixes_header + row, "fixes.csv");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->samples[0].time, to_gps_time(11450, 388815.0));
    row.replace(row.find(",11450,"), 7, ",15250,");
    EXPECT_THAT(message_of(fixes_header + row), HasSubstr("GPS week 15250"));
}

TEST(FixSeries, finds_columns_by_name_in_any_order_and_style) {
    const auto series = parse_fix_series(
        "\xEF\xBB\xBF\"Speed\";\"Altitude (m)\"; Longitude ;LATITUDE;time\n"
        "0;12.5;-121.9;36.97;2013-02-14 02:43:12\n0;12.6;238.1;36.98;2013-02-14 02:43:14\n",
        "b.csv");
    ASSERT_TRUE(series) << series.error().message;
    ASSERT_EQ(series->samples.size(), 2u);
    EXPECT_NEAR(series->samples[0].position.latitude.deg(), 36.97, 1e-12);
    EXPECT_NEAR(series->samples[0].position.longitude.deg(), -121.9, 1e-12);
    EXPECT_NEAR(series->samples[1].position.longitude.deg(), -121.9, 1e-9);
    EXPECT_EQ(series->samples[1].position.height.above_ellipsoid.value(), 12.6);
    EXPECT_FALSE(series->samples[0].truth);
    EXPECT_EQ(series->interval, Seconds(2));
}

TEST(FixSeries, reads_rows_of_numbers_as_latitude_longitude_height) {
    for (const char* text : {"36.97,-121.9,10.5\r\n36.98,-121.8,11.5", "36.97 -121.9  10.5\n\n36.98 -121.8 11.5\n",
                             "# log\n36.97\t-121.9\t10.5\n36.98\t-121.8\t11.5\n"}) {
        const auto series = parse_fix_series(text, "c.dlm");
        ASSERT_TRUE(series) << series.error().message;
        ASSERT_EQ(series->samples.size(), 2u);
        EXPECT_NEAR(series->samples[1].position.longitude.deg(), -121.8, 1e-12);
        EXPECT_EQ(series->samples[1].position.height.above_ellipsoid.value(), 11.5);
        EXPECT_FALSE(series->interval);
        EXPECT_FALSE(series->samples[0].time);
    }
}

TEST(FixSeries, an_empty_position_without_a_fix_type_is_no_fix) {
    const auto series = parse_fix_series("lat,lon,alt\n,,\n1,2,3\n", "d.csv");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_FALSE(series->samples[0].has_fix);
    EXPECT_TRUE(series->samples[1].has_fix);
}

TEST(FixSeries, seconds_in_a_time_column_give_the_interval_and_no_date) {
    const auto series =
        parse_fix_series("time,lat,lon,alt\n100.0,1,2,3\n100.5,1,2,3\n101.0,1,2,3\n160,1,2,3\n", "d.csv");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_FALSE(series->dated);
    EXPECT_EQ(series->interval, Seconds(0.5));
}

TEST(FixSeries, units_of_columns_count) {
    const auto feet = parse_fix_series(
        "Time (ms),Latitude (deg),Longitude [rad],Altitude (ft)\n0,47,0.1,1000\n500,47,0.1,1000\n", "d.csv");
    ASSERT_TRUE(feet) << feet.error().message;
    EXPECT_EQ(feet->interval, Seconds(0.5));
    EXPECT_NEAR(feet->samples[0].position.longitude.rad(), 0.1, 1e-12);
    EXPECT_NEAR(feet->samples[0].position.height.above_ellipsoid.value(), 304.8, 1e-9);
    const auto behind =
        parse_fix_series("t_ms,lat_rad,lon_e7,alt_ft\n0,0.5,80000000,10\n250,0.5,80000000,10\n", "d.csv");
    ASSERT_TRUE(behind) << behind.error().message;
    EXPECT_EQ(behind->interval, Seconds(0.25));
    EXPECT_NEAR(behind->samples[0].position.longitude.deg(), 8, 1e-12);
    EXPECT_NEAR(behind->samples[0].position.height.above_ellipsoid.value(), 3.048, 1e-12);
    EXPECT_THAT(message_of("lat,lon,Altitude (furlongs)\n1,2,3\n"),
                AllOf(HasSubstr("a.csv:1:"), HasSubstr("'Altitude (furlongs)' is not known; expected one such as m")));
}

TEST(FixSeries, letters_of_the_hemisphere_turn_the_sign) {
    const auto series = parse_fix_series("time,lat,N/S,lon,E/W,height\n0,33.9,S,18.4W,,100\n", "a.csv");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_NEAR(series->samples[0].position.latitude.deg(), -33.9, 1e-12);
    EXPECT_NEAR(series->samples[0].position.longitude.deg(), -18.4, 1e-12);
    EXPECT_THAT(message_of("lat,lon,height,side\n33.9,18.4,100,S\n"),
                HasSubstr("a.csv: the column 'side' has 'S' (first in line 2), which may be a hemisphere"));
}

TEST(FixSeries, a_time_that_is_not_read_is_told) {
    const auto stamps =
        parse_fix_series("timestamp_ms,lat,lon,alt\n1700000000000,1,2,3\n1700000000500,1,2,3\n", "d.csv");
    ASSERT_TRUE(stamps) << stamps.error().message;
    EXPECT_EQ(stamps->interval, Seconds(0.5));
    EXPECT_TRUE(stamps->warnings.empty());
    const auto unread = parse_fix_series("lat,lon,alt,tow_s,GPS Time (fortnights)\n1,2,3,5,6\n1,2,3,6,7\n", "d.csv");
    ASSERT_TRUE(unread) << unread.error().message;
    EXPECT_FALSE(unread->interval);
    EXPECT_THAT(unread->warnings, ElementsAre(AllOf(HasSubstr("d.csv: no time is known: tow_s, GPS Time (fortnights)"),
                                                    HasSubstr("gps_week and tow_s"))));
    const auto week = parse_fix_series("gps_week,tow_s,lat,lon,alt,lock_time_s\n2300,5,1,2,3,9\n", "d.csv");
    ASSERT_TRUE(week) << week.error().message;
    EXPECT_TRUE(week->warnings.empty());
    const auto none = parse_fix_series("lat,lon,alt,temperature,status\n1,2,3,20,1\n", "d.csv");
    ASSERT_TRUE(none) << none.error().message;
    EXPECT_TRUE(none->warnings.empty());
}

TEST(FixSeries, tables_that_are_tracks_are_read) {
    const auto track = parse_fix_series("t_s,lat_deg,lon_deg,h_ell_m,vn_mps\n0,47,8,500,0\n1,47,8,501,0\n", "t.csv");
    ASSERT_TRUE(track) << track.error().message;
    EXPECT_EQ(track->interval, Seconds(1));
    EXPECT_EQ(track->samples[1].position.height.above_ellipsoid.value(), 501);
    EXPECT_THAT(track->warnings, ElementsAre());
    const auto sea = parse_fix_series("t_s,lat_deg,lon_deg,alt_msl_m\n0,47,8,500\n", "t.csv");
    ASSERT_TRUE(sea) << sea.error().message;
    EXPECT_THAT(sea->warnings, ElementsAre(HasSubstr("the heights of alt_msl_m are above sea level")));
}

TEST(FixSeries, rows_without_a_place_are_no_fixes) {
    const auto series = parse_fix_series("lat,lon,alt\n1,2,3\n0,0,0\nnan,nan,nan\n1,2,\n", "d.csv");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->samples.size(), 4u);
    EXPECT_EQ(series->fixes(), 1u);
    EXPECT_THAT(series->warnings, ElementsAre(HasSubstr("1 rows at latitude 0, longitude 0 are not counted as fixes"),
                                              HasSubstr("1 rows without one of latitude, longitude and height")));
}

TEST(FixSeries, rows_that_go_back_in_time_are_told) {
    const auto series =
        parse_fix_series("time,lat,lon,alt\n10,1,2,3\n11,1,2,3\n11,1,2,3\n9,1,2,3\n10,1,2,3\n", "d.csv");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->fixes(), 5u);
    EXPECT_THAT(series->warnings, ElementsAre("d.csv: 1 rows tell an earlier time than the row before them"));
}

TEST(FixSeries, a_last_line_that_is_cut_is_left_out) {
    const auto series = parse_fix_series(fixes_header + fix_row + fix_row.substr(0, 60), "f.csv");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->samples.size(), 1u);
    EXPECT_THAT(series->warnings, ElementsAre("f.csv:3: the last line is cut and was left out"));
}

TEST(FixSeries, errors_name_file_line_and_what_was_found) {
    EXPECT_THAT(message_of(""), AllOf(HasSubstr("a.csv"), HasSubstr("empty")));
    EXPECT_THAT(message_of(" \n\n"), HasSubstr("empty"));
    EXPECT_THAT(message_of("lat,lon,alt\n"), HasSubstr("no fix in 0 rows"));
    EXPECT_THAT(message_of("1,2,3\n91,2,3\n"),
                AllOf(HasSubstr("a.csv:2:"), HasSubstr("latitude 91"), HasSubstr("-90 to 90")));
    EXPECT_THAT(message_of("1,-181,3\n"), AllOf(HasSubstr("a.csv:1:"), HasSubstr("longitude -181")));
    EXPECT_THAT(message_of("1,2,1e9\n"), HasSubstr("height"));
    EXPECT_THAT(message_of("1,2,3\nn.a.,2,3\n"),
                AllOf(HasSubstr("a.csv:2:"), HasSubstr("'n.a.'"), HasSubstr("number")));
    EXPECT_THAT(message_of("inf,2,3\n"), AllOf(HasSubstr("a.csv:1:"), HasSubstr("'inf'")));
    EXPECT_THAT(message_of("1,2,3\n1,2\n"), AllOf(HasSubstr("a.csv:2:"), HasSubstr("2 cells, expected 3")));
    EXPECT_THAT(message_of("1,2,3\n1,2,3x\n"), AllOf(HasSubstr("a.csv:2:"), HasSubstr("column 3"), HasSubstr("'3x'")));
    EXPECT_THAT(message_of("1,2,3,4,5\n"), AllOf(HasSubstr("a.csv:1:"), HasSubstr("5 numbers"), HasSubstr("latitude")));
    EXPECT_THAT(message_of("lat,lng,speed\n1,2,3\n"),
                AllOf(HasSubstr("a.csv:1:"), HasSubstr("height"), HasSubstr("lat,lng,speed")));
    EXPECT_LT(message_of("x" + std::string(100000, 'y') + ",z\n").size(), 400u);
    EXPECT_THAT(message_of("time,lat,lon,alt\nyesterday,1,2,3\n"),
                AllOf(HasSubstr("a.csv:2:"), HasSubstr("'yesterday'")));
}

TEST(FixSeries, a_fixes_table_with_holes_is_refused) {
    std::string row = fix_row;
    row.replace(row.find("46.47751"), 8, "");
    EXPECT_THAT(message_of(fixes_header + row), AllOf(HasSubstr("a.csv:2:"), HasSubstr("latitude is ''")));
    EXPECT_THAT(message_of(fixes_header + fix_row.substr(0, 60)),
                AllOf(HasSubstr("a.csv:2:"), HasSubstr("expected 27")));
    row = fix_row;
    row.replace(row.find(",3d,"), 4, ",4d,");
    EXPECT_THAT(message_of(fixes_header + row), AllOf(HasSubstr("fix_type is '4d'"), HasSubstr("rtk_fixed")));
    EXPECT_THAT(message_of(fixes_header + no_fix_row), HasSubstr("no fix in 1 rows"));
    row = fix_row;
    row.replace(row.find(",8,"), 3, ",8.5,");
    EXPECT_THAT(message_of(fixes_header + row), HasSubstr("number of satellites used is 8.5"));
}

TEST(FixSeries, ubx_without_a_position_and_other_binary_files_are_refused_by_name) {
    EXPECT_THAT(message_of("\xB5\x62\x01\x07"), AllOf(HasSubstr("UBX"), HasSubstr("B5 62")));
    EXPECT_THAT(message_of(std::string("1,2\0,3\n", 7)), AllOf(HasSubstr("not text"), HasSubstr("offset 3")));
}

TEST(FixSeries, reads_gga_with_dates_from_rmc_across_midnight) {
    const auto series = parse_fix_series("GPGGA,cut off*00\r\n" +
                                             nmea("GPGGA,235958.00,4628.650,N,03043.956,W,1,08,1.0,50.5,M,30.5,M,,") +
                                             nmea("GPRMC,235958.00,A,4628.650,N,03043.956,W,0.0,0.0,311209,,,A") +
                                             nmea("GPGGA,235959.00,4628.650,S,03043.956,E,1,08,1.0,50.5,M,-30.5,M,,") +
                                             nmea("GPGGA,000000.00,,,,,0,00,99.9,,M,,M,,") + nmea("GPGSV,1,1,00"),
                                         "log.nmea");
    ASSERT_TRUE(series) << series.error().message;
    ASSERT_EQ(series->samples.size(), 3u);
    EXPECT_TRUE(series->dated);
    EXPECT_NEAR(series->samples[0].position.latitude.deg(), 46.4775, 1e-9);
    EXPECT_NEAR(series->samples[0].position.longitude.deg(), -30.7326, 1e-9);
    EXPECT_EQ(series->samples[0].position.height.above_ellipsoid.value(), 81.0);
    EXPECT_NEAR(series->samples[1].position.latitude.deg(), -46.4775, 1e-9);
    EXPECT_EQ(series->samples[1].position.height.above_ellipsoid.value(), 20.0);
    EXPECT_FALSE(series->samples[2].has_fix);
    const auto at = [&](std::size_t i) { return utc_text(*series->samples[i].time); };
    EXPECT_EQ(at(0), "2009-12-31T23:59:58Z");
    EXPECT_EQ(at(1), "2009-12-31T23:59:59Z");
    EXPECT_EQ(at(2), "2010-01-01T00:00:00Z");
    EXPECT_TRUE(series->warnings.empty());
}

TEST(FixSeries, gga_without_a_date_still_gives_the_interval) {
    std::string text;
    for (const char* time : {"235959.50", "000000.00", "000000.50"})
        text += nmea("GNGGA," + std::string(time) + ",4628.650,N,03043.956,E,1,08,1.0,50.5,M,,M,,");
    const auto series = parse_fix_series(text, "log.nmea");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_FALSE(series->dated);
    EXPECT_EQ(series->interval, Seconds(0.5));
    ASSERT_EQ(series->warnings.size(), 1u);
    EXPECT_THAT(series->warnings[0], AllOf(HasSubstr("3 fixes without a geoid separation"), HasSubstr("log.nmea")));
}

// GGA comes before RMC, whose date is that of the second 60, and so does its midnight.
TEST(FixSeries, nmea_goes_over_a_leap_second) {
    std::string text;
    for (const char* time : {"235959.00,311216", "235960.00,311216", "000000.00,010117", "000001.00,010117"}) {
        const std::string clock(time, 9), date(time + 10);
        text += nmea("GPGGA," + clock + ",4628.650,N,03043.956,E,1,08,1.0,50.5,M,30.5,M,,") +
                nmea("GPRMC," + clock + ",A,4628.650,N,03043.956,E,0.0,0.0," + date + ",,,A");
    }
    const auto series = parse_fix_series(text, "log.nmea");
    ASSERT_TRUE(series) << series.error().message;
    std::vector<std::string> times;
    for (const FixSample& sample : series->samples)
        times.push_back(utc_text(*sample.time));
    EXPECT_THAT(times, ElementsAre("2016-12-31T23:59:59Z", "2016-12-31T23:59:60Z", "2017-01-01T00:00:00Z",
                                   "2017-01-01T00:00:01Z"));
}

TEST(FixSeries, nmea_of_several_talkers_is_one_sample_an_epoch) {
    std::string text;
    for (const char* time : {"120000.00", "120001.00", "120002.00"})
        text += nmea("GPGGA," + std::string(time) + ",4628.650,N,03043.956,E,1,07,1.0,50.5,M,30.5,M,,") +
                nmea("GNGGA," + std::string(time) + ",4628.660,N,03043.956,E,1,11,1.0,50.5,M,,M,,") +
                nmea("GLGGA," + std::string(time) + ",,,,,0,04,,,M,,M,,");
    const auto series =
        parse_fix_series(text + nmea("GNGGA,,,,,,0,,,,M,,M,,") + nmea("GPGGA,,,,,,0,,,,M,,M,,"), "log.nmea");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->samples.size(), 4u);
    EXPECT_EQ(series->fixes(), 3u);
    EXPECT_NEAR(series->samples[1].position.latitude.deg(), 46.4776667, 1e-6);
    EXPECT_EQ(series->samples[1].satellites_used, 11);
    EXPECT_THAT(series->warnings, ElementsAre(HasSubstr("3 fixes without a geoid separation")));
}

// A fix is made with any of the systems; where GGA tells the same epoch, the sentence with more satellites is taken.
TEST(FixSeries, nmea_gns_is_read_as_gga_is) {
    const auto series = parse_fix_series(nmea("GNGNS,120000.00,4628.650,N,03043.956,E,NA,13,0.9,50.5,30.5,,,V") +
                                             nmea("GNGNS,120001.00,,,,,NN,00,,,,,,V") +
                                             nmea("GNGGA,120002.00,4628.650,N,03043.956,E,1,12,0.9,50.5,M,30.5,M,,") +
                                             nmea("GNGNS,120002.00,4628.650,N,03043.956,E,AA,20,0.9,51.5,30.5,,"),
                                         "log.nmea");
    ASSERT_TRUE(series) << series.error().message;
    ASSERT_EQ(series->samples.size(), 3u);
    EXPECT_TRUE(series->samples[0].has_fix);
    EXPECT_EQ(series->samples[0].satellites_used, 13);
    EXPECT_EQ(series->samples[0].position.height.above_ellipsoid.value(), 81.0);
    EXPECT_FALSE(series->samples[1].has_fix);
    EXPECT_EQ(series->samples[2].satellites_used, 20);
    EXPECT_EQ(series->interval, Seconds(1));
    EXPECT_THAT(message_of(nmea("GNGNS,120000.00,4628.650,X,03043.956,E,AA,13,0.9,50.5,30.5,,")),
                HasSubstr("1 sentences with a right checksum that make no sense"));
}

TEST(FixSeries, nmea_tells_satellites_used_and_signal_strengths) {
    const std::string gga = nmea("GNGGA,120000.00,4628.650,N,03043.956,E,1,12,1.0,50.5,M,30.5,M,,");
    const std::string satellites = nmea("GNGSA,A,3,01,02,03,04,05,06,07,08,09,10,11,12,1.8,1.0,1.5,1") +
                                   nmea("GNGSA,A,3,65,66,67,,,,,,,,,,1.8,1.0,1.5,2") +
                                   nmea("GPGSV,1,1,03,01,42,090,40,02,90,000,50,03,10,180,,1") +
                                   nmea("GLGSV,1,1,02,65,47,090,44,66,,,30,1");
    const auto series = parse_fix_series(gga + satellites + gga, "log.nmea");
    ASSERT_TRUE(series) << series.error().message;
    ASSERT_EQ(series->samples.size(), 2u);
    EXPECT_EQ(series->samples[0].satellites_used, 15);
    EXPECT_EQ(series->samples[1].satellites_used, 12);
    EXPECT_EQ(series->signal_strength().bin(4).n(), 2u);
    EXPECT_DOUBLE_EQ(series->signal_strength().bin(4).mean(), 42);
    EXPECT_EQ(series->signal_strength().bin(8).n(), 1u);
    EXPECT_EQ(series->signal_strength().bin(1).n(), 0u);
    std::string damaged = satellites;
    damaged[10] = '2';
    const auto rest = parse_fix_series(gga + damaged, "log.nmea");
    ASSERT_TRUE(rest) << rest.error().message;
    EXPECT_THAT(rest->warnings, ElementsAre(HasSubstr("1 damaged GSA or GSV sentences")));
}

// GSV of version 4.10 and later lists a satellite with each of its signals.
TEST(FixSeries, nmea_signal_strengths_are_of_one_signal_of_each_system) {
    const std::string gga = nmea("GNGGA,120000.00,4628.650,N,03043.956,E,1,12,1.0,50.5,M,30.5,M,,");
    const auto of = [&](const std::string& satellites) {
        const auto series = parse_fix_series(satellites + gga + satellites, "log.nmea");
        EXPECT_TRUE(series) << series.error().message;
        return series ? series->signal_strength().bin(4) : RunningStatistics();
    };
    const std::string l1 = nmea("GPGSV,1,1,02,01,42,090,44,02,43,000,46,1");
    const std::string others = nmea("GPGSV,1,1,02,01,42,090,20,02,43,000,22,8") + nmea("GAGSV,1,1,01,05,42,090,21,2") +
                               nmea("GLGSV,1,1,01,65,42,090,23,3") + nmea("GBGSV,1,1,01,21,42,090,24,B");
    const std::string first =
        nmea("GAGSV,1,1,01,05,42,090,45,7") + nmea("GLGSV,1,1,01,65,42,090,45,1") + nmea("GBGSV,1,1,01,21,42,090,45,1");
    EXPECT_EQ(of(others + l1 + first).n(), 5u);  // each once, however often an epoch lists it
    EXPECT_NEAR(of(others + l1 + first).mean(), 45, 1e-9);
    // BeiDou without B1I, and lists that tell no signal.
    const std::string b1c = nmea("GBGSV,1,1,01,21,42,090,41,3") + nmea("GBGSV,1,1,01,21,42,090,47,5");
    EXPECT_EQ(of(b1c).n(), 1u);
    EXPECT_NEAR(of(b1c).mean(), 41, 1e-9);
    const std::string untold = nmea("GPGSV,1,1,01,03,42,090,40") + nmea("GPGSV,1,1,01,04,42,090,42,0");
    EXPECT_EQ(of(l1 + untold).n(), 4u);
    EXPECT_NEAR(of(l1 + untold).mean(), 43, 1e-9);
}

// The folder of a run: fixes.csv and beside it satellites.csv.
TEST(FixSeries, signal_strengths_come_from_the_satellites_table_beside_fixes) {
    const std::filesystem::path folder = testing::TempDir() + "fix_series_run";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "fixes.csv") << fixes_header + fix_row + no_fix_row;
    const auto alone = read_fix_series(folder / "fixes.csv");
    ASSERT_TRUE(alone) << alone.error().message;
    EXPECT_TRUE(alone->signal_strength().empty() && alone->warnings.empty());
    std::ofstream(folder / "satellites.csv") << "time_utc,satellite,elevation_deg,cn0_dbhz,used\n"
                                                "2010-07-01T12:00:00.000Z,G01,35.0,44,1\n"
                                                "2010-07-01T12:00:00.000Z,G02,39.9,46,0\n"
                                                "2010-07-01T12:00:00.000Z,G03,5,,0\n"
                                                "2010-07-01T12:00:01.000Z,G01,35.1,50,1\n";
    const auto series = read_fix_series(folder / "fixes.csv");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->signal_strength().bin(3).n(), 3u);
    EXPECT_EQ(series->signal_strength().bin(0).n(), 0u);
    const SignalStrengthByElevation first = slice(*series, {0, 1, 1}).signal_strength();
    EXPECT_EQ(first.bin(3).n(), 2u);
    EXPECT_DOUBLE_EQ(first.bin(3).mean(), 45);
    EXPECT_DOUBLE_EQ(first.bin(3).std(), std::sqrt(2.0));
    // G02 arrives and is not tracked.
    std::ofstream(folder / "satellites.csv") << "time_utc,satellite,elevation_deg,cn0_dbhz,pseudorange_m,used\n"
                                                "2010-07-01T12:00:00.000Z,G01,35.0,44,21000000.0,0\n"
                                                "2010-07-01T12:00:00.000Z,G02,39.9,46,,0\n";
    const auto tracked = read_fix_series(folder / "fixes.csv");
    ASSERT_TRUE(tracked) << tracked.error().message;
    EXPECT_EQ(tracked->signal_strength().bin(3).n(), 1u);
    EXPECT_DOUBLE_EQ(tracked->signal_strength().bin(3).mean(), 44);
    std::ofstream(folder / "satellites.csv") << "time_utc,elevation_deg,cn0_dbhz\n2010-07-01T12:00:00Z,low,44\n";
    const auto broken = read_fix_series(folder / "fixes.csv");
    ASSERT_TRUE(broken) << broken.error().message;
    EXPECT_THAT(broken->warnings, ElementsAre(AllOf(HasSubstr("satellites.csv:2:"), HasSubstr("left out"))));
    std::filesystem::remove_all(folder);
}

TEST(FixSeries, damaged_sentences_are_skipped_and_counted) {
    const std::string good = nmea("GPGGA,120000.00,4628.650,N,03043.956,E,1,08,1.0,50.5,M,30.5,M,,");
    std::string bad = good;
    bad[20] = '9';
    const auto series =
        parse_fix_series("\x01\x02noise" + good + bad + good.substr(0, good.find('*')) + "\n", "log.nmea");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->samples.size(), 1u);
    ASSERT_EQ(series->warnings.size(), 2u);
    EXPECT_THAT(series->warnings[0], HasSubstr("1 GGA, GNS or RMC sentences with a wrong checksum"));
    EXPECT_THAT(series->warnings[1], HasSubstr("1 GGA, GNS or RMC sentences without a checksum"));
    EXPECT_THAT(message_of(bad), AllOf(HasSubstr("none of them with a solution"),
                                       HasSubstr("1 GGA, GNS or RMC sentences with a wrong checksum")));
}

TEST(FixSeries, a_sentence_with_stray_bytes_is_skipped_and_counted) {
    const std::string good = nmea("GPGGA,120000.00,4628.650,N,03043.956,E,1,08,1.0,50.5,M,30.5,M,,");
    const auto series = parse_fix_series("$GPGGA,1200\x01" + good + "$GPRMC,12" + good, "log.nmea");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->samples.size(), 2u);
    EXPECT_THAT(series->warnings, ElementsAre(HasSubstr("2 GGA, GNS or RMC sentences with a wrong checksum or stray")));
}

TEST(FixSeries, lines_may_end_in_any_way_and_go_on_behind_the_checksum) {
    const std::string sentence = "$GPGGA,120000.00,4628.650,N,03043.956,E,1,08,1.0,50.5,M,30.5,M,,*55";
    for (const char* end : {"\n", "\r", "\r\n", "\r\r\n", " \n", ",12:00:00.1\r\n", ""}) {
        const auto series = parse_fix_series("12:00:00.0 " + sentence + end, "log.nmea");
        ASSERT_TRUE(series) << series.error().message;
        EXPECT_EQ(series->fixes(), 1u);
        EXPECT_TRUE(series->warnings.empty());
    }
}

TEST(FixSeries, a_sentence_that_passes_its_checksum_must_make_sense) {
    EXPECT_THAT(message_of("\n" + nmea("GPGGA,120000.00,9128.650,N,03043.956,E,1,08,1.0,50.5,M,30.5,M,,")),
                AllOf(HasSubstr("line 2:"), HasSubstr("'9128.650'; expected a latitude")));
    EXPECT_THAT(message_of(nmea("GPGGA,120000.00,4628.650,X,03043.956,E,1,08,1.0,50.5,M,30.5,M,,")),
                AllOf(HasSubstr("line 1:"), HasSubstr("field 3 is 'X'; expected N or S")));
    EXPECT_THAT(message_of(nmea("GPGGA,120000.00,nan,N,03043.956,E,1,08,1.0,50.5,M,30.5,M,,")), HasSubstr("'nan'"));
    EXPECT_THAT(message_of(nmea("GPGGA,996000.00,4628.650,N,03043.956,E,1,08,1.0,50.5,M,30.5,M,,")),
                HasSubstr("996000"));
    EXPECT_THAT(message_of(nmea("GPGGA,120000.00,4628.650,N")), HasSubstr("3 fields; expected at least 12"));
}

TEST(FixSeries, a_strange_sentence_costs_no_other_fix) {
    const std::string good = nmea("GPGGA,120000.00,4628.650,N,03043.956,E,1,08,1.0,50.5,M,30.5,M,,");
    const auto series = parse_fix_series(good + nmea("GPGGA,120001.00,4628.650,N,03043.956,E,1,03,2.0,,M,,M,,") +
                                             nmea("GPRMC,120001.00,A,4628.65,N,03043.956,E,0,0,2208-1,,,A") + good,
                                         "log.nmea");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->samples.size(), 3u);
    EXPECT_EQ(series->fixes(), 2u);
    EXPECT_THAT(series->warnings, ElementsAre(HasSubstr("1 positions without an altitude are not counted as fixes"),
                                              AllOf(HasSubstr("1 sentences with a right checksum that make no sense"),
                                                    HasSubstr("line 3"), HasSubstr("'2208-1'"))));
}

TEST(FixSeries, truncation_anywhere_never_crashes) {
    const std::string table = fixes_header + fix_row + no_fix_row;
    const std::string log = nmea("GPRMC,120000.00,A,4628.650,N,03043.956,W,0.0,0.0,311209,,,A") +
                            nmea("GPGGA,120000.00,4628.650,N,03043.956,E,1,08,1.0,50.5,M,30.5,M,,");
    for (const std::string& whole : {table, log})
        for (std::size_t length = 0; length < whole.size(); ++length) {
            const auto series = parse_fix_series(whole.substr(0, length), "cut");
            EXPECT_TRUE(series || series.error().message.find("cut") != std::string::npos) << length;
        }
}

TEST(FixSeries, reads_gzip_and_names_a_missing_file) {
    const std::string path = testing::TempDir() + "fix_series_test.csv.gz";
    gzFile file = gzopen(path.c_str(), "wb");
    ASSERT_TRUE(file);
    gzputs(file, "36.97,-121.9,10.5\n");
    gzclose(file);
    const auto series = read_fix_series(path);
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->fixes(), 1u);
    std::remove(path.c_str());
    const auto missing = read_fix_series("/nonexistent/fixes.csv");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::outside);
    EXPECT_THAT(missing.error().message, HasSubstr("/nonexistent/fixes.csv"));
}

FixSeries counted_series(std::size_t count) {
    FixSeries series{"counted", {}, false, Seconds(0.5), {}};
    for (std::size_t i = 0; i < count; ++i)
        series.samples.push_back({std::nullopt, true, Geodetic::degrees(0, 0, static_cast<double>(i)), std::nullopt});
    return series;
}

double height_at(const FixSeries& series, std::size_t i) {
    return series.samples.at(i).position.height.above_ellipsoid.value();
}

TEST(FixSeries, slices_keep_every_nth_sample) {
    const FixSeries part = slice(counted_series(10), {1, 3, 2});
    ASSERT_EQ(part.samples.size(), 2u);
    EXPECT_EQ(height_at(part, 0), 1);
    EXPECT_EQ(height_at(part, 1), 4);
    EXPECT_EQ(part.interval, Seconds(1.5));
    EXPECT_EQ(slice(counted_series(10), {}).samples.size(), 10u);
    EXPECT_EQ(slice(counted_series(10), {0, 0, 0}).samples.size(), 10u);
    EXPECT_TRUE(slice(counted_series(10), {10, 1, 0}).samples.empty());
}

// Every second sample is none: fixes are counted, and what lies between them shows that it does.
TEST(FixSeries, slices_and_windows_count_fixes) {
    FixSeries series = counted_series(40);
    for (std::size_t i = 0; i < 40; i += 2)
        series.samples[i].has_fix = false;
    const FixSeries first = slice(series, {0, 1, 10});
    EXPECT_EQ(first.fixes(), 10u);
    EXPECT_EQ(first.samples.size(), 20u);
    const FixSeries rest = slice(series, {10, 1, 0});
    EXPECT_EQ(rest.fixes(), 10u);
    EXPECT_EQ(height_at(rest, 0), 20);
    const FixSeries thin = slice(series, {1, 2, 0});
    EXPECT_EQ(thin.fixes(), 10u);
    EXPECT_EQ(thin.samples.size(), 20u);
    EXPECT_EQ(height_at(thin, 1), 3);
    EXPECT_EQ(height_at(thin, 3), 7);
    const std::vector<FixSeries> parts = windows(series, 8);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[1].fixes(), 8u);
    EXPECT_EQ(height_at(parts[1], 0), 16);
}

TEST(FixSeries, windows_are_whole_and_consecutive) {
    const std::vector<FixSeries> parts = windows(counted_series(11), 4);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[1].samples.size(), 4u);
    EXPECT_EQ(height_at(parts[1], 0), 4);
    EXPECT_EQ(parts[1].name, "counted window 2");
    EXPECT_TRUE(windows(counted_series(3), 4).empty());
}

TEST(FixSeries, reads_the_real_lea6_tracks) {
    SKYLOOP_REQUIRE_SHARED(folder, "receivers/aptos_20130214_lea6");
    const auto first = read_fix_series(folder / "2013.02.14-024312_ublox1_geodetic.dlm");
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_EQ(first->fixes(), 38260u);
    EXPECT_NEAR(first->samples[0].position.latitude.deg(), 36.9706040, 1e-9);
    EXPECT_EQ(windows(slice(*first, {0, 2, 0}), 3600).size(), 5u);
}

TEST(FixSeries, reads_a_real_nmea_log_of_an_indoor_receiver) {
    SKYLOOP_REQUIRE_SHARED(log, "receivers/indoor_neo6m_20240726/gps_data_20240726_122435.log.gz");
    const auto series = read_fix_series(log);
    ASSERT_TRUE(series) << series.error().message;
    // 3840 epochs of which 3759 have a fix (MEASURED.md).
    EXPECT_NEAR(static_cast<double>(series->samples.size()), 3840, 2);
    EXPECT_NEAR(static_cast<double>(series->fixes()), 3759, 2);
    EXPECT_TRUE(series->dated);
    EXPECT_EQ(series->interval, Seconds(1));
    EXPECT_NEAR(series->signal_strength().bin(3).mean(), 24.4, 0.1);
    EXPECT_EQ(utc_text(*series->samples[0].time), "2024-07-26T11:24:35Z");
}

// Whatever a real serial line has carried is read or refused with the file's name, never worse.
TEST(FixSeries, takes_every_real_serial_log_without_harm) {
    SKYLOOP_REQUIRE_SHARED(folder, "serial");
    std::size_t files = 0, read = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        const auto series = read_fix_series(entry.path());
        ++files;
        if (series) {
            ++read;
            EXPECT_GT(series->fixes(), 0u) << entry.path();
        } else {
            EXPECT_THAT(series.error().message, HasSubstr(entry.path().filename().string()));
        }
    }
    EXPECT_GT(files, 100u);
    EXPECT_GT(read, 30u);
}

}  // namespace
}  // namespace skyloop
