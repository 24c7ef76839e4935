#include "world/rinex/rinex_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/time/utc_time.hpp"
#include "support/oracle_table.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop::test {
namespace {

namespace fs = std::filesystem;

KeplerEphemeris kepler(Constellation system, int number, NavigationMessage message) {
    KeplerEphemeris e;
    e.satellite = {system, number};
    e.message = message;
    e.toc = gps_calendar_time(2024, 3, 5, 11, 59, 44) + std::chrono::seconds(message == NavigationMessage::d1 ? 14 : 0);
    e.toe = gps_calendar_time(2024, 3, 5, 12, 0, 0) + std::chrono::seconds(message == NavigationMessage::d1 ? 14 : 0);
    e.sqrt_a = 5153.6543210987;
    e.e = 0.0112233445566;
    e.i0 = 0.96;
    e.m0 = -3.1;
    e.af0 = -1.23456789012e-4;
    e.tgd = -1.1e-8;
    e.tgd2 = 2.2e-9;
    e.iode = 87;
    e.iodc = 3;
    e.health = 1;
    e.accuracy_m = 2.4;
    return e;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1)
        lines.push_back(text.substr(at, text.find('\n', at) - at));
    return lines;
}

TEST(NavigationWriter, WritesTheHeader) {
    NavigationTextHeader header;
    header.ionosphere.gps =
        KlobucharCoefficients{{4.6566e-9, 1.4901e-8, -5.9605e-8, -1.1921e-7}, {81920, 98304, -65536, 0}};
    header.ionosphere.galileo = std::array{129.0, -0.59375, 6.1035e-4};
    header.ionosphere.beidou = header.ionosphere.gps;
    header.ionosphere.qzss = header.ionosphere.gps;
    header.leap_seconds = 18;
    header.program = "skyloop 9.9.9";
    header.date = gps_calendar_time(2024, 3, 5, 12, 0, 18);
    const auto lines = lines_of(navigation_header_text(header));
    ASSERT_EQ(lines.size(), 11u);
    for (const std::string& line : lines)
        EXPECT_EQ(line.size(), 80u);
    EXPECT_EQ(lines[0], "     3.04           N: GNSS NAV DATA    M: MIXED            RINEX VERSION / TYPE");
    EXPECT_EQ(lines[1], "skyloop 9.9.9                           20240305 120000 UTC PGM / RUN BY / DATE ");
    EXPECT_EQ(lines[2], "GPSA   4.6566D-09  1.4901D-08 -5.9605D-08 -1.1921D-07       IONOSPHERIC CORR    ");
    EXPECT_EQ(lines[3], "GPSB   8.1920D+04  9.8304D+04 -6.5536D+04  0.0000D+00       IONOSPHERIC CORR    ");
    EXPECT_EQ(lines[4], "GAL    1.2900D+02 -5.9375D-01  6.1035D-04                   IONOSPHERIC CORR    ");
    EXPECT_EQ(lines[5].substr(0, 4), "BDSA");
    EXPECT_EQ(lines[8].substr(0, 4), "QZSB");
    EXPECT_EQ(lines[9], "    18                                                      LEAP SECONDS        ");
}

