// A receiver with CASIC's chip as its clients meet it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dialogue_receiver.hpp"
#include "receiver/protocol/casic_messages.hpp"
#include "receiver/protocol/decoded_message.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

struct CasicReceiver : DialogueReceiver {
    explicit CasicReceiver(const std::string& board = "casic-at6558") : DialogueReceiver(board) { quiet(); }
    void quiet() {
        say("PCAS03,0,0,0,0,0,0,0,0,0,0,,,0,0");
        wait(2s);
        forget();
    }
    // What a frame is answered by, as listed.
    std::vector<std::string> replies(const Bytes& frame) {
        forget();
        write(frame);
        wait(300ms);
        std::vector<std::string> lines;
        for (const Bytes& reply : frames(StreamKind::casic))
            lines.push_back(text_line(decode_piece({StreamKind::casic, reply})));
        return lines;
    }
    template <class Message>
    std::vector<Message> heard() const {
        std::vector<Message> messages;
        for (const Bytes& bytes : frames(StreamKind::casic)) {
            const auto frame = parse_casic_frame(bytes);
            if (frame && frame->id == Message::message_id) messages.push_back(*decode_payload<Message>(frame->payload));
        }
        return messages;
    }
};

std::string casic_acknowledged(int id) { return "CASIC ACK-ACK class=6 id=" + std::to_string(id); }
std::string casic_refused(int id) { return "CASIC ACK-NACK class=6 id=" + std::to_string(id); }

Bytes casic_rate_of(std::uint8_t message_class, std::uint8_t id, std::uint16_t rate) {
    CasicCfgMsg message;
    message.message_class = message_class;
    message.id = id;
    message.rate = rate;
    return encode_casic(message);
}

TEST(Casic, SendsItsSentencesFromTheFactoryOn) {
    DialogueReceiver receiver("casic-at6558");
    receiver.wait(2s);
    receiver.forget();
    receiver.wait(1s);
    std::vector<std::string> lines = receiver.lines();
    ASSERT_FALSE(lines.empty());
    EXPECT_EQ(lines.front(), "$GNGGA,120002.000,4723.86200,N,00832.73600,E,1,16,0.8,441.0,M,47.0,M,,*4B");
    const auto begins = [&](const std::string& begin) {
        return std::ranges::count_if(lines, [&](const std::string& line) { return line.starts_with(begin); });
    };
    EXPECT_EQ(begins("$GNGSA,"), 2) << "GPS and BeiDou";
    EXPECT_GE(begins("$BDGSV,"), 1);
    EXPECT_EQ(begins("$GBGSV,"), 0);
    EXPECT_EQ(begins("$GPTXT,01,01,01,ANTENNA OK*35"), 1);
    for (const std::string& line : lines) {
        const bool list = line.find("GSV,") != std::string::npos, rmc = line.find("RMC,") != std::string::npos;
        EXPECT_TRUE(!list || line.find(",0*") != std::string::npos) << line << ": signal 0";
        EXPECT_TRUE(!rmc || line.find(",,,A,V*") != std::string::npos) << line;
    }
}

TEST(Casic, SaysWhoItIsAtAStart) {
    CasicReceiver receiver;
    receiver.say("PCAS10,0");
    receiver.wait(1500ms);
    const auto lines = receiver.lines("$GPTXT,01,01,02,");
    ASSERT_THAT(lines, SizeIs(8));
    EXPECT_EQ(lines[0], "$GPTXT,01,01,02,MA=CASIC*27");
    EXPECT_EQ(lines[3], "$GPTXT,01,01,02,SW=URANUS5,V5.3.0.0*1D");
}

