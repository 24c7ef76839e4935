// Quectel's receivers as their clients meet them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dialogue_receiver.hpp"
#include "receiver/protocol/rtcm3.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

// Answers without the checksum, which the splitter has held.
std::vector<std::string> quectel_told(DialogueReceiver& receiver, const std::string& body) {
    std::vector<std::string> lines = receiver.answers(body, "$P");
    for (std::string& line : lines)
        line = line.substr(1, line.rfind('*') - 1);
    return lines;
}

std::vector<int> quectel_rtcm_numbers(const DialogueReceiver& receiver) {
    std::vector<int> numbers;
    for (const Bytes& frame : receiver.frames(StreamKind::rtcm3))
        numbers.push_back(frame[3] << 4 | frame[4] >> 4);
    return numbers;
}

void save_and_restart(DialogueReceiver& receiver) {
    EXPECT_THAT(quectel_told(receiver, "PQTMSAVEPAR"), ElementsAre("PQTMSAVEPAR,OK"));
    EXPECT_THAT(quectel_told(receiver, "PQTMSRR"), IsEmpty());
    receiver.wait(17s);
    receiver.forget();
}

TEST(Quectel, SendsItsSentencesTenTimesASecond) {
    DialogueReceiver receiver("quectel-lg290p");
    receiver.wait(2s);
    receiver.forget();
    receiver.wait(2s);
    for (const char* const often : {"$GNGGA", "$GNRMC", "$GNGLL", "$GNVTG"})
        EXPECT_THAT(receiver.lines(often), SizeIs(20)) << often;
    EXPECT_THAT(receiver.lines("$GNGSA"), SizeIs(2 * 6)) << "each second, six systems";
    EXPECT_THAT(receiver.lines("$GNGGA")[0], testing::HasSubstr(",4723.86200000,N,00832.73600000,E,"));
}

TEST(Quectel, AnswersAsCaptured) {
    DialogueReceiver receiver("quectel-lg290p");
    EXPECT_THAT(quectel_told(receiver, "PQTMVERNO"), ElementsAre("PQTMVERNO,LG290P03AANR02A01S,2025/12/12,11:21:01"));
    EXPECT_THAT(quectel_told(receiver, "PQTMUNIQID"), ElementsAre("PQTMUNIQID,OK,8,0000183B31B3C252"));
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGUART,R"), ElementsAre("PQTMCFGUART,OK,1,460800,8,0,1,0"));
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGPPS,R,1"), ElementsAre("PQTMCFGPPS,OK,1,1,100,1,1,0"));
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGELETHD,R"), ElementsAre("PQTMCFGELETHD,OK,5.0"));
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGCNST,R"), ElementsAre("PQTMCFGCNST,OK,1,1,1,1,1,1"));
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGSIGNAL,R"), ElementsAre("PQTMCFGSIGNAL,OK,07,03,0F,3F,0F,01"));
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGSVIN,R"),
                ElementsAre("PQTMCFGSVIN,OK,0,0,0.0,0.0000,0.0000,0.0000,0.0"));
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGRCVRMODE,R"), ElementsAre("PQTMCFGRCVRMODE,OK,1"));
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGRTCM,R"), ElementsAre("PQTMCFGRTCM,OK,4,0,-90.0,07,06,1,0"));
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGMSGRATE,R,GGA"), ElementsAre("PQTMCFGMSGRATE,OK,GGA,1"));
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGMSGRATE,R,PQTMEPE,2"), ElementsAre("PQTMCFGMSGRATE,OK,PQTMEPE,0,2"));
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGMSGRATE,R,1,2,GSV"), ElementsAre("PQTMCFGMSGRATE,OK,1,2,GSV,10"));
    receiver.forget();
    receiver.say("PQTMVER");
    receiver.wait(100ms);
    EXPECT_THAT(receiver.lines(), Contains("$PQTMVER,ERROR,3*32"));
}

TEST(Quectel, RefusesWhatCannotBe) {
    DialogueReceiver receiver("quectel-lg290p");
    for (const char* const wrong :
         {"CFGUART,W,12345", "CFGUART,R,1,4", "CFGFIXRATE,W,70", "CFGMSGRATE,W,XYZ,1", "CFGMSGRATE,W,GGA,99",
          "CFGMSGRATE,R,PQTMEPE,1", "CFGCNST,W,1,1", "CFGCNST,W,1,1,2,1,1,1", "CFGRCVRMODE,W,3", "CFGRCVRMODE",
          "CFGSVIN,W,1,60", "CFGSVIN,W,9,0,0,0,0,0", "CFGSVIN,W,2,0,0,9e9,0,0", "CFGELETHD,W,x", "CFGPPS,W"}) {
        const std::string name = "PQTM" + std::string(wrong).substr(0, std::string(wrong).find(','));
        EXPECT_THAT(quectel_told(receiver, "PQTM" + std::string(wrong)), ElementsAre(name + ",ERROR,1")) << wrong;
    }
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGCNST,W,0,0,0,0,1,1"), ElementsAre("PQTMCFGCNST,ERROR,2"));
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGMSGRATE,R,PQTMSVINSTATUS,1"), ElementsAre("PQTMCFGMSGRATE,ERROR,2"))
        << "of a rover";
    EXPECT_THAT(quectel_told(receiver, "PAIR021"), IsEmpty()) << "no chip of Airoha's";
    receiver.forget();
    receiver.write(to_bytes("$PQTMVERNO*59\r\n$PQTMVERNO\r\n$PQTMVER"));
    receiver.wait(300ms);
    EXPECT_THAT(receiver.lines("$P"), IsEmpty()) << "wrong checksum, none, half a command";
}

