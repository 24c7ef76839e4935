// gpsd, NMEA and UBX of another receiver.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dialect_bytes.hpp"
#include "dialect_pose.hpp"
#include "motion/trajectory/live_path.hpp"
#include "receiver/protocol/ubx_inertial.hpp"
#include "run/feed/feed_dialect.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;
using Pose = NorthEastClimb;
// 2026-11-20T12:34:56Z in GPS time: 17120 days and 45 296 s after 1980-01-06, and 18 leap seconds.
constexpr std::int64_t gps_s = 17120LL * 86400 + 45296 + 18;

std::string tpv(std::string_view time, std::string_view more, int mode = 3) {
    return fmt::format(
        "{{\"class\":\"TPV\",\"device\":\"/dev/pts/3\",\"mode\":{},\"time\":\"{}\",\"lat\":47.3977,"
        "\"lon\":8.5456{}}}\r\n",
        mode, time, more);
}

TEST(GpsdDialect, ReadsPositionsWithTheAttitudeThatCameBefore) {
    const auto dialect = dialect_named("gpsd");
    hear_text(*dialect, "{\"class\":\"ATT\",\"device\":\"/dev/pts/3\",\"roll\":20,\"pitch\":10,\"heading\":53.13}\n");
    const FeedNews news = hear_text(
        *dialect, tpv("2026-11-20T12:34:56.000Z",
                      ",\"altHAE\":510,\"altMSL\":463,\"geoidSep\":44,\"speed\":5,\"track\":53.130102,\"climb\":2"));
    ASSERT_EQ(news.samples.size(), 1u) << news.refusal;
    expect_pose(news.samples[0], {1e-9, 1e-6, 1e-6, 1e-9, 0, true, false});
    EXPECT_EQ(news.samples[0].source_time, Nanoseconds(gps_s * 1'000'000'000));
}

TEST(GpsdDialect, TakesTheFirstWholeReportOfAnEpochAndTheLastHeight) {
    const auto dialect = dialect_named("gpsd");
    const std::string velocity = ",\"velN\":3,\"velE\":4,\"velD\":-2";
    EXPECT_EQ(hear_text(*dialect, tpv("2026-11-20T12:34:56.000Z", ",\"altHAE\":510" + velocity)).samples.size(), 1u);
    const FeedNews again = hear_text(*dialect, tpv("2026-11-20T12:34:56.000Z", ",\"altHAE\":510"));
    EXPECT_TRUE(again.samples.empty());
    EXPECT_EQ(again.refused, 0u);
    // A fix in two dimensions is told when no height has come with it; those behind it at once.
    EXPECT_TRUE(hear_text(*dialect, tpv("2026-11-20T12:34:56.200Z", velocity, 2)).samples.empty());
    const FeedNews two = hear_text(*dialect, tpv("2026-11-20T12:34:56.400Z", velocity, 2));
    ASSERT_EQ(two.samples.size(), 2u);
    expect_pose(two.samples[0], {1e-9, 1e-6, 1e-9, 0, 0, false, false});
    EXPECT_EQ(two.samples[0].source_time, Nanoseconds(gps_s * 1'000'000'000 + 200'000'000));
    EXPECT_EQ(two.samples[1].source_time, Nanoseconds(gps_s * 1'000'000'000 + 400'000'000));
    EXPECT_EQ(hear_text(*dialect, tpv("2026-11-20T12:34:56.600Z", velocity, 2)).samples.size(), 1u);
}

TEST(GpsdDialect, MergesTheReportsOfAnEpoch) {
    const auto dialect = dialect_named("gpsd");
    const std::string speed = ",\"speed\":5,\"track\":53.130102", rest = ",\"altHAE\":510,\"climb\":2";
    for (const char* time : {"2026-11-20T12:34:56.000Z", "2026-11-20T12:34:57.000Z", "2026-11-20T12:34:58.000Z"}) {
        EXPECT_TRUE(hear_text(*dialect, tpv(time, speed, 2)).samples.empty()) << time;
        const FeedNews whole = hear_text(*dialect, tpv(time, rest));
        ASSERT_EQ(whole.samples.size(), 1u) << time;
        expect_pose(whole.samples[0], {1e-9, 1e-6, 1e-6, 0, 0, false, false});
        EXPECT_EQ(hear_text(*dialect, tpv(time, speed + rest)).samples.size(), 0u) << time;
    }
    // Without a time nothing tells what belongs together.
    EXPECT_EQ(hear_text(*dialect, tpv("", speed + rest)).samples.size(), 1u);
    EXPECT_EQ(hear_text(*dialect, tpv("", speed, 2)).samples.size(), 1u);
}

TEST(GpsdDialect, RefusesPlacesWithoutAHeightWhenNoneComes) {
    const auto dialect = dialect_named("gpsd");
    EXPECT_EQ(hear_text(*dialect, tpv("2026-11-20T12:34:56.000Z", "", 2)).refused, 0u);
    EXPECT_EQ(hear_text(*dialect, tpv("2026-11-20T12:34:57.000Z", "", 2)).refused, 2u);
    EXPECT_THAT(hear_text(*dialect, tpv("2026-11-20T12:34:58.000Z", "", 2)).refusal, HasSubstr("no height"));
}

TEST(GpsdDialect, WatchesUntilItIsWatched) {
    const auto dialect = dialect_named("gpsd");
    ASSERT_EQ(dialect->say().size(), 1u);
    EXPECT_EQ(to_string(dialect->say()[0]), "?WATCH={\"enable\":true,\"json\":true};\n");
    hear_text(*dialect, "{\"class\":\"WATCH\",\"enable\":true}\n");
    EXPECT_TRUE(dialect->say().empty());
    dialect->reconnected();
    EXPECT_EQ(dialect->say().size(), 1u);
}

TEST(GpsdDialect, RefusesWhatTellsNoPlace) {
    const auto dialect = dialect_named("gpsd");
    EXPECT_THAT(hear_text(*dialect, tpv("2026-11-20T12:34:56Z", ",\"altHAE\":1", 1)).refusal, HasSubstr("no fix"));
    EXPECT_THAT(hear_text(*dialect, "{\"class\":\"ERROR\",\"message\":\"bad\"}\n").refusal,
                HasSubstr("gpsd says: bad"));
    EXPECT_THAT(hear_text(*dialect, "HTTP/1.1 400\n").refusal, HasSubstr("no JSON object"));
    EXPECT_EQ(hear_text(*dialect, "{\"class\":7}\n{}\n").refused, 0u);
}

TEST(GpsdDialect, DevicesAreVehicles) {
    const auto dialect = dialect_named("gpsd");
    const std::string time = "2026-11-20T12:34:56.000Z";
    EXPECT_EQ(hear_text(*dialect, tpv(time, ",\"altHAE\":510")).samples.at(0).vehicle, "/dev/pts/3");
    std::string other = tpv("", "");
    other.replace(other.find("/dev/pts/3"), 10, "/dev/pts/4");
    EXPECT_THAT(hear_text(*dialect, other).refusal, HasSubstr("no height"));  // the height is the other's
    std::string flood;
    for (int i = 0; i < 100; ++i)
        flood += fmt::format("{{\"class\":\"ATT\",\"device\":\"{}\"}}\n", i);
    EXPECT_EQ(hear_text(*dialect, flood).refused, 38u);  // two of 64 are known
}

std::string sentence(const std::string& body) {
    unsigned sum = 0;
    for (const char c : body)
        sum ^= static_cast<unsigned char>(c);
    return fmt::format("${}*{:02X}\r\n", body, sum);
}
// 47.3977° = 47° 23.86200', 8.5456° = 8° 32.73600'; 5 m/s = 9.719222 kn; 462.5 m above a geoid 47.5 m up.
std::string rmc(const std::string& time, const std::string& date = "201126") {
    return sentence("GPRMC," + time + ",A,4723.86200,N,00832.73600,E,9.719222,53.130102," + date + ",,,A");
}
std::string gga(const std::string& time, double altitude = 462.5, const std::string& separation = "47.5,M") {
    return sentence(
        fmt::format("GPGGA,{},4723.86200,N,00832.73600,E,1,08,0.9,{:.3f},M,{},,", time, altitude, separation));
}

TEST(NmeaDialect, MergesTheSentencesOfAnEpoch) {
    const auto dialect = dialect_named("nmea");
    EXPECT_TRUE(hear_text(*dialect, rmc("123455.00") + gga("123455.00", 460.5)).samples.empty());  // more may come
    // The next epoch ends the first, and is whole with the kinds that the first had.
    const FeedNews first = hear_text(*dialect, gga("123456.00", 462.5), 5);
    ASSERT_EQ(first.samples.size(), 1u) << first.refusal;
    EXPECT_EQ(first.samples[0].source_time, Nanoseconds((gps_s - 1) * 1'000'000'000));
    ASSERT_TRUE(first.samples[0].velocity);  // one height tells no climb: it is level
    EXPECT_NEAR(first.samples[0].velocity->vector().norm(), 5, 1e-3);
    const FeedNews second = hear_text(*dialect, rmc("123456.00"), 6);
    ASSERT_EQ(second.samples.size(), 1u) << second.refusal;
    EXPECT_EQ(second.samples[0].received_ns, 6);
    EXPECT_EQ(second.samples[0].source_time, Nanoseconds(gps_s * 1'000'000'000));
    expect_pose(second.samples[0], {1e-7, 1e-3, 0.1, 0, 0, false, false});
    EXPECT_TRUE(hear_text(*dialect, sentence("GPVTG,53.1,T,,M,9.7,N,18.0,K,A")).samples.empty());
}

TEST(NmeaDialect, AnEpochThatIsSaidTwiceIsToldOnce) {
    const auto dialect = dialect_named("nmea");
    hear_text(*dialect, rmc("123455.00") + gga("123455.00"));
    const std::string epoch = rmc("123456.00") + gga("123456.00");
    EXPECT_EQ(hear_text(*dialect, epoch).samples.size(), 2u);  // the first ends, the second is whole
    EXPECT_TRUE(hear_text(*dialect, epoch + epoch).samples.empty());
}

TEST(NmeaDialect, AMovingReceiverBeginsWithoutAJump) {
    const auto dialect = dialect_named("nmea");
    LivePath path({});
    for (int i = 0; i < 10; ++i) {
        const std::string time = fmt::format("120000.{}", i);
        const std::string place = fmt::format("{:.6f},N,00832.73600,E", 4723.862 + 0.1 * i * 30 / 1852);
        const FeedNews news =
            hear_text(*dialect, sentence("GPRMC," + time + ",A," + place + ",58.315335,0.0,201126,,,A") +
                                    sentence("GPGGA," + time + "," + place + ",1,08,0.9,462.5,M,47.5,M,,"));
        for (const TruthSample& sample : news.samples)
            path.add(GpsTime(*sample.source_time), sample);
    }
    EXPECT_GE(path.counts().samples, 9U);
    EXPECT_EQ(path.counts().jumps, 0U);
}

TEST(NmeaDialect, DatagramsNeedNoLineEnds) {
    FeedContext context;
    context.datagrams = true;
    const auto bare = [](std::string text) { return text.substr(0, text.size() - 2); };
    const auto dialect = dialect_named("nmea", context);
    hear_text(*dialect, bare(rmc("120000")));
    hear_text(*dialect, bare(gga("120000")));
    hear_text(*dialect, bare(rmc("120001")));
    EXPECT_EQ(hear_text(*dialect, bare(gga("120001"))).samples.size(), 1U) << "at once";
    // Cut; and a stream that somebody sends on in pieces.
    const std::string cut = rmc("120002"), last = gga("120002");
    EXPECT_EQ(hear_text(*dialect, cut.substr(0, 30)).refused, 0U);
    EXPECT_EQ(hear_text(*dialect, rmc("120002")).refused, 1U) << "it does not swallow the next one";
    EXPECT_TRUE(hear_text(*dialect, last.substr(0, 30)).samples.empty());
    EXPECT_EQ(hear_text(*dialect, last.substr(30)).samples.size(), 1U);
    const auto stream = dialect_named("nmea");
    hear_text(*stream, bare(rmc("120000")));
    EXPECT_EQ(hear_text(*stream, rmc("120000")).refused, 0U) << "a stream has line ends";
}

TEST(NmeaDialect, TellsAMissingChecksumFromAWrongOne) {
    const auto dialect = dialect_named("nmea");
    EXPECT_THAT(hear_text(*dialect, "$GPRMC,120000,A,4723.86200,N,00832.73600,E,9.7,53.1,201126,,,A\r\n").refusal,
                HasSubstr("without a checksum"));
    EXPECT_THAT(hear_text(*dialect, "$GPRMC,120000,A,4723.86200,N,00832.73600,E,9.7,53.1,201126,,,A*00\r\n").refusal,
                HasSubstr("a wrong checksum"));
}

TEST(NmeaDialect, AHeadingIsAnAttitude) {
    const auto dialect = dialect_named("nmea");
    const auto epoch = [](const std::string& time) { return rmc(time) + gga(time) + sentence("GPHDT,53.13,T"); };
    hear_text(*dialect, epoch("123455"));
    const FeedNews news = hear_text(*dialect, epoch("123456"));
    ASSERT_EQ(news.samples.size(), 2u);
    EXPECT_NEAR(news.samples[1].attitude->yaw().deg(), 53.13, 1e-9);
}

TEST(NmeaDialect, DaysGoOnAtMidnight) {
    for (const std::string date : {"311226", ""}) {
        const auto dialect = dialect_named("nmea");
        hear_text(*dialect, rmc("235959.00", date) + gga("235959.00"));
        const FeedNews last = hear_text(*dialect, gga("000000.00"));
        const FeedNews news = hear_text(*dialect, gga("000001.00"));
        ASSERT_EQ(last.samples.size(), 1u);
        ASSERT_EQ(news.samples.size(), 2u);  // without RMC from here on: the one that ends, and the one that is whole
        EXPECT_EQ((*news.samples[0].source_time - *last.samples[0].source_time).count(), 1'000'000'000);
        EXPECT_EQ((*news.samples[1].source_time - *news.samples[0].source_time).count(), 1'000'000'000);
    }
}

TEST(NmeaDialect, HeightsFollowTheSentencesOwnGeoidOrTheScenarios) {
    const auto height = [](const std::string& separation, SeaLevel sea_level) {
        FeedContext context;
        context.sea_level = sea_level;
        const auto dialect = dialect_named("nmea", context);
        hear_text(*dialect, gga("120000", 462.5, separation));
        return to_geodetic(hear_text(*dialect, gga("120001", 462.5, separation)).samples.at(0).position)
            .height.above_ellipsoid.value();
    };
    EXPECT_NEAR(height("47.5,M", SeaLevel::ellipsoid), 510, 1e-6);
    EXPECT_NEAR(height(",", SeaLevel::ellipsoid), 462.5, 1e-6);
    EXPECT_NEAR(height("0.0,M", SeaLevel::ellipsoid), 462.5, 1e-6);
}

TEST(NmeaDialect, SmoothingTakesTheNoiseAway) {
    FeedContext context;
    context.smooth = true;
    const auto dialect = dialect_named("nmea", context);
    double worst = 0;
    for (int i = 0; i < 60; ++i) {
        const double noise = i % 2 == 0 ? 1 : -1;  // m
        const auto news = hear_text(*dialect, gga(fmt::format("1200{:02}", i), 462.5 + noise) +
                                                  sentence(fmt::format("GPVTG,0,T,,M,0,N,0,K,A")));
        if (i > 20)
            worst = std::max(worst,
                             std::abs(to_geodetic(news.samples.at(0).position).height.above_ellipsoid.value() - 510));
    }
    EXPECT_LT(worst, 0.8);
}

TEST(NmeaDialect, RefusesLostFixesMissingHeightsAndWrongChecksums) {
    const auto dialect = dialect_named("nmea");
    hear_text(*dialect, rmc("120000"));
    EXPECT_THAT(hear_text(*dialect, rmc("120001")).refusal, HasSubstr("without a height"));
    hear_text(*dialect, sentence("GPRMC,120002,V,,,,,,,201126,,,N"));
    EXPECT_THAT(hear_text(*dialect, rmc("120003")).refusal, HasSubstr("without a height"));
    std::string wrong = gga("120004");
    wrong[20] ^= 1;
    EXPECT_THAT(hear_text(*dialect, wrong).refusal, HasSubstr("checksum"));
    EXPECT_EQ(hear_text(*dialect, sentence("GPXYZ,1,2,3")).refused, 0u);
    const auto lost = dialect_named("nmea");
    hear_text(*lost, gga("120000") + gga("120001"));
    EXPECT_THAT(hear_text(*lost, sentence("GPGGA,120002,,,,,0,00,,,M,,M,,")).refusal, HasSubstr("no fix"));
}

Bytes ubx(std::uint8_t id, const HandBytes& payload) {
    const Bytes& body = payload.bytes();
    Bytes frame{0xB5, 0x62, 1, id, static_cast<std::uint8_t>(body.size()), static_cast<std::uint8_t>(body.size() >> 8)};
    frame.insert(frame.end(), body.begin(), body.end());
    unsigned a = 0, b = 0;
    for (std::size_t i = 2; i < frame.size(); ++i)
        a = (a + frame[i]) & 0xFF, b = (b + a) & 0xFF;
    frame.push_back(static_cast<std::uint8_t>(a));
    frame.push_back(static_cast<std::uint8_t>(b));
    return frame;
}
// 2026-11-20 is a Friday: GPS week 2445, five days into it.
constexpr std::uint32_t itow = (5 * 86400 + 45296 + 18) * 1000;

Bytes nav_pvt(std::uint32_t itow_ms, int fix_type = 3, int flags = 1, std::uint64_t flags3 = 0) {
    HandBytes payload;
    const std::uint32_t second = 45296 + (itow_ms - itow) / 1000;
    payload.i32(itow_ms).i16(2026).u8(11).u8(20).u8(second / 3600).u8(second / 60 % 60).u8(second % 60).u8(7).i32(30);
    payload.i32(-5000).u8(static_cast<std::uint64_t>(fix_type)).u8(static_cast<std::uint64_t>(flags)).u8(0).u8(12);
    payload.i32(85456000).i32(473977000).i32(510000).i32(463000).i32(900).i32(900);
    payload.i32(3000).i32(4000).i32(-2000).zeros_to(78).u8(flags3).zeros_to(92);
    return ubx(7, payload);
}
const PoseTolerance ubx_tolerance{1e-9, 1e-6, 1e-9, 0, 0, false, false};

TEST(UbxDialect, ReadsNavPvt) {
    const auto dialect = dialect_named("ubx");
    EXPECT_TRUE(dialect->hear(nav_pvt(itow), 1).samples.empty());
    const FeedNews news = dialect->hear(nav_pvt(itow + 1000), 2);
    ASSERT_EQ(news.samples.size(), 2u) << news.refusal;  // the first ends, the second is whole
    expect_pose(news.samples[0], ubx_tolerance);
    EXPECT_EQ(news.samples[0].source_time, Nanoseconds(gps_s * 1'000'000'000));
    EXPECT_EQ(news.samples[0].received_ns, 1);
    EXPECT_EQ(news.samples[1].source_time, Nanoseconds((gps_s + 1) * 1'000'000'000));
    EXPECT_EQ(news.samples[1].received_ns, 2);
    EXPECT_EQ(dialect->hear(nav_pvt(itow + 2000), 3).samples.size(), 1u);
}

TEST(UbxDialect, ReadsNavPvatWithItsAttitude) {
    const auto dialect = dialect_named("ubx");
    const auto pvat = [](std::uint32_t itow_ms) {
        NavPvat m;
        m.i_tow = itow_ms, m.valid = 7, m.year = 2026, m.month = 11, m.day = 20, m.hour = 12, m.minute = 34;
        m.second = 56, m.fix_type = 3, m.flags = 0x1D, m.lat = 473977000, m.lon = 85456000, m.height = 510000;
        m.vel_ned = {3000, 4000, -2000}, m.angle = {2000000, 1000000, 5313000};
        return encode_frame(m);
    };
    dialect->hear(pvat(itow), 1);
    const FeedNews news = dialect->hear(pvat(itow + 1000), 2);
    ASSERT_EQ(news.samples.size(), 2u) << news.refusal;
    EXPECT_NEAR(to_geodetic(news.samples[0].position).height.above_ellipsoid.value(), 510, 1e-6);
    ASSERT_TRUE(news.samples[0].attitude);
    EXPECT_NEAR(news.samples[0].attitude->yaw().deg(), 53.13, 1e-9);
}

TEST(UbxDialect, EndsEpochsByTheirEnd) {
    const auto dialect = dialect_named("ubx");
    Bytes bytes = nav_pvt(itow);
    HandBytes eoe;
    eoe.i32(itow);
    const Bytes end = ubx(0x61, eoe);
    bytes.insert(bytes.end(), end.begin(), end.end());
    EXPECT_EQ(dialect->hear(bytes, 0).samples.size(), 1u);
}

TEST(UbxDialect, JoinsTheMessagesOfOlderReceivers) {
    const auto dialect = dialect_named("ubx");
    const auto epoch = [](std::uint32_t itow_ms) {
        HandBytes posllh, velned, sol;
        posllh.i32(itow_ms).i32(85456000).i32(473977000).i32(510000).i32(463000).i32(900).i32(900);
        velned.i32(itow_ms).i32(300).i32(400).i32(-200).zeros_to(36);
        sol.i32(itow_ms).i32(0).i16(2445).u8(3).u8(0x0D).zeros_to(52);
        Bytes bytes = ubx(2, posllh);
        for (const Bytes& frame : {ubx(0x12, velned), ubx(6, sol)})
            bytes.insert(bytes.end(), frame.begin(), frame.end());
        return bytes;
    };
    dialect->hear(epoch(itow), 0);
    const FeedNews news = dialect->hear(epoch(itow + 250), 0);
    ASSERT_EQ(news.samples.size(), 2u) << news.refusal;
    expect_pose(news.samples[1], ubx_tolerance);
    EXPECT_EQ(news.samples[1].source_time, Nanoseconds(gps_s * 1'000'000'000 + 250'000'000));
}

TEST(UbxDialect, CountsWeeksOnThatNoMessageTells) {
    const auto dialect = dialect_named("ubx");
    const auto place = [](std::uint32_t itow_ms) {
        HandBytes posllh;
        posllh.i32(itow_ms).i32(85456000).i32(473977000).i32(510000).i32(463000).i32(900).i32(900);
        return ubx(2, posllh);
    };
    dialect->hear(place(604'799'000), 0);
    const FeedNews news = dialect->hear(place(0), 0);
    ASSERT_EQ(news.samples.size(), 2u) << news.refusal;
    EXPECT_EQ(*news.samples[1].source_time - *news.samples[0].source_time, std::chrono::seconds(1));
}

TEST(UbxDialect, RefusesLostFixesAndWrongChecksums) {
    const auto dialect = dialect_named("ubx");
    dialect->hear(nav_pvt(itow, 0, 0), 0);
    EXPECT_THAT(dialect->hear(nav_pvt(itow + 1000, 3, 0), 0).refusal, HasSubstr("no fix"));
    EXPECT_THAT(dialect->hear(nav_pvt(itow + 1500, 3, 1, 1), 0).refusal, HasSubstr("no fix")) << "invalidLlh";
    Bytes wrong = nav_pvt(itow + 2000);
    wrong[30] ^= 1;
    EXPECT_THAT(dialect->hear(wrong, 0).refusal, HasSubstr("checksum"));
    HandBytes late;
    late.i32(604'800'000).zeros_to(92);
    EXPECT_THAT(dialect->hear(ubx(7, late), 0).refusal, HasSubstr("time of week"));
}

}  // namespace
}  // namespace skyloop