TEST(NavigationWriter, WritesEachSystemInItsOwnTime) {
    const GpsTime sent = gps_calendar_time(2024, 3, 5, 10, 0, 0);
    auto gps = lines_of(navigation_record_text(kepler(Constellation::gps, 7, NavigationMessage::lnav), sent));
    ASSERT_EQ(gps.size(), 8u);
    EXPECT_EQ(gps[0], "G07 2024 03 05 11 59 44-1.234567890120D-04 0.000000000000D+00 0.000000000000D+00");
    EXPECT_EQ(gps[3].substr(4, 19), " 2.160000000000D+05");
    EXPECT_EQ(gps[5].substr(42, 19), " 2.304000000000D+03");
    EXPECT_EQ(gps[6].substr(61, 19), " 3.000000000000D+00");
    EXPECT_EQ(gps[7].substr(4, 19), " 2.088000000000D+05") << "two hours before toe";

    auto inav = lines_of(navigation_record_text(kepler(Constellation::galileo, 5, NavigationMessage::inav)));
    EXPECT_EQ(inav[5].substr(23, 38), " 5.170000000000D+02 2.304000000000D+03");
    EXPECT_EQ(inav[6].substr(42, 38), "-1.100000000000D-08 2.200000000000D-09");
    auto fnav = lines_of(navigation_record_text(kepler(Constellation::galileo, 5, NavigationMessage::fnav)));
    EXPECT_EQ(fnav[5].substr(23, 19), " 2.580000000000D+02");

    auto beidou = lines_of(navigation_record_text(kepler(Constellation::beidou, 30, NavigationMessage::d1)));
    EXPECT_EQ(beidou[0].substr(0, 23), "C30 2024 03 05 11 59 44");
    EXPECT_EQ(beidou[3].substr(4, 19), " 2.160000000000D+05");
    EXPECT_EQ(beidou[5].substr(42, 19), " 9.480000000000D+02");
    EXPECT_EQ(beidou[7].substr(23, 19), " 3.000000000000D+00");

    GlonassEphemeris glonass;
    glonass.satellite = {Constellation::glonass, 3};
    glonass.toe = gps_calendar_time(2024, 3, 5, 12, 15, 18);
    glonass.position_m = {12345678.9, -2345678.9, 22000000};
    glonass.clock_bias = -1e-5;
    glonass.frequency_channel = -4;
    auto r = lines_of(navigation_record_text(glonass));
    ASSERT_EQ(r.size(), 4u);
    EXPECT_EQ(r[0], "R03 2024 03 05 12 15 00-1.000000000000D-05 0.000000000000D+00 2.169000000000D+05");
    EXPECT_EQ(r[1].substr(4, 19), " 1.234567890000D+04");
    EXPECT_EQ(r[2].substr(61, 19), "-4.000000000000D+00");

    SbasEphemeris sbas;
    sbas.satellite = {Constellation::sbas, 36};
    sbas.toe = gps_calendar_time(2024, 3, 5, 12, 0, 16);
    sbas.iode = 77;
    auto s = lines_of(navigation_record_text(sbas));
    EXPECT_EQ(s[0].substr(0, 23), "S36 2024 03 05 12 00 16");
    EXPECT_EQ(s[3].substr(61, 19), " 7.700000000000D+01");
}

// Whether two numbers are the same to the thirteen digits of the format.
bool same(double a, double b) { return std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b)); }
template <class Numbers>
bool all_same(const Numbers& a, const Numbers& b) {
    return std::equal(std::begin(a), std::end(a), std::begin(b), same);
}

// Version 3.04 has no place for the name of a modern message and its rates.
bool same_record(const KeplerEphemeris& a, const KeplerEphemeris& b) {
    const auto numbers = [](const KeplerEphemeris& e) {
        return std::array{e.sqrt_a,  e.e,   e.i0,  e.idot, e.omega0,     e.omega,         e.omega_dot, e.m0,
                          e.delta_n, e.cuc, e.cus, e.crc,  e.crs,        e.cic,           e.cis,       e.af0,
                          e.af1,     e.af2, e.tgd, e.tgd2, e.accuracy_m, e.fit_interval_h};
    };
    return a.satellite == b.satellite && (a.message == b.message || a.message == NavigationMessage::modern) &&
           a.toe == b.toe && a.toc == b.toc && a.iode == b.iode && a.iodc == b.iodc && a.health == b.health &&
           all_same(numbers(a), numbers(b));
}
template <class StateVector>
bool same_motion(const StateVector& a, const StateVector& b) {
    return a.satellite == b.satellite && a.toe == b.toe && a.health == b.health && a.iode == b.iode &&
           all_same(a.position_m, b.position_m) && all_same(a.velocity_mps, b.velocity_mps) &&
           all_same(a.acceleration_mps2, b.acceleration_mps2) && same(a.clock_bias, b.clock_bias) &&
           same(a.clock_drift, b.clock_drift);
}
// Version 3.04 has no place for the delay of L2 and the accuracy.
bool same_record(const GlonassEphemeris& a, const GlonassEphemeris& b) {
    return same_motion(a, b) && a.frequency_channel == b.frequency_channel;
}
bool same_record(const SbasEphemeris& a, const SbasEphemeris& b) {
    return same_motion(a, b) && same(a.accuracy_m, b.accuracy_m);
}
bool same_ephemeris(const Ephemeris& a, const Ephemeris& b) {
    return a.index() == b.index() &&
           std::visit([&](const auto& r) { return same_record(r, std::get<std::decay_t<decltype(r)>>(b)); }, a);
}