TEST(Quectel, ChangesItsSpeedWithoutAWord) {
    DialogueReceiver receiver("quectel-lg290p");
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGUART,W,460800"), ElementsAre("PQTMCFGUART,OK")) << "the same";
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGUART,W,115200"), IsEmpty());
    EXPECT_EQ(receiver.receiver().baud(PortId::uart1), 115200u);
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGUART,W,1,2,230400,8,0,1,0"), SizeIs(testing::Le(1)));
    EXPECT_EQ(receiver.receiver().baud(PortId::uart2), 230400u);
}

TEST(Quectel, SendsSentencesOfItsOwn) {
    DialogueReceiver receiver("quectel-lg290p");
    for (const char* const name : {"PQTMEPE,1,2", "PQTMPVT,1,1", "PQTMVEL,1,1", "PQTMDOP,1,1", "PQTMEOE,1,1"})
        EXPECT_THAT(quectel_told(receiver, "PQTMCFGMSGRATE,W," + std::string(name)), Contains("PQTMCFGMSGRATE,OK"));
    receiver.forget();
    receiver.wait(1s);
    ASSERT_THAT(receiver.lines("$PQTMEPE,2,"), SizeIs(10));
    const auto pvt = receiver.lines("$PQTMPVT,1,");
    ASSERT_THAT(pvt, SizeIs(10));
    EXPECT_THAT(pvt[0], testing::MatchesRegex(
                            "\\$PQTMPVT,1,[0-9]{9},20240305,1200[0-9]{2}\\.[0-9]00,,3,32,18,47\\.39770000,8\\.54560000,"
                            "441\\.000,47\\.000,8\\.000,1\\.000,.*"));
    EXPECT_EQ(std::ranges::count(pvt[0], ','), 19);
    const auto vel = receiver.lines("$PQTMVEL,1,");
    ASSERT_FALSE(vel.empty());
    EXPECT_EQ(std::ranges::count(vel[0], ','), 11);
    receiver.epoch_.fix.type = FixType::none;
    receiver.wait(2s);
    EXPECT_THAT(receiver.lines("$PQTMPVT,1,").back(), testing::HasSubstr(",,0,00,,,,"));
}

TEST(Quectel, ChangesSomeThingsWithARestartAlone) {
    DialogueReceiver receiver("quectel-lg290p");
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGFIXRATE,W,1000"), ElementsAre("PQTMCFGFIXRATE,OK"));
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGFIXRATE,R"), ElementsAre("PQTMCFGFIXRATE,OK,1000"));
    EXPECT_EQ(receiver.receiver().settings().navigation_period, 100ms);
    quectel_told(receiver, "PQTMSRR");
    receiver.wait(17s);
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGFIXRATE,R"), ElementsAre("PQTMCFGFIXRATE,OK,100")) << "it was not saved";
    quectel_told(receiver, "PQTMCFGFIXRATE,W,1000");
    quectel_told(receiver, "PQTMCFGCNST,W,1,0,1,1,0,0");
    save_and_restart(receiver);
    EXPECT_EQ(receiver.receiver().settings().navigation_period, 1s);
    EXPECT_FALSE(receiver.receiver().settings().tracks(Constellation::glonass, Signal::g1));
    EXPECT_THAT(quectel_told(receiver, "PQTMRESTOREPAR"), ElementsAre("PQTMRESTOREPAR,OK"));
    quectel_told(receiver, "PQTMSRR");
    receiver.wait(17s);
    EXPECT_EQ(receiver.receiver().settings().navigation_period, 100ms);
}

TEST(Quectel, IsSilentForSomeTimeAfterARestart) {
    DialogueReceiver receiver("quectel-lg290p");
    receiver.wait(1s);
    quectel_told(receiver, "PQTMSRR");
    receiver.forget();
    receiver.wait(14s);
    EXPECT_THAT(receiver.lines(), IsEmpty());
    receiver.wait(3s);
    EXPECT_FALSE(receiver.lines("$GNGGA").empty());
}

