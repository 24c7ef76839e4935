// A Unicore receiver as its client meets it. Checks of sums and fields are the tests' own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "receiver/protocol/rtcm3.hpp"
#include "unicore_receiver.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::MatchesRegex;
using testing::SizeIs;
using testing::StartsWith;

std::string with_sum(const std::string& answer, std::size_t from) {
    unsigned sum = 0;
    for (std::size_t i = from; i < answer.size(); ++i)
        sum ^= static_cast<unsigned char>(answer[i]);
    constexpr char digits[] = "0123456789ABCDEF";
    return answer + '*' + digits[sum >> 4] + digits[sum & 15];
}
// Of an answer the sum covers the dollar.
std::string answer_line(const std::string& text) { return with_sum(text, 0); }
std::string ok_to(const std::string& command) { return answer_line("$command," + command + ",response: OK"); }
std::string refusal_of(const std::string& command, const std::string& name) {
    return answer_line("$command," + command + ",response: PARSING FAILD NO MATCHING FUNC  " + name);
}

// CRC-32 from the highest bit of the reversed polynomial down, by polynomial division of the reflected bits.
std::uint32_t own_crc(const std::uint8_t* bytes, std::size_t size) {
    std::uint32_t crc = 0;
    for (std::size_t i = 0; i < 8 * size; ++i) {
        const std::uint32_t bit = bytes[i / 8] >> i % 8 & 1u;
        const bool turn = ((crc ^ bit) & 1u) != 0;
        crc >>= 1;
        if (turn) crc ^= 0xEDB88320u;
    }
    return crc;
}

// The fields of a log's body, its CRC having been checked.
std::vector<std::string> body_fields(const std::string& line) {
    const std::size_t star = line.rfind('*'), body = line.find(';');
    EXPECT_NE(body, std::string::npos) << line;
    const std::string covered = line.substr(1, star - 1);
    EXPECT_EQ(own_crc(reinterpret_cast<const std::uint8_t*>(covered.data()), covered.size()),
              std::stoul(line.substr(star + 1), nullptr, 16))
        << line;
    std::vector<std::string> fields(1);
    for (const char c : line.substr(body + 1, star - body - 1))
        c == ',' ? fields.emplace_back() : fields.back() += c;
    return fields;
}

TEST_F(UnicoreReceiver, IsSilentUntilItIsAsked) {
    wait(3s);
    EXPECT_TRUE(bytes_.empty());
    EXPECT_THAT(answers("GPGGA 1"), testing::Contains(ok_to("GPGGA 1")));
}

TEST_F(UnicoreReceiver, AnswersAfter40To65Milliseconds) {
    for (int i = 0; i < 10; ++i) {
        forget();
        const GpsTime asked = now_;
        say("UNLOG");
        wait(100ms);
        ASSERT_THAT(texts(), ElementsAre(ok_to("UNLOG")));
        const double line_s = 10.0 * static_cast<double>(ok_to("UNLOG").size() + 2) / 115200;
        const double waited = difference(lines_[PortId::uart1][0].at, asked).value() - line_s;
        EXPECT_GE(waited, 0.0395);
        EXPECT_LE(waited, 0.0665);
    }
}

TEST_F(UnicoreReceiver, TakesCommandsInAnyLettersAndWithAChecksum) {
    wait(1s);
    EXPECT_THAT(answers("$VERSIONA*1B"), ElementsAre(ok_to("VERSIONA"), StartsWith("#VERSIONA,97,GPS,FINE,2304,")));
    EXPECT_THAT(answers("unlogall"), ElementsAre(ok_to("unlogall")));
    EXPECT_THAT(answers("rtcm1077,com1,1"), ElementsAre(ok_to("rtcm1077,com1,1")));
    EXPECT_EQ(
        body_fields(answers("versiona").at(1)),
        (std::vector<std::string>{"\"UM982\"", "\"R4.10Build13495\"", "\"HRPT00-S10C-P\"",
                                  "\"2310415000012-LR23A1224506723\"", "\"ff3ba396dcb0478e\"", "\"2024/04/03\""}));
}

