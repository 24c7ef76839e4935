// A UC6580 as its clients meet it, and the sleep of an AG3335's command processor.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dialogue_receiver.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

// What comes within 100 ms of a line.
std::vector<std::string> after_line(DialogueReceiver& receiver, const std::string& line,
                                    const std::string& begin = "$") {
    receiver.forget();
    receiver.write(to_bytes(line + "\r\n"));
    receiver.wait(100ms);
    return receiver.lines(begin);
}

struct Uc6580 : DialogueReceiver {
    Uc6580() : DialogueReceiver("unicore-uc6580") { wait(50ms); }
};

TEST(Uc6580, AnswersWithAndWithoutAChecksum) {
    Uc6580 receiver;
    const std::string told = "$PDTINFO,UC6580I-00,G1B1L1E1,V00,R6.1.1.1Build9074,2400615000514,20250427080308004*4D";
    EXPECT_THAT(after_line(receiver, "$PDTINFO"), Contains(told));
    EXPECT_THAT(after_line(receiver, "$PDTINFO*4E"), Contains(told));
    EXPECT_THAT(after_line(receiver, "$pdtinfo"), Contains(told));
    EXPECT_THAT(after_line(receiver, "garbage\xFF$PDTINFO"), Contains(told));
    EXPECT_THAT(after_line(receiver, "$PDTINFO*00"), Contains("$FAIL,1*1F"));
    EXPECT_THAT(after_line(receiver, "$CFGSYS"), Contains("$CFGSYS,H55155*4E"));
}

TEST(Uc6580, RefusesWrongParametersAndLeavesOthersCommandsAlone) {
    Uc6580 receiver;
    for (const char* const wrong :
         {"$CFGSYS,35155", "$CFGSYS,hXYZ", "$CFGMSG,0,3", "$CFGMSG,0,99,1", "$CFGMSG,7,0,0", "$CFGMSG,0,3,x"})
        EXPECT_THAT(after_line(receiver, wrong), Contains("$FAIL,0*1E")) << wrong;
    for (const char* const other : {"$PCAS06,1*1A", "$PAIR021*39", "$CFGPRT", "PDTINFO", ""})
        EXPECT_THAT(after_line(receiver, other, "$F"), IsEmpty()) << other;
    EXPECT_THAT(after_line(receiver, "$CFGMSG," + std::string(4000, '1')), Not(Contains("$OK*04")));
    EXPECT_THAT(after_line(receiver, "$CFGSYS"), Contains("$CFGSYS,H55155*4E"));
}

TEST(Uc6580, SetsRatesAndSystems) {
    Uc6580 receiver;
    EXPECT_THAT(after_line(receiver, "$CFGMSG,0,3,0"), Contains("$OK*04"));
    EXPECT_THAT(after_line(receiver, "$CFGMSG,0,2,0,1*18"), Contains("$OK*04"));
    EXPECT_THAT(after_line(receiver, "$CFGMSG,6,0,0"), Contains("$OK*04"));
    receiver.wait(1s);
    receiver.forget();
    receiver.wait(2s);
    EXPECT_THAT(receiver.lines("$GPGSV"), IsEmpty());
    EXPECT_THAT(receiver.lines("$GNGSA"), IsEmpty());
    EXPECT_THAT(receiver.lines("$GNGGA"), SizeIs(2));
    EXPECT_THAT(after_line(receiver, "$CFGSYS,h35155"), Contains("$OK*04"));
    receiver.wait(1500ms);
    EXPECT_THAT(after_line(receiver, "$CFGSYS"), Contains(StartsWith("$CFGSYS,H35155*"))) << "after the restart";
}

TEST(Ag3335, HearsNothingButItsLockForSecondsAfterAStart) {
    const BoardProfile board = test::board_named("airoha-ag3335");
    DialogueReceiver receiver(board, {.power_up = true});
    receiver.wait(1500ms);
    EXPECT_FALSE(receiver.lines("$GN").empty()) << "sentences flow";
    EXPECT_THAT(receiver.answers("PAIR021", "$PAIR"), IsEmpty());
    EXPECT_THAT(receiver.answers("PAIR382,1", "$PAIR"), testing::ElementsAre("$PAIR001,382,0*32"));
    EXPECT_THAT(receiver.answers("PAIR021", "$PAIR021,AG3335"), SizeIs(1));
    DialogueReceiver patient(board, {.power_up = true});
    patient.wait(6s);
    EXPECT_THAT(patient.answers("PAIR021", "$PAIR021,AG3335"), SizeIs(1)) << "it wakes by itself";
    DialogueReceiver running(board);
    EXPECT_THAT(running.answers("PAIR021", "$PAIR021,AG3335"), SizeIs(1)) << "it has been on for long";
}

}  // namespace
}  // namespace skyloop::firmware