TEST(Quectel, StopsAndStartsNavigation) {
    DialogueReceiver receiver("quectel-lg290p");
    EXPECT_THAT(quectel_told(receiver, "PQTMGNSSSTOP"), ElementsAre("PQTMGNSSSTOP,OK"));
    receiver.wait(500ms);
    receiver.forget();
    receiver.wait(1s);
    EXPECT_THAT(receiver.lines(), IsEmpty());
    EXPECT_THAT(quectel_told(receiver, "PQTMGNSSSTART"), ElementsAre("PQTMGNSSSTART,OK"));
}

TEST(Quectel, IsABaseThatSaysWhereItStands) {
    DialogueReceiver receiver("quectel-lg290p");
    quectel_told(receiver, "PQTMCFGRCVRMODE,W,2");
    quectel_told(receiver, "PQTMCFGSVIN,W,2,0,0,4277461.9536,642777.8766,-4672077.9955");
    quectel_told(receiver, "PQTMCFGFIXRATE,W,1000");
    save_and_restart(receiver);
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGSVIN,R"),
                ElementsAre("PQTMCFGSVIN,OK,2,0,0.0,4277461.9536,642777.8766,-4672077.9955,0.0"));
    receiver.forget();
    receiver.wait(2s);
    EXPECT_THAT(receiver.lines("$G"), IsEmpty()) << "no sentences of a base";
    EXPECT_THAT(quectel_rtcm_numbers(receiver), ElementsAre(1005, 1033, 1005, 1033)) << "nothing is measured here";
    const auto station = decode_station(*parse_rtcm3(receiver.frames(StreamKind::rtcm3)[0]));
    ASSERT_TRUE(station.has_value());
    EXPECT_EQ(station->position[2], -46720779955);
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGMSGRATE,W,PQTMSVINSTATUS,1,1"), ElementsAre("PQTMCFGMSGRATE,OK"));
}

TEST(Quectel, SurveysItsPlace) {
    DialogueReceiver receiver("quectel-lg290p");
    quectel_told(receiver, "PQTMCFGRCVRMODE,W,2");
    quectel_told(receiver, "PQTMCFGSVIN,W,1,5,0,0,0,0");
    quectel_told(receiver, "PQTMCFGFIXRATE,W,1000");
    save_and_restart(receiver);
    quectel_told(receiver, "PQTMCFGMSGRATE,W,PQTMSVINSTATUS,1,1");
    receiver.forget();
    receiver.wait(40s);
    const auto lines = receiver.lines("$PQTMSVINSTATUS,1,");
    ASSERT_FALSE(lines.empty());
    EXPECT_EQ(std::ranges::count(lines.back(), ','), 11);
    EXPECT_THAT(lines.back(), testing::HasSubstr(",2,,11,")) << "done";
    EXPECT_THAT(quectel_rtcm_numbers(receiver), Contains(1005));
}

TEST(Quectel, OfAnAirohaUnderstandsPairToo) {
    DialogueReceiver receiver("quectel-lc29h-da");
    receiver.wait(1s);
    EXPECT_THAT(quectel_told(receiver, "PQTMVERNO"), ElementsAre("PQTMVERNO,LC29HDANR11A03S_RSA,2024/03/19,13:55:31"));
    EXPECT_THAT(quectel_told(receiver, "PAIR062,3,0"), ElementsAre("PAIR001,062,0"));
    EXPECT_THAT(quectel_told(receiver, "PAIR432,1"), ElementsAre("PAIR001,432,0"));
    EXPECT_THAT(quectel_told(receiver, "PAIR434,7"), ElementsAre("PAIR001,434,3"));
    EXPECT_THAT(quectel_told(receiver, "PAIR999"), ElementsAre("PAIR001,999,3"));
    receiver.forget();
    receiver.wait(2s);
    EXPECT_THAT(receiver.lines("$GPGSV"), IsEmpty());
    EXPECT_THAT(receiver.lines("$GNGGA"), SizeIs(2));
}

TEST(Quectel, AnLc29hBsSendsCorrectionsAlone) {
    DialogueReceiver receiver("quectel-lc29h-bs");
    receiver.wait(3s);
    EXPECT_THAT(receiver.lines("$G"), IsEmpty());
    EXPECT_THAT(quectel_told(receiver, "PQTMCFGSVIN,W,2,0,0,4277461.9,642777.8,4672077.9"),
                ElementsAre("PQTMCFGSVIN,OK"));
    EXPECT_THAT(quectel_told(receiver, "PQTMSAVEPAR"), ElementsAre("PQTMSAVEPAR,OK"));
    quectel_told(receiver, "PQTMSRR");
    receiver.wait(4s);
    receiver.forget();
    receiver.wait(2s);
    EXPECT_THAT(quectel_rtcm_numbers(receiver), ElementsAre(1005, 1005));
    EXPECT_THAT(quectel_told(receiver, "PAIR434,0"), ElementsAre("PAIR001,434,0"));
    receiver.forget();
    receiver.wait(2s);
    EXPECT_THAT(quectel_rtcm_numbers(receiver), IsEmpty());
}

}  // namespace
}  // namespace skyloop::firmware
