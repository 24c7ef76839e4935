#include "receiver/protocol/nmea_messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/core/random.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr NmeaFormat in_4_0{.version = NmeaVersion::v4_0};
constexpr NmeaFormat in_4_10{.version = NmeaVersion::v4_10};

NmeaPosition place(double latitude, double longitude) { return {Angle::degrees(latitude), Angle::degrees(longitude)}; }

std::string gll(double latitude, double longitude) {
    Gll m;
    m.position = place(latitude, longitude);
    return encode(m, in_4_0);
}

std::string nmea_time_text(GpsTime time, int decimals, const LeapSeconds& leap = LeapSeconds::announced()) {
    return format_utc(rounded_utc(time, decimals, leap), decimals);
}

GpsTime gps_time(const char* utc) { return to_gps_time(*parse_utc(utc), LeapSeconds::announced()); }

// Strings captured from receivers that have no fix (RECEIVER.md 5.5).
TEST(NmeaWithoutFix, IsByteForByteTheReceiversOwn) {
    Rmc rmc;
    rmc.mode = NmeaMode::none;
    EXPECT_EQ(encode(rmc, in_4_10), "$GNRMC,,V,,,,,,,,,,N,V*37\r\n");
    EXPECT_EQ(encode(rmc, in_4_0), "$GNRMC,,V,,,,,,,,,,N*4D\r\n");
    rmc.time = NmeaTime{14, 56, 22, 0};
    rmc.date = NmeaDate{2023, 6, 28};
    EXPECT_THAT(encode(rmc, in_4_0), StartsWith("$GNRMC,145622.00,V,,,,,,,280623,,,N*"));

    Vtg vtg;
    vtg.mode = NmeaMode::none;
    EXPECT_EQ(encode(vtg, in_4_10), "$GNVTG,,,,,,,,,N*2E\r\n");
    Gga gga;
    gga.hdop = 99.99;
    EXPECT_EQ(encode(gga, in_4_10), "$GNGGA,,,,,,0,00,99.99,,,,,,*56\r\n");
    Gsa gsa;
    gsa.pdop = gsa.hdop = gsa.vdop = 99.99;
    gsa.system_id = 1;
    EXPECT_EQ(encode(gsa, in_4_10), "$GNGSA,A,1,,,,,,,,,,,,,99.99,99.99,99.99,1*33\r\n");
    EXPECT_EQ(encode(gsa, in_4_0), "$GNGSA,A,1,,,,,,,,,,,,,99.99,99.99,99.99*2E\r\n");
    Gll m;
    m.mode = NmeaMode::none;
    EXPECT_EQ(encode(m, in_4_10), "$GNGLL,,,,,,V,N*7A\r\n");
    EXPECT_EQ(encode(gsv_pages("GP", {}, 0).at(0), in_4_0), "$GPGSV,1,1,00*79\r\n");
    EXPECT_EQ(encode(gsv_pages("GL", {}, 0).at(0), in_4_0), "$GLGSV,1,1,00*65\r\n");
    EXPECT_EQ(encode(gsv_pages("GP", {}, 0).at(0), in_4_10), "$GPGSV,1,1,00,0*65\r\n");
    EXPECT_EQ(encode(gsv_pages("GQ", {}, 0).at(0), in_4_10), "$GQGSV,1,1,00,0*64\r\n");
    EXPECT_EQ(encode(gsv_pages("GP", {}, 1).at(0), in_4_10), "$GPGSV,1,1,00,1*64\r\n");
    EXPECT_EQ(encode(Zda{}, in_4_10), "$GNZDA,,,,,00,00*56\r\n");
    EXPECT_THAT(encode(Gst{}, in_4_10), StartsWith("$GNGST,,,,,,,,*"));
}

TEST(NmeaCoordinates, CarryMinutesIntoDegrees) {
    EXPECT_THAT(gll(46.0 + 59.999996 / 60.0, 30.0 + 59.999994 / 60.0),
                StartsWith("$GNGLL,4700.00000,N,03059.99999,E,"));
    EXPECT_THAT(gll(-(9.0 + 59.9999951 / 60.0), 179.0 + 59.999996 / 60.0),
                StartsWith("$GNGLL,1000.00000,S,18000.00000,E,"));
    EXPECT_THAT(gll(90.0, -180.0), StartsWith("$GNGLL,9000.00000,N,18000.00000,W,"));
    EXPECT_THAT(gll(-90.0, 180.0), StartsWith("$GNGLL,9000.00000,S,18000.00000,E,"));
}

