#include "receiver/protocol/nmea_messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "base/core/files.hpp"
#include "base/core/random.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string checksum(const std::string& body) {
    std::ostringstream text;
    text << '*' << std::hex << std::setw(2) << std::setfill('0') << static_cast<int>(nmea_checksum(body));
    return text.str();
}

template <class Message>
Message decoded(const std::string& body) {
    const auto message = decode_nmea("$" + body + checksum(body));
    EXPECT_TRUE(message) << message.error().message;
    return message ? std::get<Message>(*message) : Message{};
}

std::string refusal(const std::string& body) {
    const auto message = decode_nmea("$" + body + checksum(body));
    return message ? "accepted" : message.error().message;
}

TEST(DecodeNmea, ReadsCapturedSentences) {
    const auto rmc = decoded<Rmc>("GNRMC,223745.00,A,3806.62964,N,12237.61382,W,0.040,,110720,,,D,V");
    EXPECT_EQ(rmc.time, (NmeaTime{22, 37, 45, 0}));
    EXPECT_EQ(rmc.date, (NmeaDate{2020, 7, 11}));
    EXPECT_NEAR(rmc.position->latitude.deg(), 38.110494, 1e-9);
    EXPECT_NEAR(rmc.position->longitude.deg(), -122.626897, 1e-9);
    EXPECT_EQ(rmc.course, std::nullopt);
    EXPECT_EQ(rmc.mode, NmeaMode::differential);
    EXPECT_TRUE(rmc.valid);

    const auto gga = decoded<Gga>("GNGGA,003956.00,4552.65403,S,17030.00668,E,5,12,0.82,257.4,M,47.2,M,0.0,0041");
    EXPECT_LT(gga.position->latitude.deg(), 0);
    EXPECT_EQ(gga.quality, 5);
    EXPECT_EQ(gga.altitude, Metres(257.4));
    EXPECT_EQ(gga.correction_age, Seconds(0.0));
    EXPECT_EQ(gga.correction_station, 41);

    const auto gsa = decoded<Gsa>("GNGSA,A,3,29,20,18,16,51,13,44,26,,,,,0.99,0.54,0.83,1");
    EXPECT_THAT(gsa.satellites, ElementsAre(29, 20, 18, 16, 51, 13, 44, 26));
    EXPECT_EQ(gsa.system_id, 1);

    const auto gsv = decoded<Gsv>("GLGSV,3,3,10,83,52,346,29,84,05,307,,1");
    EXPECT_EQ(gsv.talker, "GL");
    EXPECT_THAT(gsv.satellites, ElementsAre(GsvSatellite{83, 52, 346, 29}, GsvSatellite{84, 5, 307, std::nullopt}));
    EXPECT_EQ(gsv.signal_id, 1);

    const auto gst = decoded<Gst>("GNGST,223745.00,228650,2.5,2.4,126,0.98,1.0,3.1");
    EXPECT_EQ(gst.range_rms, Metres(228650));
    EXPECT_NEAR(gst.orientation->deg(), 126, 1e-9);
    EXPECT_EQ(decoded<Zda>("GNZDA,223745.00,11,07,2020,00,00").date, (NmeaDate{2020, 7, 11}));
    EXPECT_NEAR(decoded<Vtg>("GPVTG,12.5,T,,M,,N,36.0,K").speed->value(), 10.0, 1e-12);
    EXPECT_EQ(decoded<Txt>("GNTXT,01,01,02,u-blox AG, a^2Ab").text, "u-blox AG, a*b");
}

TEST(DecodeNmea, ReadsOlderVersionsAndPaddedPages) {
    EXPECT_EQ(decoded<Rmc>("GPRMC,081836,A,3751.65,S,14507.36,E,000.0,360.0,130998,011.3,E").mode, std::nullopt);
    EXPECT_EQ(decoded<Rmc>("GPRMC,081836,A,3751.65,S,14507.36,E,000.0,360.0,130998,011.3,E").date,
              (NmeaDate{1998, 9, 13}));
    EXPECT_EQ(decoded<Gsv>("GPGSV,3,3,09,17,08,031,22,,,,,,,,,,,,").satellites.size(), 1U);
    EXPECT_EQ(decoded<Gll>("GPGLL,,,,,,V").mode, std::nullopt);
}

