// UBX logs as files of fixes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "base/core/bytes.hpp"
#include "base/time/utc_time.hpp"
#include "study/analysis/fix_series.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A message with its head and checksum; `payload` may be changed field by field before.
struct UbxMessage {
    std::uint8_t id;
    std::string payload;

    UbxMessage(std::uint8_t message_id, std::size_t length) : id(message_id), payload(length, '\0') {}
    UbxMessage& put(std::size_t at, std::int64_t value, std::size_t bytes) {
        for (std::size_t i = 0; i < bytes; ++i)
            payload[at + i] = static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xff);
        return *this;
    }
    [[nodiscard]] std::string bytes() const {
        std::string body{'\x01', static_cast<char>(id), static_cast<char>(payload.size() & 0xff),
                         static_cast<char>(payload.size() >> 8)};
        body += payload;
        unsigned a = 0, b = 0;
        for (const char c : body) {
            a = (a + static_cast<unsigned char>(c)) & 0xff;
            b = (b + a) & 0xff;
        }
        return "\xB5\x62" + body + static_cast<char>(a) + static_cast<char>(b);
    }
};

constexpr std::int64_t friday_noon_ms = 475218000;  // 2018-10-19T12:00:00Z of GPS week 2023

UbxMessage pvt(std::int64_t itow_ms, double height_m, std::size_t length = 92) {
    UbxMessage m(0x07, length);
    m.put(0, itow_ms, 4).put(4, 2018, 2).put(6, 10, 1).put(7, 19, 1).put(8, 12, 1).put(11, 7, 1);
    m.put(20, 3, 1).put(21, 1, 1).put(23, 17, 1);
    return m.put(24, -89825093, 4).put(28, 532826311, 4).put(32, std::llround(height_m * 1000), 4);
}

UbxMessage posllh(std::int64_t itow_ms, double height_m) {
    return UbxMessage(0x02, 28)
        .put(0, itow_ms, 4)
        .put(4, 307326000, 4)
        .put(8, 464775000, 4)
        .put(12, std::llround(height_m * 1000), 4);
}

double height(const FixSample& sample) { return sample.position.height.above_ellipsoid.value(); }

TEST(UbxLog, nav_pvt_gives_place_time_and_satellites) {
    const auto series =
        parse_fix_series(pvt(friday_noon_ms, 93.5).bytes() + pvt(friday_noon_ms + 200, 93.75, 84).bytes(), "log.ubx");
    ASSERT_TRUE(series) << series.error().message;
    ASSERT_EQ(series->fixes(), 2u);
    const FixSample& first = series->samples[0];
    EXPECT_NEAR(first.position.latitude.deg(), 53.2826311, 1e-9);
    EXPECT_NEAR(first.position.longitude.deg(), -8.9825093, 1e-9);
    EXPECT_DOUBLE_EQ(height(first), 93.5);
    EXPECT_DOUBLE_EQ(height(series->samples[1]), 93.75);
    EXPECT_EQ(first.satellites_used, 17);
    EXPECT_TRUE(series->dated);
    EXPECT_EQ(first.time, to_gps_time(2023, 475218.0));
    EXPECT_EQ(utc_text(*first.time), "2018-10-19T12:00:00Z");
    EXPECT_EQ(series->interval, Seconds(0.2));
    EXPECT_TRUE(series->warnings.empty());
}

TEST(UbxLog, only_flagged_positions_are_fixes) {
    const std::string log = pvt(1000, 1).bytes() + pvt(2000, 2).put(21, 0, 1).bytes() +  // gnssFixOK is off
                            pvt(3000, 3).put(20, 0, 1).bytes() + pvt(4000, 4).put(20, 5, 1).bytes() +
                            pvt(5000, 5).put(78, 1, 1).bytes() +  // invalidLlh
                            pvt(6000, 6).put(20, 4, 1).bytes();
    const auto series = parse_fix_series(log, "log.ubx");
    ASSERT_TRUE(series) << series.error().message;
    std::vector<bool> fixes;
    for (const FixSample& sample : series->samples)
        fixes.push_back(sample.has_fix);
    EXPECT_THAT(fixes, ElementsAre(true, false, false, false, false, true));
    EXPECT_THAT(series->warnings, ElementsAre(HasSubstr("1 epochs with a time-only fix"),
                                              HasSubstr("1 epochs have a fix and no sensible place")));
}