TEST(NmeaCoordinates, NamesNoHemisphereForAZeroThatIsNegative) {
    EXPECT_THAT(gll(-1e-12, -0.0), StartsWith("$GNGLL,0000.00000,N,00000.00000,E,"));
    EXPECT_THAT(gll(-1e-7, -1e-7), StartsWith("$GNGLL,0000.00001,S,00000.00001,W,"));
}

TEST(NmeaCoordinates, WrapLongitudesAndDropWhatIsNoNumber) {
    EXPECT_THAT(gll(0.5, 190.0), StartsWith("$GNGLL,0030.00000,N,17000.00000,W,"));
    EXPECT_THAT(gll(0.5, -350.0), StartsWith("$GNGLL,0030.00000,N,01000.00000,E,"));
    EXPECT_THAT(gll(std::nan(""), 1.0), StartsWith("$GNGLL,,,,,,V"));
    EXPECT_THAT(gll(1.0, std::numeric_limits<double>::infinity()), StartsWith("$GNGLL,,,,,,V"));
}

TEST(NmeaCoordinates, KeepWithinHalfADigitEverywhere) {
    RandomStream random(3, "coordinates");
    for (int i = 0; i < 5000; ++i) {
        const double latitude = random.uniform() * 180 - 90, longitude = random.uniform() * 360 - 180;
        const std::string line = gll(latitude, longitude);
        const auto sentence = parse_sentence(line);
        ASSERT_TRUE(sentence);
        const double lat = std::stod(std::string(sentence->field(0))), lon = std::stod(std::string(sentence->field(2)));
        const double lat_minutes = std::floor(lat / 100) * 60 + std::fmod(lat, 100);
        const double lon_minutes = std::floor(lon / 100) * 60 + std::fmod(lon, 100);
        ASSERT_LT(std::fmod(lat, 100), 60.0) << line;
        ASSERT_LT(std::fmod(lon, 100), 60.0) << line;
        ASSERT_NEAR(lat_minutes, std::abs(latitude) * 60, 0.5001e-5) << line;
        ASSERT_NEAR(lon_minutes, std::abs(longitude) * 60, 0.5001e-5) << line;
        ASSERT_EQ(sentence->field(1), latitude < 0 ? "S" : "N");
        ASSERT_EQ(sentence->field(3), longitude < 0 ? "W" : "E");
    }
}

TEST(RoundedUtc, CarriesOverMidnightMonthAndYear) {
    using namespace std::chrono_literals;
    EXPECT_EQ(nmea_time_text(gps_time("2024-03-05T23:59:59.996Z"), 2), "2024-03-06T00:00:00.00Z");
    EXPECT_EQ(nmea_time_text(gps_time("2024-03-05T23:59:59.994999999Z"), 2), "2024-03-05T23:59:59.99Z");
    EXPECT_EQ(nmea_time_text(gps_time("2024-02-28T23:59:59.995Z"), 2), "2024-02-29T00:00:00.00Z");
    EXPECT_EQ(nmea_time_text(gps_time("2023-12-31T23:59:59.9993Z"), 2), "2024-01-01T00:00:00.00Z");
    EXPECT_EQ(nmea_time_text(gps_time("2024-03-05T12:59:59.6Z"), 0), "2024-03-05T13:00:00Z");
    EXPECT_EQ(nmea_time_text(gps_time("2024-03-05T12:34:56.123456789Z"), 9), "2024-03-05T12:34:56.123456789Z");
}

TEST(RoundedUtc, CountsThroughALeapSecond) {
    EXPECT_EQ(nmea_time_text(gps_time("2016-12-31T23:59:59.996Z"), 2), "2016-12-31T23:59:60.00Z");
    EXPECT_EQ(nmea_time_text(gps_time("2016-12-31T23:59:60.5Z"), 2), "2016-12-31T23:59:60.50Z");
    EXPECT_EQ(nmea_time_text(gps_time("2016-12-31T23:59:60.996Z"), 2), "2017-01-01T00:00:00.00Z");
    Zda zda;
    const UtcTime utc = rounded_utc(gps_time("2016-12-31T23:59:60Z"), 2, LeapSeconds::announced());
    zda.time = nmea_time(utc);
    zda.date = nmea_date(utc);
    EXPECT_THAT(encode(zda, in_4_10), StartsWith("$GNZDA,235960.00,31,12,2016,00,00*"));
}