TEST(DecodeNmea, RefusesNamingTheField) {
    EXPECT_THAT(refusal("GNRMC,243745.00,A,,,,,,,,,,N"), HasSubstr("GNRMC: field 1 is '243745.00'; expected a time"));
    EXPECT_THAT(refusal("GNRMC,223761.00,A,,,,,,,,,,N"), HasSubstr("a time"));
    EXPECT_THAT(refusal("GNRMC,,X,,,,,,,,,,N"), HasSubstr("field 2 is 'X'; expected A or V"));
    EXPECT_THAT(refusal("GNRMC,,A,3860.00000,N,00000.0,E,,,,,,N"), HasSubstr("a latitude"));
    EXPECT_THAT(refusal("GNRMC,,A,9000.00001,N,00000.0,E,,,,,,N"), HasSubstr("a latitude"));
    EXPECT_THAT(refusal("GNRMC,,A,-100.0,N,00000.0,E,,,,,,N"), HasSubstr("a latitude"));
    EXPECT_THAT(refusal("GNRMC,,A,1000.0,N,18000.1,E,,,,,,N"), HasSubstr("a longitude"));
    EXPECT_THAT(refusal("GNRMC,,A,1000.0,E,18000.0,E,,,,,,N"), HasSubstr("N or S"));
    EXPECT_THAT(refusal("GNRMC,,A,1000.0,N,,,,,,,,N"), HasSubstr("beside the other"));
    EXPECT_THAT(refusal("GNRMC,,A,,,,,1e5,,,,,N"), HasSubstr("a speed"));
    EXPECT_THAT(refusal("GNRMC,,A,,,,,nan,,,,,N"), HasSubstr("a speed"));
    EXPECT_THAT(refusal("GNRMC,,A,,,,,,,310223,,,N"), HasSubstr("a date"));
    EXPECT_THAT(refusal("GNRMC,,A,,,,,,,,,,Z"), HasSubstr("a mode indicator"));
    EXPECT_THAT(refusal("GNRMC,,A"), HasSubstr("2 fields; expected at least 9"));
    EXPECT_THAT(refusal("GNZDA,,31,02,2020,00,00"), HasSubstr("a day of the calendar"));
    EXPECT_THAT(refusal("GNGSV,1,1,01,99999999999,,,"), HasSubstr("a satellite"));
    EXPECT_THAT(refusal("GNXYZ,1"), HasSubstr("GNXYZ: not a sentence that is read here"));
    EXPECT_THAT(refusal("PUBX,00"), HasSubstr("not a sentence"));
    EXPECT_FALSE(decode_nmea(std::string_view("garbage")));
}

// Every field of every kind drawn at random: what was written is what is read, to the digits shown.
class RoundTrip : public testing::Test {
protected:
    template <class Value>
    std::optional<Value> maybe(Value value) {
        return random_.uniform() < 0.15 ? std::nullopt : std::optional<Value>(value);
    }
    double uniform(double low, double high) { return low + (high - low) * random_.uniform(); }
    int whole(int low, int high) {
        return low + static_cast<int>(random_.bits() % static_cast<unsigned>(high - low + 1));
    }
    unsigned count(int low, int high) { return static_cast<unsigned>(whole(low, high)); }

    std::optional<NmeaTime> time() {
        return maybe(NmeaTime{count(0, 23), count(0, 59), count(0, 60), 10'000'000 * count(0, 99)});
    }
    std::optional<NmeaDate> date() { return maybe(NmeaDate{whole(1980, 2079), count(1, 12), count(1, 28)}); }
    std::optional<NmeaPosition> position() {
        return maybe(NmeaPosition{Angle::degrees(uniform(-90, 90)), Angle::degrees(uniform(-180, 180))});
    }
    std::optional<NmeaMode> mode() { return maybe(static_cast<NmeaMode>("NADEFR"[whole(0, 5)])); }
    std::optional<Metres> metres() { return maybe(Metres(std::pow(10.0, uniform(-2, 4)))); }

    template <class Message>
    void expect_stable(const Message& message) {
        const NmeaFormat format{.version = NmeaVersion::v4_11, .limit_82 = false};
        const std::string first = encode(message, format);
        const auto read = decode_nmea(first);
        ASSERT_TRUE(read) << first << read.error().message;
        EXPECT_EQ(encode(*read, format), first);
    }

    RandomStream random_{11, "nmea round trip"};
};

TEST_F(RoundTrip, KeepsPositionMessages) {
    for (int i = 0; i < 3000; ++i) {
        Rmc rmc{"GN",
                time(),
                whole(0, 1) == 1,
                position(),
                maybe(MetresPerSecond(uniform(0, 500))),
                maybe(Angle::degrees(uniform(0, 360))),
                date(),
                mode()};
        expect_stable(rmc);
        const auto read = std::get<Rmc>(*decode_nmea(encode(rmc, {})));
        ASSERT_EQ(read.time, rmc.time);
        ASSERT_EQ(read.date, rmc.date);
        ASSERT_EQ(read.mode, rmc.mode);
        ASSERT_EQ(read.valid, rmc.valid);
        ASSERT_EQ(read.position.has_value(), rmc.position.has_value());
        if (rmc.position) {
            ASSERT_NEAR(read.position->latitude.deg(), rmc.position->latitude.deg(), 0.51e-5 / 60);
            ASSERT_NEAR(read.position->longitude.deg(), rmc.position->longitude.deg(), 0.51e-5 / 60);
        }
        if (rmc.speed) {
            ASSERT_NEAR(read.speed->value(), rmc.speed->value(), 0.51e-3 * 1852 / 3600);
        }
        expect_stable(Gll{"GA", position(), time(), whole(0, 1) == 1, mode()});
        expect_stable(Gga{"GP", time(), position(), whole(0, 6), whole(0, 99), maybe(uniform(0.3, 99)),
                          maybe(Metres(uniform(-500, 80000))), maybe(Metres(uniform(-110, 90))),
                          maybe(Seconds(uniform(0, 60))), maybe(whole(0, 4095))});
    }
}

