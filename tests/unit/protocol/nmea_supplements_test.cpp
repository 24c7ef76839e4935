#include "receiver/protocol/nmea_messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/core/random.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr NmeaFormat of_4_0{.version = NmeaVersion::v4_0, .limit_82 = false};
constexpr NmeaFormat of_4_11{.version = NmeaVersion::v4_11, .limit_82 = false};

template <class Message>
Message read_back(std::string_view line) {
    const auto message = decode_nmea(line);
    EXPECT_TRUE(message) << message.error().message;
    return message ? std::get<Message>(*message) : Message{};
}

std::string supplement_refusal(const std::string& body) {
    const std::string line = Sentence(body).finish();
    const auto message = decode_nmea(line);
    return message ? "accepted" : message.error().message;
}

// Sentences of receivers, byte for byte: their values are read, and written they are the same again.
template <class Message>
void expect_same(const std::string& line, const NmeaFormat& format) {
    EXPECT_EQ(encode(read_back<Message>(line), format), line + "\r\n");
}

TEST(Supplements, AreTheSentencesOfReceivers) {
    expect_same<Gbs>("$GNGBS,223807.00,1.0,1.0,3.0,,,,,,*50", of_4_11);
    expect_same<Gbs>("$GPGBS,194907.00,3.0,1.9,4.2,,,,*4E", of_4_0);
    expect_same<Grs>("$GPGRS,112257.00,1,-0.1,-0.3,-0.1,,,,,,,,,*4C", of_4_0);
    expect_same<Ths>("$GNTHS,244.28,A*11", of_4_11);
    expect_same<Hdt>("$GPHDT,,T*1B", of_4_0);
    const Gns gns = read_back<Gns>("$GNGNS,213722.000,4111.59903,N,11156.54809,W,AANN,13,0.93,01482.5,-016.5,,*51");
    EXPECT_EQ(gns.modes, (std::vector{NmeaMode::autonomous, NmeaMode::autonomous, NmeaMode::none, NmeaMode::none}));
    EXPECT_EQ(gns.satellites_used, 13);
    EXPECT_EQ(gns.altitude, Metres(1482.5));
    EXPECT_EQ(gns.correction_station, std::nullopt);
}

// Of a compass with a deviation and a western variation.
TEST(Supplements, TellHeadingsAndTurns) {
    expect_same<Rot>("$HEROT,-4.8,A*0A", of_4_0);
    expect_same<Rot>("$GNROT,,V*16", of_4_0);
    const Hdg compass = read_back<Hdg>(Sentence("HCHDG,101.1,2.0,W,7.1,W").finish());
    ASSERT_TRUE(compass.magnetic_heading && compass.variation);
    EXPECT_NEAR(compass.magnetic_heading->deg(), 99.1, 1e-9) << "the deviation is taken off";
    EXPECT_NEAR(compass.variation->deg(), -7.1, 1e-9);
    EXPECT_EQ(encode(compass, {.heading_decimals = 1}), Sentence("HCHDG,99.1,,,7.1,W").finish());
    EXPECT_EQ(encode(Hdg{}, of_4_0), Sentence("HCHDG,,,,,").finish());
    EXPECT_THAT(supplement_refusal("HCHDG,101.1,,,7.1,X"), HasSubstr("expected E or W"));
    EXPECT_THAT(supplement_refusal("HEROT,12,X"), HasSubstr("expected A or V"));
    EXPECT_THAT(supplement_refusal("HEROT,fast,A"), HasSubstr("a rate of turn"));
}

TEST(Supplements, TurnCoursesByTheMagneticVariation) {
    const NmeaFormat west{.version = NmeaVersion::v2_3, .magnetic_fields = true, .magnetic_variation_deg = -3.5};
    Vtg vtg{"GP", Angle::degrees(358), MetresPerSecond(0), NmeaMode::autonomous};
    EXPECT_THAT(encode(vtg, west), StartsWith("$GPVTG,358.00,T,1.50,M,"));
    Rmc rmc;
    rmc.mode = NmeaMode::none;
    EXPECT_THAT(encode(rmc, west), HasSubstr(",3.5,W,N*"));
    vtg.course.reset();
    EXPECT_THAT(encode(vtg, west), StartsWith("$GPVTG,,T,,M,"));
}

TEST(Supplements, FollowTheirVersion) {
    Gns gns;
    gns.modes = {NmeaMode::none, NmeaMode::none};
    gns.hdop = 99.99;
    EXPECT_EQ(encode(gns, of_4_0), Sentence("GNGNS,,,,,,NN,00,99.99,,,,").finish());
    EXPECT_EQ(encode(gns, of_4_11), Sentence("GNGNS,,,,,,NN,00,99.99,,,,,V").finish());
    Grs grs;
    grs.residuals = {Metres(0.04), std::nullopt, Metres(-12.35)};
    grs.system_id = 3;
    grs.signal_id = 11;
    EXPECT_EQ(encode(grs, of_4_0), Sentence("GNGRS,,1,0.0,,-12.3,,,,,,,,,").finish());
    EXPECT_EQ(encode(grs, of_4_11), Sentence("GNGRS,,1,0.0,,-12.3,,,,,,,,,,3,B").finish());
    EXPECT_THAT(encode(Dtm{}, of_4_11), StartsWith("$GNDTM,W84,,0.0,N,0.0,E,0.0,W84*"));
    Vlw vlw{"GN", Metres(1852 * 15.8), Metres(1852 * 1.2)};
    EXPECT_THAT(encode(vlw, of_4_11), StartsWith("$GNVLW,,N,,N,15.800,N,1.200,N*"));
    EXPECT_THAT(encode(vlw, {.version = NmeaVersion::v2_1}), StartsWith("$GNVLW,,N,,N*"));
    EXPECT_THAT(encode(Ths{}, of_4_11), StartsWith("$GNTHS,,V*"));
    EXPECT_THAT(encode(Dtm{"GP", "999", "", -0.08, 0.07, -47.7, "W84"}, of_4_11),
                StartsWith("$GPDTM,999,,0.08,S,0.07,E,-47.7,W84*"));
}

