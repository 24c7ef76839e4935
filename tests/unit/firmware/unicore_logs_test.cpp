// What a Unicore receiver sends. Checks of sums and fields are the tests' own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "unicore_receiver.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::MatchesRegex;
using testing::SizeIs;

TEST_F(UnicoreReceiver, WritesSentencesAsItsCapturesHaveThem) {
    const auto all = usual_sentences();
    ASSERT_GE(all.size(), 8u);
    EXPECT_THAT(all[0],
                MatchesRegex("\\$GNRMC,1200..\\.00,A,4723\\.86200000,N,00832\\.73600000,E,15\\.667,7\\.1,050324,"
                             "0\\.0,E,A,C\\*.."));
    EXPECT_THAT(all[1],
                MatchesRegex("\\$GNGGA,1200..\\.00,4723\\.86200000,N,00832\\.73600000,E,1,32,0\\.8,441\\.0000,M,"
                             "47\\.0000,M,,\\*.."));
    EXPECT_THAT(all[2], MatchesRegex("\\$GNGLL,4723\\.86200000,N,00832\\.73600000,E,1200..\\.00,A,A\\*.."));
    EXPECT_THAT(all[3], MatchesRegex("\\$GNGSA,M,3,06,07,08,09,10,11,12,13,,,,,1\\.3,0\\.8,1\\.0,1\\*.."));
    std::vector<std::string> talkers;
    for (const std::string& line : all)
        if (line.substr(3, 3) == "GSV" && (talkers.empty() || talkers.back() != line.substr(1, 2)))
            talkers.push_back(line.substr(1, 2));
    EXPECT_THAT(talkers, ElementsAre("GP", "GL", "GB", "GA"));
    EXPECT_THAT(all.back(), MatchesRegex("\\$GNVTG,7\\.100,T,7\\.100,M,15\\.66739,N,29\\.01600,K,A\\*.."));
    for (const std::string& line : all)
        EXPECT_EQ(line, with_sum(line.substr(0, line.size() - 3), 1).replace(0, 1, "$")) << "NMEA's own sum";
}

TEST_F(UnicoreReceiver, WithoutAFixSentencesAreThoseOfACapture) {
    epoch_.fix.type = FixType::none;
    for (SatelliteStatus& s : epoch_.fix.satellites)
        s.used = false, s.cn0.reset();
    const auto all = usual_sentences();
    ASSERT_THAT(all, SizeIs(6));
    EXPECT_THAT(all[0], MatchesRegex("\\$GNRMC,1200..\\.00,V,,,,,,,050324,0\\.0,E,N,V\\*.."));
    EXPECT_THAT(all[1], MatchesRegex("\\$GNGGA,1200..\\.00,,,,,0,00,9999\\.0,,,,,,\\*.."));
    EXPECT_THAT(all[2], MatchesRegex("\\$GNGLL,,,,,1200..\\.00,V,N\\*.."));
    EXPECT_EQ(all[3], "$GPGSA,,1,,,,,,,,,,,,,,,,*73");
    EXPECT_EQ(all[4], "$GPGSV,1,1,00,,,,,*55");
    EXPECT_EQ(all[5], "$GPVTG,,,,,,,,,N*30");
}

TEST_F(UnicoreReceiver, SendsEachLogAtItsOwnPeriodByItsOwnPort) {
    say("AGRICA COM2 0.2");
    say("LOG COM3 UNIHEADINGA ONTIME 0.5");
    say("BESTNAVA 1");
    wait(2s);
    forget();
    wait(4s);
    EXPECT_THAT(lines("#AGRICA", PortId::uart2), SizeIs(20));
    EXPECT_THAT(lines("#UNIHEADINGA", PortId::uart3), SizeIs(8));
    EXPECT_THAT(lines("#BESTNAVA"), SizeIs(4));
    EXPECT_THAT(texts(), SizeIs(4));
    EXPECT_THAT(answers("UNLOG COM2 UNIAGRICA"), testing::Contains(ok_to("UNLOG COM2 UNIAGRICA")));
    wait(1s);
    forget();
    wait(2s);
    EXPECT_THAT(texts(PortId::uart2), SizeIs(0));
    EXPECT_FALSE(texts(PortId::uart3).empty());
}

TEST_F(UnicoreReceiver, AgricaHasTheSolutionInItsPlaces) {
    say("AGRICA 1");
    wait(3s);
    const auto fields = body_fields(lines("#AGRICA").back().text);
    ASSERT_THAT(fields, SizeIs(57));
    const auto number = [&](std::size_t i) { return std::stod(fields[i]); };
    EXPECT_EQ(fields[0], "GNSS");
    EXPECT_EQ(fields[1], "232");
    EXPECT_EQ(fields[2] + fields[3] + fields[4], "2435");
    EXPECT_EQ(fields[8], "1");
    EXPECT_EQ(fields[9], "0");
    EXPECT_EQ(fields[10], "8");
    EXPECT_NEAR(number(29), 47.3977, 1e-9);
    EXPECT_NEAR(number(30), 8.5456, 1e-9);
    EXPECT_NEAR(number(31), 441, 1e-3) << "above the sea";
    EXPECT_NEAR(number(50), 47, 1e-3);
    EXPECT_NEAR(number(23), 8, 1e-3);
    EXPECT_NEAR(number(24), 1, 1e-3);
    // Its height above the sea and the separation lead back to where its centre-of-the-Earth coordinates are.
    const auto place = to_ecef(Geodetic::degrees(number(29), number(30), number(31) + number(50))).vector();
    EXPECT_NEAR(place.x(), number(32), 1e-3);
    EXPECT_NEAR(place.y(), number(33), 1e-3);
    EXPECT_NEAR(place.z(), number(34), 1e-3);
    EXPECT_NEAR(std::hypot(number(35), number(36)), 1.2, 1e-3);
    EXPECT_NEAR(std::hypot(number(38), number(39), number(40)), std::hypot(1.2, 1.8), 1e-3);
}