TEST(Casic, AnswersWhatItIsAskedForAlone) {
    CasicReceiver receiver;
    EXPECT_THAT(receiver.answers("PCAS06,0", "$"), ElementsAre("$GPTXT,01,01,02,SW=URANUS5,V5.3.0.0*1D"));
    EXPECT_THAT(receiver.answers("PCAS06,1", "$"), ElementsAre("$GPTXT,01,01,02,HW=ATGM336H,0004090746370*1E"));
    for (const char* const body : {"PCAS06,4", "PCAS06", "PCAS06,9", "PCAS02,200", "PCAS04,3", "PCAS99,1", "PCAS",
                                   "PMTK605", "PCAS01,9", "PCAS11,8", "PCAS03,x,y"})
        EXPECT_THAT(receiver.answers(body, "$"), IsEmpty()) << body;
    receiver.forget();
    receiver.write(to_bytes("$PCAS06,0*1C\r\n$PCAS06,0\r\n$PCAS06,"));
    receiver.wait(1s);
    EXPECT_THAT(receiver.lines(), IsEmpty()) << "wrong checksum, none, half a command";
    CasicReceiver l76k("quectel-l76k");
    EXPECT_THAT(l76k.answers("PCAS06,0", "$"), ElementsAre("$GPTXT,01,01,02,SW=URANUS5,V5.1.0.0*1F"));
    EXPECT_THAT(l76k.answers("PCAS06,1", "$"), ElementsAre(testing::StartsWith("$GPTXT,01,01,02,HW=*")));
}

TEST(Casic, SetsRatesSystemsMotionAndSpeedByText) {
    CasicReceiver receiver;
    receiver.say("PCAS03,1,0,0,0,2,,,0");
    receiver.wait(1s);
    receiver.forget();
    receiver.wait(4s);
    EXPECT_THAT(receiver.lines("$GNGGA"), SizeIs(4));
    EXPECT_THAT(receiver.lines("$GNRMC"), SizeIs(2));
    EXPECT_THAT(receiver.lines("$"), SizeIs(6));
    receiver.say("PCAS02,200");
    receiver.say("PCAS04,1");
    receiver.say("PCAS11,3");
    receiver.say("PCAS01,5");
    receiver.wait(1s);
    const ReceiverSettings& settings = receiver.receiver().settings();
    EXPECT_EQ(settings.navigation_period, 200ms);
    EXPECT_TRUE(settings.tracks(Constellation::gps, Signal::l1));
    EXPECT_FALSE(settings.tracks(Constellation::beidou, Signal::b1i));
    EXPECT_EQ(receiver.receiver().baud(PortId::uart1), 115200u);
    receiver.say("PCAS04,0");
    receiver.say("PCAS02,70");
    receiver.wait(100ms);
    EXPECT_EQ(receiver.receiver().settings().navigation_period, 200ms);
    EXPECT_TRUE(receiver.receiver().settings().tracks(Constellation::gps, Signal::l1));
}

TEST(Casic, KeepsWhatIsSaved) {
    CasicReceiver receiver;
    receiver.say("PCAS02,500");
    receiver.say("PCAS00");
    receiver.say("PCAS02,200");
    receiver.say("PCAS10,0");
    receiver.wait(2s);
    EXPECT_EQ(receiver.receiver().settings().navigation_period, 500ms);
    EXPECT_THAT(receiver.receiver().persistent_text(), testing::HasSubstr("flash fix_interval_ms 500\n"));
    receiver.say("PCAS10,3");
    receiver.wait(2s);
    EXPECT_EQ(receiver.receiver().settings().navigation_period, 1s);
}

TEST(Casic, StandsByForSoLong) {
    CasicReceiver receiver;
    receiver.say("PCAS12,5");
    receiver.wait(1s);
    receiver.forget();
    receiver.wait(3s);
    EXPECT_THAT(receiver.lines(), IsEmpty());
    receiver.wait(4s);
    EXPECT_THAT(receiver.lines("$GPTXT,01,01,02,MA=CASIC"), SizeIs(1));
}