void expect_round_trip(const std::vector<Ephemeris>& records, const NavigationTextHeader& header,
                       const std::string& name) {
    const std::string text = navigation_text(records, header);
    const auto again = read_navigation(text, name);
    ASSERT_TRUE(again) << again.error().message;
    ASSERT_EQ(again->records.size(), records.size()) << name << (again->warnings.empty() ? "" : again->warnings[0]);
    std::size_t different = 0;
    for (std::size_t i = 0; i < records.size(); ++i)
        if (!same_ephemeris(records[i], again->records[i]) && different++ == 0)
            ADD_FAILURE() << name << ": record " << i << ":\n"
                          << navigation_record_text(records[i]) << navigation_record_text(again->records[i]);
    EXPECT_EQ(different, 0u) << name;
    EXPECT_TRUE(navigation_text(again->records, header) == text) << name << ": a second writing differs";
}

TEST(NavigationWriter, LosesNothingOfAnyRealFile) {
    SKYLOOP_REQUIRE_SHARED(nav, "nav");
    int files = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(nav)) {
        if (!entry.is_regular_file()) continue;
        const auto file = read_navigation_file(entry.path());
        if (!file) continue;
        NavigationTextHeader header{file->ionosphere, file->leap_seconds, "skyloop", toe_of(file->records.front())};
        expect_round_trip(file->records, header, entry.path().filename().string());
        ++files;
    }
    EXPECT_EQ(files, 34);
}

TEST(NavigationWriter, LosesNothingOfTheNextCentury) {
    KeplerEphemeris record = kepler(Constellation::gps, 7, NavigationMessage::lnav);
    record.tgd2 = 0;
    record.toc = record.toe = gps_calendar_time(2150, 1, 1, 2, 0, 0);
    const std::vector<Ephemeris> records{record};
    const auto again = read_navigation(navigation_text(records, {}), "a.nav");
    ASSERT_TRUE(again) << again.error().message;
    ASSERT_EQ(again->records.size(), 1u);
    EXPECT_TRUE(same_ephemeris(record, again->records[0])) << navigation_record_text(again->records[0]);
}

// Moved to a day before the first week of BeiDou's time, which then counts backwards.
TEST(NavigationWriter, LosesNothingOfBeidouBefore2006) {
    KeplerEphemeris record = kepler(Constellation::beidou, 30, NavigationMessage::d1);
    record.toc = record.toe = gps_calendar_time(2005, 6, 1, 12, 0, 14);
    const std::vector<Ephemeris> records{record};
    const std::string text = navigation_text(records, {});
    EXPECT_NE(text.find("-3.100000000000D+01"), std::string::npos) << text;
    const auto again = read_navigation(text, "a.nav");
    ASSERT_TRUE(again) << again.error().message;
    ASSERT_EQ(again->records.size(), 1u);
    EXPECT_TRUE(same_ephemeris(record, again->records[0])) << navigation_record_text(again->records[0]);
}

TEST(NavigationWriter, LosesNothingOfMadeUpRecords) {
    std::vector<Ephemeris> records{kepler(Constellation::gps, 7, NavigationMessage::lnav),
                                   kepler(Constellation::qzss, 2, NavigationMessage::lnav),
                                   kepler(Constellation::galileo, 5, NavigationMessage::inav),
                                   kepler(Constellation::galileo, 5, NavigationMessage::fnav),
                                   kepler(Constellation::beidou, 30, NavigationMessage::d1)};
    for (Ephemeris& record : records) {
        auto& k = std::get<KeplerEphemeris>(record);
        k.cuc = 1e-300;  // no field has room for such an exponent
        const bool shared =
            k.satellite.constellation == Constellation::gps || k.satellite.constellation == Constellation::qzss;
        if (shared) k.tgd2 = 0;
        if (k.satellite.constellation == Constellation::galileo) k.iodc = 0;
    }
    const auto again = read_navigation(navigation_text(records, {}), "a.nav");
    ASSERT_TRUE(again) << again.error().message;
    for (std::size_t i = 0; i < records.size(); ++i) {
        EXPECT_EQ(std::get<KeplerEphemeris>(again->records.at(i)).cuc, 0);
        std::get<KeplerEphemeris>(records[i]).cuc = 0;
        EXPECT_TRUE(same_ephemeris(records[i], again->records[i])) << navigation_record_text(again->records[i]);
    }
}

}  // namespace
}  // namespace skyloop::test
