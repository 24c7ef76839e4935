#include "receiver/protocol/nmea_pubx.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/core/random.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

template <class Message>
Message read_pubx(const std::string& line) {
    const auto sentence = parse_sentence(line);
    EXPECT_TRUE(sentence);
    const auto message = decode_pubx(*sentence);
    EXPECT_TRUE(message) << message.error().message;
    return message ? std::get<Message>(*message) : Message{};
}

std::string pubx_refusal(const std::string& body) {
    const std::string line = Sentence(body).finish();
    const auto message = decode_pubx(*parse_sentence(line));
    return message ? "accepted" : message.error().message;
}

// From /work/shared/data/serial/pyubx2-pygpsdata-NMEABADEND.log.
TEST(Pubx, ReadsAndWritesACapturedPosition) {
    const std::string line =
        "$PUBX,00,103607.00,5327.03942,N,00214.42462,W,104.461,G3,29,31,0.085,39.63,-0.007,,5.88,7.62,8.09,6,0,0*69";
    const auto m = read_pubx<PubxPosition>(line);
    EXPECT_NEAR(m.position.latitude.deg(), 53.450657, 1e-6);
    EXPECT_EQ(m.status, "G3");
    EXPECT_EQ(m.horizontal_accuracy, Metres(29));
    EXPECT_NEAR(m.speed.value(), 0.085 / 3.6, 1e-12);
    EXPECT_EQ(m.down, MetresPerSecond(-0.007));
    EXPECT_EQ(m.correction_age_s, std::nullopt);
    EXPECT_EQ(m.tdop, 8.09);
    EXPECT_EQ(encode(m, {}), line + "\r\n");
}

TEST(Pubx, ReadsAndWritesCapturedSatellitesAndTime) {
    const std::string satellites =
        "$PUBX,03,23,1,-,014,06,08,000,12,U,207,43,28,009,14,-,049,06,,000,15,-,171,44,23,000,17,-,064,32,16,000,"
        "19,-,094,33,,000,20,U,251,20,31,038,21,-,354,04,,000,23,U,251,27,31,064,24,U,268,89,26,000,25,-,223,05,,"
        "000,48,-,,,15,000,52,-,,,28,013,65,-,176,07,,000,66,U,223,57,35,064,67,-,315,42,23,000,68,-,341,00,29,000,"
        "75,-,057,37,,000,76,U,303,78,18,000,77,-,253,27,21,000,84,-,018,19,,000,85,-,078,22,,000,86,-,121,01,,"
        "000*02";
    const auto m = read_pubx<PubxSatellites>(satellites);
    ASSERT_EQ(m.satellites.size(), 23U);
    EXPECT_EQ(m.satellites[1], (PubxSatellite{12, 'U', 207, 43, 28, 9}));
    EXPECT_EQ(m.satellites[11], (PubxSatellite{48, '-', std::nullopt, std::nullopt, 15, 0}));
    EXPECT_EQ(encode(m, {}), satellites + "\r\n");

    const std::string time = "$PUBX,04,103607.00,060321,556567.00,2147,18,-384839,-53.623,16*2C";
    const auto t = read_pubx<PubxTime>(time);
    EXPECT_EQ(t.date, (NmeaDate{2021, 3, 6}));
    EXPECT_EQ(t.utc_week, 2147);
    EXPECT_FALSE(t.leap_seconds_by_default);
    EXPECT_EQ(encode(t, {}), time + "\r\n");
}

TEST(Pubx, MarksLeapSecondsThatNobodyHasSentYet) {
    PubxTime m;
    m.leap_seconds_by_default = true;
    const std::string line = encode(m, {});
    EXPECT_THAT(line, HasSubstr("$PUBX,04,,,,,18D,0,0.000,0*"));
    EXPECT_EQ(read_pubx<PubxTime>(line), m);
}

TEST(Pubx, HasTheFormOfNoFix) {
    PubxPosition m;
    m.horizontal_accuracy = Metres(5303356);
    m.vertical_accuracy = Metres(3750039);
    EXPECT_THAT(encode(m, {}), HasSubstr(",0000.00000,N,00000.00000,E,0.000,NF,5303356,3750039,0.000,0.00,0.000,,99.99,"
                                         "99.99,99.99,0,0,0*"));
}

TEST(Pubx, IsRefusedNamingTheField) {
    EXPECT_THAT(pubx_refusal("PUBX,00,,,,,,0.0,XX,1,1,0,0,0,,1,1,1,0,0,0"), HasSubstr("field 8 is 'XX'"));
    EXPECT_THAT(pubx_refusal("PUBX,03,02,1,U,,,,000"), HasSubstr("the number of satellites listed"));
    EXPECT_THAT(pubx_refusal("PUBX,03,01,1,X,,,,000"), HasSubstr("U, e or -"));
    EXPECT_THAT(pubx_refusal("PUBX,04,,,,,x,0,0,0"), HasSubstr("leap seconds"));
    EXPECT_THAT(pubx_refusal("PUBX,04"), HasSubstr("1 fields; expected at least 9"));
    EXPECT_THAT(pubx_refusal("PUBX,40,GLL,0,0,0,0,0,0"), HasSubstr("expected PUBX 00, 03 or 04"));
    EXPECT_THAT(pubx_refusal("PUBX"), HasSubstr("expected PUBX 00, 03 or 04"));
}

TEST(Pubx, SurvivesARoundTrip) {
    RandomStream random(13, "pubx");
    const auto uniform = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    const auto whole = [&](int most) { return static_cast<int>(random.bits() % static_cast<unsigned>(most + 1)); };
    const auto stable = [](const auto& message) {
        const std::string first = encode(message, {});
        const auto sentence = parse_sentence(first);
        const auto read = decode_pubx(*sentence);
        ASSERT_TRUE(read) << first << read.error().message;
        std::visit([&](const auto& again) { EXPECT_EQ(encode(again, {}), first); }, *read);
    };
    for (int i = 0; i < 1000; ++i) {
        PubxPosition p;
        p.time = NmeaTime{1, 2, 3, 10'000'000 * static_cast<unsigned>(whole(99))};
        p.position = {Angle::degrees(uniform(-90, 90)), Angle::degrees(uniform(-180, 180))};
        p.altitude = Metres(uniform(-400, 50000));
        p.status = "D3";
        p.horizontal_accuracy = Metres(uniform(0.01, 5e6));
        p.vertical_accuracy = Metres(uniform(0.01, 5e6));
        p.speed = MetresPerSecond(uniform(0, 500));
        p.course = Angle::degrees(uniform(0, 360));
        p.down = MetresPerSecond(uniform(-50, 50));
        if (whole(1) == 1) p.correction_age_s = whole(60);
        p.satellites_used = whole(40);
        stable(p);
        PubxSatellites s;
        for (int k = whole(60); k > 0; --k)
            s.satellites.push_back({whole(254) + 1, "Ue-"[whole(2)], whole(359), whole(90), whole(55), whole(64)});
        stable(s);
        stable(PubxTime{p.time, NmeaDate{2024, 2, 29}, uniform(0, 604800), whole(4000), 18, whole(1) == 1,
                        uniform(-5e5, 5e5), uniform(-90, 90), 21});
    }
}

}  // namespace
}  // namespace skyloop