TEST_F(UnicoreReceiver, RefusesWhatItDoesNotKnow) {
    EXPECT_THAT(answers("badResponse"), ElementsAre(refusal_of("badResponse", "BADRESPONSE")));
    EXPECT_THAT(answers("SATSXXXXB COM1 1"), ElementsAre(refusal_of("SATSXXXXB COM1 1", "SATSXXXXB")));
    EXPECT_THAT(answers("rtcm1230,com1,10"), ElementsAre(refusal_of("rtcm1230,com1,10", "RTCM1230")));
    EXPECT_THAT(answers("$VERSIONA*1C"), ElementsAre(refusal_of("$VERSIONA*1C", "$VERSIONA*1C")));
    EXPECT_THAT(answers("GPGGA COM1 0.001"), ElementsAre(refusal_of("GPGGA COM1 0.001", "GPGGA"))) << "too often";
    EXPECT_THAT(answers("CONFIG COM1 12345"), ElementsAre(refusal_of("CONFIG COM1 12345", "CONFIG")));
    EXPECT_THAT(answers("MODE BASE 1 2 3 4 5"), ElementsAre(refusal_of("MODE BASE 1 2 3 4 5", "MODE")));
    EXPECT_THAT(answers("MASK x"), ElementsAre(refusal_of("MASK x", "MASK")));
    const auto cut = answers("MODE " + std::string(5000, 'A'));
    ASSERT_THAT(cut, SizeIs(1));
    EXPECT_THAT(cut[0], testing::HasSubstr("response: PARSING FAILD NO MATCHING FUNC  MODE*"));
    EXPECT_THAT(answers(""), SizeIs(0));
}

TEST_F(UnicoreReceiver, HeedsNoBytesThatAreNoText) {
    Bytes garbage{0xB5, 0x62, 0x06, 0x08, '\r', '\n', 0xFF, 0x00};
    receiver_.input(PortId::uart1, garbage, now_);
    EXPECT_THAT(answers("\r\nUNLOG"), ElementsAre(ok_to("UNLOG")));
}