TEST(NmeaTimes, HaveTheDigitsAskedFor) {
    Gll m;
    m.time = NmeaTime{1, 2, 3, 987'000'000};
    NmeaFormat format = in_4_0;
    EXPECT_THAT(encode(m, format), StartsWith("$GNGLL,,,,,010203.98,V"));
    format.time_decimals = 3;
    EXPECT_THAT(encode(m, format), StartsWith("$GNGLL,,,,,010203.987,V"));
    format.time_decimals = 0;
    EXPECT_THAT(encode(m, format), StartsWith("$GNGLL,,,,,010203,V"));
}

TEST(NmeaCourses, StayBelow360) {
    const auto course = [](double degrees) {
        Vtg m;
        m.speed = MetresPerSecond(1);
        m.course = Angle::degrees(degrees);
        return encode(m, in_4_10);
    };
    EXPECT_THAT(course(359.996), StartsWith("$GNVTG,0.00,T,"));
    EXPECT_THAT(course(360.0), StartsWith("$GNVTG,0.00,T,"));
    EXPECT_THAT(course(359.994), StartsWith("$GNVTG,359.99,T,"));
    EXPECT_THAT(course(-0.001), StartsWith("$GNVTG,0.00,T,"));
    EXPECT_THAT(course(-90), StartsWith("$GNVTG,270.00,T,"));
}

TEST(NmeaSpeeds, AreInKnotsAndKilometresAnHour) {
    Vtg m;
    m.speed = MetresPerSecond(10.0);
    m.mode = NmeaMode::autonomous;
    EXPECT_THAT(encode(m, in_4_10), StartsWith("$GNVTG,,T,,M,19.438,N,36.000,K,A*"));
    Rmc rmc;
    rmc.speed = MetresPerSecond(-0.0);
    EXPECT_THAT(encode(rmc, in_4_10), StartsWith("$GNRMC,,V,,,,,0.000,,"));
}

TEST(NmeaGga, PutsHeightsAndShortensOnlyWhatIsTooLong) {
    Gga m;
    m.time = NmeaTime{22, 37, 45, 0};
    m.position = place(38.110494, -122.626897);
    m.quality = 2;
    m.satellites_used = 12;
    m.hdop = 0.54;
    m.altitude = Metres(-0.04);
    m.geoid_separation = Metres(-29.5);
    m.correction_station = 0;
    EXPECT_THAT(encode(m, in_4_10),
                StartsWith("$GNGGA,223745.00,3806.62964,N,12237.61382,W,2,12,0.54,0.0,M,-29.5,M,,0000*"));
    m.altitude = Metres(81234.5);
    m.geoid_separation = Metres(-102.3);
    m.hdop = 12.3;
    m.correction_age = Seconds(59.04);
    const std::string shortened = encode(m, in_4_10);
    EXPECT_THAT(shortened, HasSubstr(",81234.5,M,-102.3,M,59.0,0000*"));
    EXPECT_LE(shortened.size(), 82U);
    NmeaFormat unlimited = in_4_10;
    unlimited.limit_82 = false;
    EXPECT_GT(encode(m, unlimited).size(), 82U);
    m.altitude = Metres(std::nan(""));
    m.hdop = 250;
    EXPECT_THAT(encode(m, in_4_10), HasSubstr(",99.99,,,-102.3,M,"));
}

TEST(NmeaGsa, HasTwelvePlaces) {
    Gsa m;
    m.fix_mode = 3;
    for (int i = 1; i <= 14; ++i)
        m.satellites.push_back(i);
    m.pdop = 1.0;
    m.hdop = 0.996;
    m.vdop = std::numeric_limits<double>::infinity();
    m.system_id = 10;
    EXPECT_THAT(encode(m, in_4_10), StartsWith("$GNGSA,A,3,01,02,03,04,05,06,07,08,09,10,11,12,1.00,1.00,99.99,A*"));
    m.satellites = {193, 7};
    EXPECT_THAT(encode(m, in_4_0), StartsWith("$GNGSA,A,3,193,07,,,,,,,,,,,1.00,1.00,99.99*"));
}

