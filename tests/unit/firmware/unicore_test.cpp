// A Unicore receiver as its client meets it. Checks of sums and fields are the tests' own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