TEST(UbxLog, nav_sol_is_earth_centred_and_knows_the_week) {
    const Eigen::Vector3d place = to_ecef(Geodetic::degrees(46.4775, 30.7326, 77)).vector();
    UbxMessage sol(0x06, 52);
    sol.put(0, 86400000, 4).put(8, 1727, 2).put(10, 3, 1).put(11, 0x0D, 1).put(47, 9, 1);
    for (int i = 0; i < 3; ++i)
        sol.put(static_cast<std::size_t>(12 + 4 * i), std::llround(place[i] * 100), 4);
    const auto series = parse_fix_series(sol.bytes(), "log.ubx");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_NEAR(series->samples[0].position.latitude.deg(), 46.4775, 1e-7);
    EXPECT_NEAR(height(series->samples[0]), 77, 0.01);
    EXPECT_EQ(series->samples[0].time, to_gps_time(1727, 86400.0));
    EXPECT_EQ(series->samples[0].satellites_used, 9);
}

TEST(UbxLog, nav_posllh_takes_status_week_and_finer_digits_from_its_epoch) {
    const std::string status = UbxMessage(0x03, 16).put(0, 7000, 4).put(4, 3, 1).put(5, 1, 1).bytes();
    const std::string no_fix = UbxMessage(0x03, 16).put(0, 8000, 4).put(4, 0, 1).bytes();
    const std::string week = UbxMessage(0x20, 16).put(0, 8000, 4).put(8, 2304, 2).put(11, 7, 1).bytes();
    UbxMessage precise(0x14, 36);
    precise.put(4, 7000, 4).put(8, 307326000, 4).put(12, 464775000, 4).put(16, 77000, 4);
    precise.put(24, -50, 1).put(25, 25, 1).put(26, 9, 1);
    const auto series = parse_fix_series(
        posllh(7000, 77).bytes() + precise.bytes() + status + posllh(8000, 78).bytes() + no_fix + week, "log.ubx");
    ASSERT_TRUE(series) << series.error().message;
    ASSERT_EQ(series->samples.size(), 2u);
    EXPECT_TRUE(series->samples[0].has_fix);
    EXPECT_NEAR(series->samples[0].position.latitude.deg(), 46.477500025, 1e-11);
    EXPECT_NEAR(series->samples[0].position.longitude.deg(), 30.73259995, 1e-11);
    EXPECT_NEAR(height(series->samples[0]), 77.0009, 1e-9);
    EXPECT_FALSE(series->samples[1].has_fix);
    EXPECT_EQ(series->samples[0].time, to_gps_time(2304, 7.0));
    const auto bare = parse_fix_series(posllh(7000, 77).bytes() + posllh(8000, 78).bytes(), "log.ubx");
    ASSERT_TRUE(bare) << bare.error().message;
    EXPECT_FALSE(bare->dated);
    EXPECT_EQ(bare->interval, Seconds(1));
    EXPECT_THAT(bare->warnings, ElementsAre(HasSubstr("2 positions without a message that tells")));
}

TEST(UbxLog, the_end_of_a_week_does_not_turn_time_back) {
    const std::string week = UbxMessage(0x20, 16).put(0, 604799000, 4).put(8, 2304, 2).put(11, 7, 1).bytes();
    for (const std::string& mark : {std::string(), week}) {
        const auto series = parse_fix_series(posllh(604798000, 1).bytes() + mark + posllh(604799000, 1).bytes() +
                                                 posllh(0, 1).bytes() + posllh(1000, 1).bytes(),
                                             "log.ubx");
        ASSERT_TRUE(series) << series.error().message;
        EXPECT_EQ(series->dated, !mark.empty());
        ASSERT_EQ(series->samples.size(), 4u);
        for (std::size_t i = 1; i < 4; ++i)
            EXPECT_EQ(*series->samples[i].time - *series->samples[i - 1].time, std::chrono::seconds(1)) << i;
        if (!mark.empty()) {
            EXPECT_EQ(series->samples[3].time, to_gps_time(2305, 1.0));
        }
    }
}