TEST_F(RoundTrip, KeepsTheOtherMessages) {
    for (int i = 0; i < 3000; ++i) {
        Vtg vtg{"GL", maybe(Angle::degrees(uniform(0, 360))), maybe(MetresPerSecond(uniform(0, 500))), mode()};
        if (!vtg.speed) vtg.course = std::nullopt;
        expect_stable(vtg);
        Gsa gsa{"GN",
                whole(0, 1) == 1,
                true,
                whole(1, 3),
                {},
                maybe(uniform(0.5, 99)),
                maybe(uniform(0.5, 99)),
                maybe(uniform(0.5, 99)),
                maybe(whole(1, 15))};
        for (int k = whole(0, 12); k > 0; --k)
            gsa.satellites.push_back(whole(1, 463));
        expect_stable(gsa);
        ASSERT_EQ(std::get<Gsa>(*decode_nmea(encode(gsa, {}))).satellites, gsa.satellites);
        Gsv gsv{"GB", whole(1, 9), whole(1, 9), whole(0, 36), {}, maybe(whole(0, 15))};
        for (int k = whole(0, 4); k > 0; --k)
            gsv.satellites.push_back({whole(1, 463), maybe(whole(0, 90)), maybe(whole(0, 359)), maybe(whole(0, 99))});
        expect_stable(gsv);
        ASSERT_EQ(std::get<Gsv>(*decode_nmea(encode(gsv, {}))), gsv);
        expect_stable(Gst{"GN", time(), metres(), metres(), metres(), maybe(Angle::degrees(uniform(0, 180))), metres(),
                          metres(), metres()});
        expect_stable(Zda{"GN", time(), date()});
        std::string text;
        for (int k = whole(0, 40); k > 0; --k)
            text += static_cast<char>(whole(0, 255));
        const Txt txt{"GN", 1, 1, whole(0, 99), text};
        ASSERT_EQ(std::get<Txt>(*decode_nmea(encode(txt, {}))), txt);
    }
}

struct Capture {
    const char* file;
    NmeaFormat format;
};

class CapturedReceiver : public testing::TestWithParam<Capture> {};

// What real receivers sent, read and written again, is the same bytes.
TEST_P(CapturedReceiver, IsReproducedByteForByte) {
    SKYLOOP_REQUIRE_SHARED(path, GetParam().file);
    const auto text = read_text_file(path);
    ASSERT_TRUE(text) << text.error().message;
    int reproduced = 0;
    std::istringstream stream(*text);
    for (std::string line; std::getline(stream, line);) {
        line.erase(0, std::min(line.find('$'), line.size()));
        while (line.ends_with('\r'))
            line.pop_back();
        const auto sentence = parse_sentence(line);
        // The texts of these logs have commas in them, which we escape.
        if (!sentence || sentence->formatter() == "TXT" || sentence->address.size() != 5) continue;
        const auto message = decode_nmea(*sentence);
        ASSERT_TRUE(message) << line << message.error().message;
        ASSERT_EQ(encode(*message, GetParam().format), line + "\r\n");
        ++reproduced;
    }
    EXPECT_GT(reproduced, 20);
}

// MediaTek's: four decimals, milliseconds, satellites in view without padding.
constexpr NmeaFormat mediatek{.version = NmeaVersion::v2_3,
                              .time_decimals = 3,
                              .coordinate_decimals = 4,
                              .speed_decimals = 2,
                              .satellites_padded = false};
constexpr NmeaFormat high_precision{
    .version = NmeaVersion::v4_11, .coordinate_decimals = 7, .altitude_decimals = 3, .limit_82 = false};
INSTANTIATE_TEST_SUITE_P(Serial, CapturedReceiver,
                         testing::Values(Capture{"serial/ublox-neo-m9n-nmea.log", {.version = NmeaVersion::v4_10}},
                                         Capture{"serial/ublox-zed-f9p-nmea.log", {.version = NmeaVersion::v4_10}},
                                         Capture{"serial/ublox-zed-f9r.log", {.version = NmeaVersion::v4_11}},
                                         Capture{"serial/ublox-f9p-hpnmea.log", high_precision},
                                         Capture{"serial/neo-m8n.log", {.version = NmeaVersion::v4_0}},
                                         Capture{"serial/mtk-3329.log", mediatek},
                                         Capture{"receivers/indoor_neo6m_20240726/gps_data_20240726_122435.log.gz",
                                                 {.version = NmeaVersion::v2_3}}),
                         [](const auto& capture) {
                             std::string name = capture.param.file;
                             std::replace_if(
                                 name.begin(), name.end(),
                                 [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
                             return name;
                         });

}  // namespace
}  // namespace skyloop