TEST(Supplements, GrsLosesDecimalsRatherThanExceed82Characters) {
    Grs grs;
    grs.time = NmeaTime{22, 37, 45, 0};
    grs.residuals.assign(12, Metres(-12.3));
    grs.system_id = 3;
    grs.signal_id = 7;
    EXPECT_GT(encode(grs, of_4_11).size(), 82U);
    NmeaFormat limited = of_4_11;
    limited.limit_82 = true;
    EXPECT_EQ(encode(grs, limited),
              Sentence("GNGRS,223745.00,1,-12,-12,-12,-12,-12,-12,-12,-12,-12,-12,-12,-12,3,7").finish());
    grs.residuals.resize(6);
    EXPECT_EQ(encode(grs, limited), encode(grs, of_4_11)) << "there is room";
}

TEST(Supplements, GnsLosesDecimalsRatherThanExceed82Characters) {
    Gns gns;
    gns.time = NmeaTime{1, 2, 3, 0};
    gns.position = NmeaPosition{Angle::degrees(44.0688), Angle::degrees(-121.314)};
    gns.modes.assign(6, NmeaMode::differential);
    gns.hdop = 12.34;
    gns.altitude = Metres(12345.678);
    gns.geoid_separation = Metres(-21.35);
    gns.correction_age = Seconds(12.5);
    gns.correction_station = 1234;
    NmeaFormat format{.version = NmeaVersion::v4_11, .coordinate_decimals = 7, .altitude_decimals = 3};
    EXPECT_LE(encode(gns, format).size(), 82U);
    format.limit_82 = false;
    EXPECT_GT(encode(gns, format).size(), 82U);
    EXPECT_THAT(encode(gns, format),
                HasSubstr(",4404.1280000,N,12118.8400000,W,DDDDDD,00,12.34,12345.678,-21.350,12.5,1234"));
}

TEST(Supplements, AreRefusedNamingTheField) {
    EXPECT_THAT(supplement_refusal("GNGNS,,,,,,NX,00,99.99,,,,"), HasSubstr("GNGNS: field 6 is 'NX'"));
    EXPECT_THAT(supplement_refusal("GNGBS,,x,,,,,,"), HasSubstr("field 2 is 'x'; expected an error"));
    EXPECT_THAT(supplement_refusal("GNGRS,,1,0.0"), HasSubstr("3 fields; expected at least 14"));
    EXPECT_THAT(supplement_refusal("GNDTM,W84,,0.0,X,0.0,E,0.0,W84"), HasSubstr("N or S"));
    EXPECT_THAT(supplement_refusal("GNVLW,,N,,N,a,N,,N"), HasSubstr("a distance"));
    EXPECT_THAT(supplement_refusal("GNTHS,12,Q"), HasSubstr("a mode"));
    EXPECT_THAT(supplement_refusal("GNHDT,12,M"), HasSubstr("expected T"));
}

TEST(Supplements, SurviveARoundTrip) {
    RandomStream random(12, "supplements");
    const auto uniform = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    const auto maybe = [&](auto value) { return random.uniform() < 0.2 ? std::nullopt : std::optional(value); };
    const auto whole = [&](int most) { return static_cast<int>(random.bits() % static_cast<unsigned>(most + 1)); };
    const auto stable = [](const auto& message) {
        const std::string first = encode(message, of_4_11);
        const auto read = decode_nmea(first);
        ASSERT_TRUE(read) << first << read.error().message;
        EXPECT_EQ(encode(*read, of_4_11), first);
    };
    for (int i = 0; i < 2000; ++i) {
        const auto time = maybe(NmeaTime{static_cast<unsigned>(whole(23)), 5, 6, 70'000'000});
        const auto place = maybe(NmeaPosition{Angle::degrees(uniform(-90, 90)), Angle::degrees(uniform(-180, 180))});
        Gns gns{"GN",
                time,
                place,
                {},
                whole(99),
                maybe(uniform(0.4, 99)),
                maybe(Metres(uniform(-400, 90000))),
                maybe(Metres(uniform(-100, 90))),
                maybe(Seconds(uniform(0, 60))),
                maybe(whole(4095))};
        for (int k = whole(6); k > 0; --k)
            gns.modes.push_back(static_cast<NmeaMode>("NADEFR"[whole(5)]));
        stable(gns);
        const auto metres = [&] { return maybe(Metres(uniform(-99, 99))); };
        stable(Gbs{"GN", time, metres(), metres(), metres(), maybe(whole(99)), maybe(uniform(0, 1)), metres(), metres(),
                   maybe(whole(6)), maybe(whole(11))});
        Grs grs{"GN", time, 1, {}, maybe(whole(6)), maybe(whole(11))};
        for (int k = whole(12); k > 0; --k)
            grs.residuals.push_back(metres());
        stable(grs);
        stable(Dtm{"GP", "W84", "", uniform(-1, 1), uniform(-1, 1), uniform(-90, 90), "W84"});
        stable(Vlw{"GN", maybe(Metres(uniform(0, 1e8))), maybe(Metres(uniform(0, 1e6)))});
        stable(Ths{"GN", maybe(Angle::degrees(uniform(0, 360))), "AEMSV"[whole(4)]});
        stable(Hdt{"GN", maybe(Angle::degrees(uniform(0, 360)))});
    }
}

}  // namespace
}  // namespace skyloop