TEST(UbxLog, satellites_come_from_nav_sat_else_nav_svinfo) {
    UbxMessage svinfo(0x30, 8 + 2 * 12);
    svinfo.put(0, 9000, 4).put(4, 2, 1);
    svinfo.put(8 + 1, 5, 1).put(20 + 1, 6, 1);
    svinfo.put(8 + 2, 1, 1).put(8 + 4, 40, 1).put(8 + 5, 45, 1);
    svinfo.put(20 + 4, 0, 1).put(20 + 5, 45, 1);  // not tracked
    const auto old = parse_fix_series(posllh(9000, 1).bytes() + svinfo.bytes(), "log.ubx");
    ASSERT_TRUE(old) << old.error().message;
    EXPECT_EQ(old->signal_strength().bin(4).n(), 1u);
    EXPECT_DOUBLE_EQ(old->signal_strength().bin(4).mean(), 40);
    EXPECT_EQ(old->samples[0].satellites_used, 1);
    UbxMessage sat(0x35, 8 + 3 * 12);
    sat.put(0, 9000, 4).put(4, 1, 1).put(5, 3, 1);
    for (std::size_t i = 0; i < 3; ++i)
        sat.put(8 + 12 * i + 1, 5 + static_cast<std::int64_t>(i), 1)
            .put(8 + 12 * i + 2, 30 + 10 * static_cast<std::int64_t>(i), 1)
            .put(8 + 12 * i + 8, 8, 1);
    sat.put(8 + 3, 5, 1).put(20 + 3, -91, 1).put(32 + 3, 90, 1);  // an elevation that is not known
    const auto both = parse_fix_series(posllh(9000, 1).bytes() + svinfo.bytes() + sat.bytes(), "log.ubx");
    ASSERT_TRUE(both) << both.error().message;
    EXPECT_EQ(both->signal_strength().bin(0).n(), 1u);
    EXPECT_EQ(both->signal_strength().bin(4).n(), 0u);
    EXPECT_DOUBLE_EQ(both->signal_strength().bin(8).mean(), 50);
    // What is told beside no position, and behind the last one, is counted, too, with the nearest.
    const auto apart = parse_fix_series(
        svinfo.bytes() + posllh(9200, 1).bytes() + posllh(9400, 1).bytes() + UbxMessage(svinfo).put(0, 9600, 4).bytes(),
        "log.ubx");
    ASSERT_TRUE(apart);
    EXPECT_EQ(apart->signal_strength().bin(4).n(), 2u);
    EXPECT_EQ(slice(*apart, {1, 1, 1}).signal_strength().bin(4).n(), 1u);
    EXPECT_EQ(both->samples[0].satellites_used, 3);
}

TEST(UbxLog, damage_is_counted_and_the_next_message_found) {
    std::string broken = pvt(2000, 2).bytes();
    broken[40] = static_cast<char>(broken[40] ^ 1);
    const std::string log = "$GNGGA,120000.00,,,,,0,00,99.99,,,,,,*70\r\n\xD3\x13noise\xB5" + pvt(1000, 1).bytes() +
                            broken + "\xB5\x62" + pvt(3000, 3).bytes() + UbxMessage(0x07, 50).bytes() +
                            pvt(4000, 4).put(28, 950000000, 4).bytes() + pvt(5000, 5).bytes().substr(0, 60);
    const auto series = parse_fix_series(log, "log.ubx");
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->fixes(), 2u);
    EXPECT_EQ(series->samples.size(), 3u);
    EXPECT_THAT(series->warnings, ElementsAre(HasSubstr("log.ubx: 1 UBX messages of a wrong length or time of week"),
                                              HasSubstr("3 UBX messages with a wrong checksum or a cut end"),
                                              HasSubstr("1 GGA, GNS or RMC sentences with a wrong checksum"),
                                              HasSubstr("1 epochs have a fix and no sensible place")));
}