TEST(Casic, AcknowledgesEachConfigurationFrame) {
    CasicReceiver receiver;
    EXPECT_THAT(receiver.replies(encode_casic_frame({0x06, 0x00}, {})),
                ElementsAre("CASIC CFG-PRT port=0 protocols=51 mode=2240 baud=9600",
                            "CASIC CFG-PRT port=1 protocols=51 mode=2240 baud=9600", casic_acknowledged(0)));
    EXPECT_THAT(receiver.replies(encode_casic_frame({0x06, 0x04}, {})),
                ElementsAre("CASIC CFG-RATE interval_s=1", casic_acknowledged(4)));
    EXPECT_THAT(receiver.replies(encode_casic_frame({0x06, 0x01}, {})), SizeIs(16));
    CasicCfgRate rate;
    rate.interval = 200;
    EXPECT_THAT(receiver.replies(encode_casic(rate)), ElementsAre(casic_acknowledged(4)));
    EXPECT_EQ(receiver.receiver().settings().navigation_period, 200ms);
    rate.interval = 33;
    EXPECT_THAT(receiver.replies(encode_casic(rate)), ElementsAre(casic_refused(4)));
    EXPECT_THAT(receiver.replies(casic_rate_of(0x4E, 0x0D, 1)), ElementsAre(casic_refused(1))) << "DHV";
    EXPECT_THAT(receiver.replies(encode_casic_frame({0x06, 0x04}, Bytes(8))), ElementsAre(casic_refused(4)))
        << "too long";
    EXPECT_THAT(receiver.replies(encode_casic_frame({0x06, 0x33}, Bytes(4))), ElementsAre(casic_refused(0x33)));
    EXPECT_THAT(receiver.replies(encode_casic_frame({0x0A, 0x04}, {})), IsEmpty()) << "MON-VER, of version 5";
    Bytes wrong = encode_casic(rate);
    wrong.back() ^= 1;
    EXPECT_THAT(receiver.replies(wrong), IsEmpty());
}

TEST(Casic, TellsItsVersionWhereTheBoardDoes) {
    BoardProfile board = test::board_named("casic-at6558");
    board.polled = {{0x0A, 0x04}};
    DialogueReceiver receiver(board);
    receiver.say("PCAS03,0,0,0,0,0,0,0,0");
    receiver.wait(3s);
    receiver.forget();
    receiver.write(encode_casic_frame({0x0A, 0x04}, {}));
    receiver.wait(500ms);
    ASSERT_THAT(receiver.frames(StreamKind::casic), SizeIs(1));
    EXPECT_EQ(text_line(decode_piece({StreamKind::casic, receiver.frames(StreamKind::casic)[0]})),
              "CASIC MON-VER software=URANUS5,V5.3.0.0 hardware=ATGM336H");
}

TEST(Casic, SetsTheNavigationEngine) {
    CasicReceiver receiver;
    CasicCfgNavx navx;
    navx.apply = 0x0103;  // as Meshtastic sends it
    navx.dynamic_model = 3;
    navx.fix_mode = 3;
    navx.systems = 7;
    EXPECT_THAT(receiver.replies(encode_casic(navx)), ElementsAre(casic_acknowledged(7)));
    EXPECT_TRUE(receiver.receiver().settings().tracks(Constellation::glonass, Signal::g1));
    const auto told = receiver.replies(encode_casic_frame({0x06, 0x07}, {}));
    ASSERT_THAT(told, SizeIs(2));
    EXPECT_THAT(told[0], testing::HasSubstr("dynamic_model=3 fix_mode=3"));
    EXPECT_THAT(told[0], testing::HasSubstr("least_elevation_deg=5"));
    EXPECT_THAT(told[0], testing::HasSubstr("systems=7"));
    navx.apply = 0x0141;
    navx.least_elevation = 15;
    navx.systems = 0;
    EXPECT_THAT(receiver.replies(encode_casic(navx)), ElementsAre(casic_refused(7)));
    EXPECT_NEAR(receiver.receiver().settings().elevation_mask.deg(), 5, 1e-12) << "all or nothing";
    navx.apply = 0x0040;
    EXPECT_THAT(receiver.replies(encode_casic(navx)), ElementsAre(casic_acknowledged(7)));
    EXPECT_NEAR(receiver.receiver().settings().elevation_mask.deg(), 15, 1e-12);
}