TEST(NmeaGsv, PagesFourSatellitesEach) {
    std::vector<GsvSatellite> satellites;
    for (int i = 1; i <= 9; ++i)
        satellites.push_back({i, 10 * i, 40 * i, 30 + i});
    const auto pages = gsv_pages("GP", satellites, 1);
    ASSERT_EQ(pages.size(), 3U);
    EXPECT_THAT(encode(pages[0], in_4_10),
                StartsWith("$GPGSV,3,1,09,01,10,040,31,02,20,080,32,03,30,120,33,04,40,160,34,1*"));
    EXPECT_THAT(encode(pages[2], in_4_10), StartsWith("$GPGSV,3,3,09,09,90,000,39,1*"));
    EXPECT_THAT(encode(pages[2], in_4_0), StartsWith("$GPGSV,3,3,09,09,90,000,39*"));
    satellites.resize(4);
    EXPECT_EQ(gsv_pages("GP", satellites, 1).size(), 1U);
    satellites.resize(50);
    EXPECT_EQ(gsv_pages("GP", satellites, 1).size(), 9U);
    EXPECT_EQ(gsv_pages("GP", satellites, 1).back().satellites_in_view, 36);
}

TEST(NmeaGsv, ClampsAndLeavesUnknownsEmpty) {
    const auto page = gsv_pages("GA", {{{}, -5, 360, 120}, {7, {}, {}, {}}, {8, 95, 7, -3}}, 7).at(0);
    EXPECT_THAT(encode(page, in_4_10), StartsWith("$GAGSV,1,1,03,,00,000,99,07,,,,08,90,007,00,7*"));
}

TEST(NmeaGst, ShowsTwoToThreeDigits) {
    Gst m;
    m.range_rms = Metres(228650.4);
    m.semi_major = Metres(2.449);
    m.semi_minor = Metres(0.9951);
    m.orientation = Angle::degrees(125.6);
    m.latitude = Metres(0.984);
    m.longitude = Metres(9.949);
    m.altitude = Metres(9.951);
    EXPECT_THAT(encode(m, in_4_10), StartsWith("$GNGST,,228650,2.4,1.0,126,0.98,9.9,10*"));
    m.latitude = Metres(0.0494);
    m.longitude = Metres(0.0996);
    EXPECT_THAT(encode(m, in_4_10), HasSubstr(",0.049,0.10,10*"));
    // MediaTek's (capture of a Quectel L70).
    const Gst padded{"GP",        NmeaTime{15, 1, 19, 0}, Metres(4),   Metres(8.7),
                     Metres(4.7), Angle::degrees(132.3),  Metres(6.8), Metres(7.2),
                     Metres(14)};
    EXPECT_EQ(encode(padded, {.time_decimals = 3, .deviations_padded = true}),
              "$GPGST,150119.000,004.0,008.7,004.7,132.3,006.8,007.2,00014*71\r\n");
}

// RECEIVER.md 5.2: mode indicators since 2.3.
TEST(NmeaVersions, OfTheBeginningHaveNoMode) {
    constexpr NmeaFormat in_2_1{.version = NmeaVersion::v2_1};
    Rmc rmc;
    rmc.talker = "GP";
    Vtg vtg;
    vtg.talker = "GP";
    Gll gll;
    gll.talker = "GP";
    EXPECT_EQ(encode(rmc, in_2_1), Sentence("GPRMC,,V,,,,,,,,,").finish());
    EXPECT_EQ(encode(vtg, in_2_1), Sentence("GPVTG,,,,,,,,").finish());
    EXPECT_EQ(encode(gll, in_2_1), Sentence("GPGLL,,,,,,V").finish());
}

TEST(NmeaFormats, FollowTheMaker) {
    constexpr NmeaFormat maker{.version = NmeaVersion::v2_3,
                               .speed_decimals = 2,
                               .course_decimals = 1,
                               .dop_decimals = 1,
                               .satellites_padded = false,
                               .no_station = "0000"};
    Rmc rmc;
    rmc.speed = MetresPerSecond(10);
    rmc.course = Angle::degrees(77.77);
    EXPECT_THAT(encode(rmc, maker), StartsWith("$GNRMC,,V,,,,,19.44,77.8,,,,*"));
    Gga gga;
    gga.satellites_used = 7;
    gga.hdop = 1.26;
    EXPECT_THAT(encode(gga, maker), StartsWith("$GNGGA,,,,,,0,7,1.3,,,,,,0000*"));
    gga.correction_station = 41;
    EXPECT_THAT(encode(gga, maker), HasSubstr(",0041*"));
}

TEST(NmeaTxt, EscapesWhatWouldEndTheSentence) {
    EXPECT_EQ(encode(Txt{"GN", 1, 1, 0, "txbuf alloc"}, in_4_0), "$GNTXT,01,01,00,txbuf alloc*61\r\n");
    EXPECT_THAT(encode(Txt{"GN", 1, 1, 2, "a,b*c\n"}, in_4_0), StartsWith("$GNTXT,01,01,02,a^2Cb^2Ac^0A*"));
}

}  // namespace
}  // namespace skyloop