TEST(UbxLog, truncation_anywhere_and_hostile_lengths_never_crash) {
    const std::string whole = pvt(1000, 1).bytes() + posllh(2000, 2).bytes();
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const auto series = parse_fix_series(whole.substr(0, length), "cut");
        EXPECT_TRUE(series || series.error().message.find("cut") != std::string::npos) << length;
    }
    std::string endless;
    for (int i = 0; i < 300000; ++i)
        endless += "\xB5\x62\xB5\x62\xFF\xEF";
    EXPECT_FALSE(parse_fix_series(endless, "cut"));
}

TEST(UbxLog, of_the_real_m8p_gives_the_measured_figures) {
    SKYLOOP_REQUIRE_SHARED(log, "receivers/galway_20181015_m8p_static/base-20181015-1654.ubx.gz");
    const auto series = read_fix_series(log);
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->samples.size(), 3687u);
    EXPECT_EQ(series->fixes(), 2555u);
    EXPECT_EQ(utc_text(*series->samples[0].time).substr(0, 13), "2018-10-15T16");
    // MEASURED.md, C/N0 by elevation: mean and standard deviation.
    constexpr std::array<std::array<double, 2>, 8> measured{
        {{18.7, 7.3}, {27.4, 7.7}, {31.4, 8.6}, {38.3, 8.0}, {42.3, 4.3}, {46.9, 2.3}, {48.9, 1.1}, {47.8, 1.1}}};
    for (std::size_t i = 0; i < measured.size(); ++i) {
        EXPECT_NEAR(series->signal_strength().bin(i).mean(), measured[i][0], 0.06) << i;
        EXPECT_NEAR(series->signal_strength().bin(i).std(), measured[i][1], 0.06) << i;
    }
}

TEST(UbxLog, of_the_real_f9t_gives_the_measured_signal_strengths) {
    SKYLOOP_REQUIRE_SHARED(log, "receivers/bend_f9t/F9T-L2-5min.ubx.gz");
    const auto series = read_fix_series(log);
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->fixes(), 299u);
    struct Bin {
        std::size_t index;
        double mean, std;
    };
    for (const Bin& bin : {Bin{0, 25.7, 6.8}, Bin{1, 30.8, 7.2}, Bin{2, 34.3, 7.6}, Bin{3, 42.0, 3.3},
                           Bin{4, 45.4, 2.0}, Bin{6, 45.0, 2.6}}) {
        EXPECT_NEAR(series->signal_strength().bin(bin.index).mean(), bin.mean, 0.06) << bin.index;
        EXPECT_NEAR(series->signal_strength().bin(bin.index).std(), bin.std, 0.06) << bin.index;
    }
}

// A program polls a fix or two over UBX from a receiver that says everything else in NMEA.
TEST(UbxLog, a_few_polled_messages_do_not_hide_a_log_of_nmea) {
    const std::string gga = "$GPGGA,120000.00,4628.650,N,03043.956,E,1,08,1.0,50.5,M,30.5,M,,*55\r\n";
    std::string log = pvt(friday_noon_ms, 100).bytes() + gga + gga + gga + gga + gga;
    const auto nmea = parse_fix_series(log, "log.ubx");
    ASSERT_TRUE(nmea) << nmea.error().message;
    EXPECT_EQ(nmea->fixes(), 5u);
    EXPECT_THAT(nmea->warnings,
                ElementsAre("log.ubx: 5 epochs of NMEA and 1 of UBX have a place; those of NMEA are taken"));
    log += pvt(friday_noon_ms + 1000, 100).bytes() + pvt(friday_noon_ms + 2000, 100).bytes();
    const auto ubx = parse_fix_series(log, "log.ubx");
    ASSERT_TRUE(ubx) << ubx.error().message;
    EXPECT_EQ(ubx->fixes(), 3u);
    EXPECT_THAT(ubx->warnings,
                ElementsAre("log.ubx: 5 epochs of NMEA and 3 of UBX have a place; those of UBX are taken"));
}

}  // namespace
}  // namespace skyloop