TEST_F(UnicoreReceiver, WritesSentencesAsItsCapturesHaveThem) {
    for (const char* const log : {"GPRMC 1", "GPGGA 1", "GPGSA 1", "GPGSV 1", "GPVTG 1", "GPGLL 1"})
        say(log);
    wait(1s);
    forget();
    wait(1s);
    const auto all = texts();
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
    for (const char* const log : {"GPRMC 1", "GPGGA 1", "GPGSA 1", "GPGSV 1", "GPVTG 1", "GPGLL 1"})
        say(log);
    wait(1s);
    forget();
    wait(1s);
    const auto all = texts();
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

TEST_F(UnicoreReceiver, ChangesTheSpeedOfOnePort) {
    EXPECT_THAT(answers("CONFIG COM2 230400 8 n 1"), ElementsAre(ok_to("CONFIG COM2 230400 8 n 1")));
    EXPECT_EQ(receiver_.baud(PortId::uart1), 115200u);
    EXPECT_EQ(receiver_.baud(PortId::uart2), 230400u);
    EXPECT_EQ(receiver_.baud(PortId::uart3), 115200u);
    EXPECT_THAT(answers("CONFIG COM1 460800"), ElementsAre(ok_to("CONFIG COM1 460800")));
    EXPECT_EQ(receiver_.baud(PortId::uart1), 460800u);
}

TEST_F(UnicoreReceiver, ShowsItsConfiguration) {
    wait(1s);
    auto told = answers("CONFIG");
    EXPECT_EQ(told.front(), ok_to("CONFIG"));
    EXPECT_THAT(told, testing::Contains("$CONFIG,COM3,CONFIG COM3 115200*23"));
    EXPECT_THAT(told, testing::Contains("$CONFIG,RTK,CONFIG RTK TIMEOUT 120*6C"));
    EXPECT_THAT(told, testing::Contains("$CONFIG,RTK,CONFIG RTK RELIABILITY 3 1*76"));
    EXPECT_THAT(answers("MASK"), ElementsAre(ok_to("MASK"), "$CONFIG,MASK,MASK 5.0*25"));
    EXPECT_THAT(answers("MASK 10"), ElementsAre(ok_to("MASK 10")));
    EXPECT_EQ(receiver_.settings().elevation_mask.deg(), 10);
    EXPECT_THAT(answers("MASK GLO"), ElementsAre(ok_to("MASK GLO")));
    EXPECT_FALSE(receiver_.settings().tracks(Constellation::glonass, Signal::g1));
    EXPECT_THAT(answers("CONFIG HEADING FIXLENGTH"), ElementsAre(ok_to("CONFIG HEADING FIXLENGTH")));
    EXPECT_THAT(answers("CONFIG UNDULATION AUTO"), ElementsAre(ok_to("CONFIG UNDULATION AUTO")));
    told = answers("MODE");
    ASSERT_THAT(told, SizeIs(2));
    EXPECT_THAT(told[1], MatchesRegex("#MODE,97,GPS,FINE,2304,[0-9]+,0,0,18,[0-9]+;MODE ROVER SURVEY,\\*.."));
    EXPECT_EQ(told[1], answer_line(told[1].substr(0, told[1].size() - 3)));
    EXPECT_THAT(answers("MODE MOVINGBASE"), ElementsAre(ok_to("MODE MOVINGBASE")));
    EXPECT_THAT(answers("MODE").at(1), testing::HasSubstr(";MODE MOVINGBASE,*"));
    EXPECT_EQ(answers("GPGGA COM3 0.2").at(0), ok_to("GPGGA COM3 0.2"));
    EXPECT_THAT(answers("LOGLIST"), ElementsAre(ok_to("LOGLIST"), StartsWith("<LOGLIST COM1 0 97.000000 FINE 2304 "),
                                                "<\t1", "<\tGPGGA COM3 0.2 ", ""));
}

TEST_F(UnicoreReceiver, SaysItsPortsNamesAtAStartAndGoesOnWithWhatWasSaved) {
    say("GPGGA COM1 1");
    say("SAVECONFIG");
    say("GPRMC COM1 1");
    wait(1s);
    EXPECT_THAT(answers("RESET"), testing::Contains(ok_to("RESET")));
    forget();
    wait(8s);
    EXPECT_EQ(texts()[0], "$devicename,COM1*67");
    EXPECT_THAT(texts(PortId::uart3), ElementsAre("$devicename,COM3*65"));
    EXPECT_FALSE(lines("$GNGGA").empty());
    EXPECT_TRUE(lines("$GNRMC").empty());
    EXPECT_THAT(answers("FRESET"), testing::Contains(ok_to("FRESET")));
    wait(8s);
    forget();
    wait(2s);
    EXPECT_TRUE(bytes_.empty());
}

TEST_F(UnicoreReceiver, SoonAfterAStartVersionHasNoBody) {
    say("RESET");
    wait(3200ms);
    ASSERT_THAT(texts(), testing::Contains("$devicename,COM1*67"));
    EXPECT_THAT(answers("VERSIONA"), ElementsAre(ok_to("VERSIONA")));
    wait(4s);
    EXPECT_THAT(answers("VERSIONA"), SizeIs(2));
}

TEST_F(UnicoreReceiver, ANewGroupOfSignalsRestartsIt) {
    EXPECT_THAT(answers("CONFIG SIGNALGROUP 3 6"), ElementsAre(ok_to("CONFIG SIGNALGROUP 3 6")));
    wait(6s);
    EXPECT_THAT(texts(), testing::Contains("$devicename,COM1*67"));
    EXPECT_THAT(answers("CONFIG SIGNALGROUP"),
                testing::Contains(StartsWith("$CONFIG,SIGNALGROUP,CONFIG SIGNALGROUP 3 6*")));
}

TEST_F(UnicoreReceiver, KeepsWhatItSavedAsText) {
    for (const char* const line : {"CONFIG COM2 230400", "MODE BASE 7 TIME 60 1", "MASK 12", "MASK BDS",
                                   "AGRICA COM2 0.2", "RTCM1077 COM3 1", "SAVECONFIG"})
        EXPECT_THAT(answers(line).at(0), ok_to(line));
    const std::string text = receiver_.persistent_text();
    Receiver other(test::board_named("unicore-um982"), {});
    ASSERT_TRUE(other.restore(text, "saved"));
    EXPECT_EQ(other.persistent_text(), text);
    EXPECT_EQ(other.baud(PortId::uart2), 230400u);
    EXPECT_EQ(other.settings().navigation_period, 200ms);
    const auto refusal = other.restore("GPGGA COM1 1\nGPXYZ COM1 1\n", "saved");
    ASSERT_FALSE(refusal);
    EXPECT_EQ(refusal.error().message, "saved: 'GPXYZ COM1 1' is no setting of a UM982");
}

TEST_F(UnicoreReceiver, IsABaseWhereItWasTold) {
    Observation o;
    o.satellite = {Constellation::gps, 7};
    o.carrier = carrier_frequency(Signal::l1);
    o.cn0 = DbHz(41);
    o.pseudorange = Metres(2.2e7);
    o.carrier_phase = 1.1e8;
    o.lock_time = Seconds(20);
    epoch_.observations.signals = {o};
    EXPECT_THAT(answers("MODE BASE 4278990.0 643080.0 4671950.0").at(0),
                ok_to("MODE BASE 4278990.0 643080.0 4671950.0"));
    for (const char* const log : {"RTCM1005 COM3 1", "RTCM1006 COM3 1", "RTCM1033 COM3 1", "RTCM1074 COM3 1"})
        say(log);
    wait(2s);
    forget();
    wait(1s);
    StreamSplitter splitter;
    std::vector<int> numbers;
    for (const StreamPiece& piece : splitter.feed(bytes_[PortId::uart3])) {
        ASSERT_EQ(piece.kind, StreamKind::rtcm3);
        const auto message = parse_rtcm3(piece.bytes);
        numbers.push_back(message->number);
        const auto station = decode_station(*message);
        EXPECT_EQ(station.has_value(), message->number < 1033);
        if (station) {
            EXPECT_EQ(station->position[0], 42789900000);
        }
    }
    EXPECT_THAT(numbers, ElementsAre(1005, 1006, 1033, 1074));
    EXPECT_THAT(answers("BESTNAVA").at(1), testing::HasSubstr(";SOL_COMPUTED,FIXEDPOS,"));
    EXPECT_THAT(answers("MODE").at(1), testing::HasSubstr(";MODE BASE 4278990.0 643080.0 4671950.0,*"));
}

class Um980 : public UnicoreReceiver {
protected:
    Um980() : UnicoreReceiver("unicore-um980") {}
};

TEST_F(Um980, HasOneAntenna) {
    epoch_.relative = RelativePosition{1, 0, 0, Metres(0.005)};
    EXPECT_THAT(answers("UNIHEADINGA 1"), ElementsAre(refusal_of("UNIHEADINGA 1", "UNIHEADINGA")));
    EXPECT_EQ(body_fields(answers("AGRICA").at(1))[9], "0");
    EXPECT_THAT(answers("VERSIONA").at(1), testing::HasSubstr(";\"UM980\",\"R4.10Build11833\","));
}

}  // namespace
}  // namespace skyloop::firmware