TEST_F(UnicoreReceiver, HeadingLeadsFromThisAntennaToTheOther) {
    // From the other antenna, 1 m north-east of this one and 10 cm below it, to this one.
    epoch_.relative = RelativePosition{-std::sqrt(0.5), -std::sqrt(0.5), -0.1, Metres(0.005)};
    epoch_.fix.type = FixType::rtk_fixed;
    say("UNIHEADINGA 1");
    say("AGRICA 1");
    say("PVTSLNA 1");
    say("GPGGA 1");
    wait(3s);
    const auto heading = body_fields(lines("#UNIHEADINGA").back().text);
    ASSERT_THAT(heading, SizeIs(17));
    EXPECT_EQ(heading[0] + heading[1], "SOL_COMPUTEDNARROW_INT");
    EXPECT_NEAR(std::stod(heading[2]), std::hypot(1, 0.1), 1e-3);
    EXPECT_NEAR(std::stod(heading[3]), 45, 1e-3);
    EXPECT_NEAR(std::stod(heading[4]), -5.7106, 1e-3);
    EXPECT_NEAR(std::stod(heading[6]), 0.2865, 1e-3);
    const auto agrica = body_fields(lines("#AGRICA").back().text);
    EXPECT_EQ(agrica[9], "4");
    EXPECT_NEAR(std::stod(agrica[19]), 45, 1e-3);
    EXPECT_EQ(agrica[8], "1") << "the pair makes no better position";
    EXPECT_GT(std::stod(agrica[44]), std::stod(agrica[29]));
    const auto pvtsln = body_fields(lines("#PVTSLNA").back().text);
    EXPECT_EQ(pvtsln[0] + pvtsln[20], "SINGLENARROW_INT");
    EXPECT_NEAR(std::stod(pvtsln[22]), 45, 1e-3);
    EXPECT_EQ(pvtsln.size(), 35 + std::stoul(pvtsln[34]));
    EXPECT_THAT(lines("$GNGGA").back().text, testing::HasSubstr(",E,1,32,"));
    epoch_.relative.reset();
    wait(2s);
    EXPECT_THAT(lines("#UNIHEADINGA").back().text, testing::HasSubstr(";INSUFFICIENT_OBS,NONE,0.0000,0.0000,"));
}

TEST_F(UnicoreReceiver, BinaryBestNavHasItsFieldsWhereClientsLook) {
    say("BESTNAVB 1");
    wait(3s);
    const Bytes& all = bytes_[PortId::uart1];
    std::size_t at = 0;
    while (at + 148 <= all.size() && !(all[at] == 0xAA && all[at + 1] == 0x44 && all[at + 2] == 0xB5))
        ++at;
    ASSERT_LE(at + 148, all.size());
    const std::uint8_t* const frame = all.data() + at;
    EXPECT_EQ(frame[4] + 256 * frame[5], 2118);
    EXPECT_EQ(frame[6] + 256 * frame[7], 120);
    EXPECT_EQ(frame[9], 0xA0);
    std::uint32_t crc = 0;
    std::memcpy(&crc, frame + 144, 4);
    EXPECT_EQ(own_crc(frame, 144), crc);
    const auto real8 = [&](std::size_t i) {
        double value = 0;
        std::memcpy(&value, frame + 24 + i, 8);
        return value;
    };
    EXPECT_NEAR(real8(8), 47.3977, 1e-9);
    EXPECT_NEAR(real8(16), 8.5456, 1e-9);
    EXPECT_NEAR(real8(24), 441, 1e-3);
    EXPECT_NEAR(real8(88), 8.06, 1e-6);
    EXPECT_EQ(frame[24 + 4], 16) << "SINGLE";
    EXPECT_EQ(frame[24 + 65], 32);
}

TEST_F(UnicoreReceiver, MeasurementsAreTextAndBytes) {
    Observation o;
    o.satellite = {Constellation::glonass, 14};
    o.signal = Signal::g1;
    o.carrier = carrier_frequency(Signal::g1, -7);
    o.cn0 = DbHz(41.99);
    o.pseudorange = Metres(21119246.501);
    o.carrier_phase = 112577420.25;
    o.doppler = Hertz(-2918.5);
    o.lock_time = Seconds(12);
    epoch_.observations.signals = {o};
    say("OBSVMA 1");
    wait(3s);
    // As that satellite stands in a capture (raw-obs-dual-460800.jsonl: "0,51,21119246.501,…,20191c23").
    const auto fields = body_fields(lines("#OBSVMA").back().text);
    ASSERT_THAT(fields, SizeIs(12));
    EXPECT_EQ(fields[0] + ' ' + fields[1] + ' ' + fields[2], "1 0 51");
    EXPECT_EQ(fields[3], "21119246.501");
    EXPECT_EQ(fields[4], "-112577420.250000");
    EXPECT_EQ(fields[7], "-2918.500");
    EXPECT_EQ(fields[8], "4199");
    EXPECT_EQ(fields[11], "20191c23");
}

}  // namespace
}  // namespace skyloop::firmware