TEST(Casic, SendsBinaryMessages) {
    CasicReceiver receiver;
    for (const int id : {0x01, 0x02, 0x03, 0x10, 0x20, 0x21, 0x22})
        EXPECT_THAT(receiver.replies(casic_rate_of(0x01, static_cast<std::uint8_t>(id), 1)),
                    testing::Contains(casic_acknowledged(1)));
    receiver.wait(1s);
    receiver.forget();
    receiver.wait(1s);
    const auto pv = receiver.heard<CasicNavPv>();
    ASSERT_THAT(pv, SizeIs(1));
    const Fix fix = receiver.epoch_.fix;
    EXPECT_EQ(pv[0].pos_valid, casic_3d);
    EXPECT_NEAR(pv[0].lat, 47.3977, 1e-9);
    EXPECT_NEAR(pv[0].lon, 8.5456, 1e-9);
    EXPECT_NEAR(pv[0].height, 488, 1e-3);
    EXPECT_NEAR(pv[0].geoid, 47, 1e-4);
    EXPECT_NEAR(pv[0].h_var, fix.horizontal_accuracy.value() * fix.horizontal_accuracy.value(), 1e-4) << "a variance";
    EXPECT_NEAR(pv[0].vel_n, 8, 1e-6);
    EXPECT_NEAR(pv[0].vel_u, -fix.velocity.down, 1e-6);
    const auto sol = receiver.heard<CasicNavSol>();
    ASSERT_THAT(sol, SizeIs(1));
    EXPECT_EQ(sol[0].week, 2304);
    EXPECT_NEAR(sol[0].ecef[0], 4277460, 3000);
    const auto time = receiver.heard<CasicNavTimeutc>();
    ASSERT_THAT(time, SizeIs(1));
    EXPECT_EQ(time[0].year, 2024);
    EXPECT_EQ(time[0].hour, 12);
    EXPECT_EQ(time[0].valid, 7);
    const auto gps = receiver.heard<CasicGpsSatellites>();
    ASSERT_THAT(gps, SizeIs(1));
    EXPECT_EQ(gps[0].used, pv[0].num_gps);
    ASSERT_THAT(receiver.heard<CasicBeidouSatellites>(), SizeIs(1));
    EXPECT_EQ(receiver.heard<CasicBeidouSatellites>()[0].used, pv[0].num_bds);
    EXPECT_THAT(receiver.heard<CasicGlonassSatellites>(), SizeIs(1));
    EXPECT_THAT(receiver.heard<CasicNavDop>(), SizeIs(1));
}

TEST(Casic, SendsAMessageOnceAtOnce) {
    CasicReceiver receiver;
    EXPECT_THAT(receiver.replies(casic_rate_of(0x01, 0x03, 0xFFFF)),
                ElementsAre(testing::StartsWith("CASIC NAV-PV "), casic_acknowledged(1)));
    receiver.replies(casic_rate_of(0x4E, 0x04, 0xFFFF));
    EXPECT_THAT(receiver.lines("$GNRMC"), SizeIs(1));
    receiver.forget();
    receiver.wait(3s);
    EXPECT_THAT(receiver.lines(), IsEmpty());
}

TEST(Casic, SilencesOneProtocolOfAPort) {
    CasicReceiver receiver;
    receiver.say("PCAS03,1,0,0,0,0,0,0,0");
    receiver.replies(casic_rate_of(0x01, 0x03, 1));
    CasicCfgPrt port;
    port.port = 0xFF;
    port.protocols = 0x13;
    port.mode = 0x08C0;
    port.baud = 38400;
    receiver.write(encode_casic(port));
    receiver.wait(1500ms);
    receiver.forget();
    receiver.wait(2s);
    EXPECT_EQ(receiver.receiver().baud(PortId::uart1), 38400u);
    EXPECT_THAT(receiver.lines("$G"), IsEmpty());
    EXPECT_THAT(receiver.heard<CasicNavPv>(), SizeIs(2));
    port.mode = 0x0000;
    EXPECT_THAT(receiver.replies(encode_casic(port)), testing::Contains(casic_refused(0))) << "five bits";
}

TEST(Casic, RestartsByAFrame) {
    CasicReceiver receiver;
    CasicCfgRst restart;
    restart.mode = 1;
    receiver.write(encode_casic(restart));
    receiver.wait(1s);
    EXPECT_THAT(receiver.lines("$GPTXT,01,01,02,MA=CASIC"), SizeIs(1));
    restart.mode = 9;
    receiver.wait(3s);
    EXPECT_THAT(receiver.replies(encode_casic(restart)), testing::Contains(casic_refused(2)));
}

}  // namespace
}  // namespace skyloop::firmware
