// What a scenario asks of boards that cannot do it: where it stands, and why.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "run/emulator/assembly.hpp"
#include "support/run_parts.hpp"

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

RunMode checking() {
    RunMode mode;
    mode.virtual_time = mode.only_checked = true;
    mode.open_ports = false;
    mode.now = to_gps_time(2400, 0);
    return mode;
}

Result<Assembly> idle_assembly(const std::string& text) {
    return assemble(test::emulator_scenario(text), test::emulator_data(), checking());
}

// Those that stand at a place of the file.
std::vector<std::string> idle_warnings(const std::string& text) {
    const auto assembly = idle_assembly(text);
    EXPECT_TRUE(assembly) << assembly.error().message;
    std::vector<std::string> placed;
    if (!assembly) return placed;
    std::copy_if(assembly->warnings.begin(), assembly->warnings.end(), std::back_inserter(placed),
                 [](const std::string& warning) { return warning.starts_with("test.toml:"); });
    return placed;
}

TEST(IdleEntries, TenSettingsThatABoardCannotDoAreTenWarnings) {
    EXPECT_THAT(
        idle_warnings(R"([[receiver]]
board = "ublox-m8"
name = "front"
sentences = ["GGA", "THS"]
dual_frequency = true
constellations = ["gps", "navic"]
static_hold_mps = 5
base = "rear"
[[receiver]]
board = "nmea-generic"
name = "rear"
state_file = "/tmp/rear.state"
[[fault]]
kind = "refuses_keys"
receiver = "rear"
keys = ["CFG-RATE-MEAS"]
[[fault]]
kind = "withheld_messages"
receiver = "rear"
messages = ["GGA", "NAV-PVT"]
[[fault]]
kind = "never_answers"
receiver = "rear"
[[command]]
kind = "forget_configuration"
receiver = "rear"
at_s = 1
)"),
        ElementsAre(StartsWith("test.toml:4:13: receiver.sentences: ublox-m8 never sends THS"),
                    StartsWith("test.toml:6:18: receiver.constellations: ublox-m8 does not receive navic"),
                    StartsWith("test.toml:5:18: receiver.dual_frequency: ublox-m8 receives one band"),
                    StartsWith("test.toml:7:19: receiver.static_hold_mps: ublox-m8 holds a position below 2.55"),
                    StartsWith("test.toml:8:8: receiver.base: ublox-m8 has no message with the vector"),
                    StartsWith("test.toml:12:14: receiver.state_file: nmea-generic takes no commands"),
                    StartsWith("test.toml:13:1: [[fault]] 'refuses_keys' will show nothing: nmea-generic takes "
                               "no CFG-VALSET"),
                    StartsWith("test.toml:17:1: [[fault]] 'withheld_messages': messages 'NAV-PVT' shows nothing: "
                               "nmea-generic never sends NAV-PVT with its epochs"),
                    StartsWith("test.toml:21:1: [[fault]] 'never_answers' will show nothing: nmea-generic takes "
                               "no commands"),
                    StartsWith("test.toml:24:1: [[command]] 'forget_configuration' will do nothing: "
                               "nmea-generic takes no commands")));
}

TEST(IdleEntries, WhatABoardDoesIsTakenInSilence) {
    EXPECT_THAT(idle_warnings(R"([[receiver]]
board = "ublox-f9p"
name = "front"
sentences = ["GGA", "VLW"]
dual_frequency = true
constellations = ["gps", "galileo"]
static_hold_mps = 2.5
baud = 115200
base = "rear"
config = { CFG-MSGOUT-UBX_NAV_PVT_UART1 = 1 }
[[receiver]]
name = "rear"
[[fault]]
kind = "refuses_keys"
receiver = "front"
keys = ["CFG-RATE-MEAS"]
[[fault]]
kind = "heading_lost"
receiver = "front"
[[fault]]
kind = "changed_baud"
[[expect]]
what = "receiver sends NAV-PVT"
receiver = "front"
[[expect]]
what = "rtk fixed"
receiver = "front"
)"),
                IsEmpty());
}

TEST(IdleEntries, ARateOfAMessageThatIsNeverSentIsAWarning) {
    EXPECT_THAT(idle_warnings("[[receiver]]\nboard = \"ublox-f10\"\n"
                              "config = { CFG-MSGOUT-UBX_RXM_RAWX_UART1 = 1, CFG-MSGOUT-UBX_NAV_PVT_UART1 = 1 }"),
                ElementsAre(StartsWith("test.toml:3:10: receiver.config: ublox-f10 has CFG-MSGOUT-UBX_RXM_RAWX_UART1 "
                                       "and never sends RXM-RAWX")));
}

TEST(IdleEntries, TwoSignalsAreCombinedWhereTwoAreTracked) {
    const std::string combined = "[model.modern.solution]\nionosphere_free = true\n[[receiver]]\nboard = ";
    EXPECT_THAT(idle_warnings(combined + "\"ublox-m9\""),
                ElementsAre(StartsWith("test.toml:2:19: model.modern.solution.ionosphere_free: no receiver tracks a "
                                       "second signal")));
    EXPECT_THAT(idle_warnings(combined + "\"ublox-f9p\""), IsEmpty());
}

TEST(IdleEntries, SpeedsOfAPortThatLeadsNowhereAreWarnings) {
    EXPECT_THAT(idle_warnings("[[receiver]]\nport = \"usb=pty\"\nbaud = 38400\n[[fault]]\nkind = \"changed_baud\"\n"
                              "[[fault]]\nkind = \"speed_mismatch\"\n[[command]]\nkind = \"set_baud\"\nbaud = 9600\n"
                              "at_s = 1"),
                ElementsAre(StartsWith("test.toml:3:8: receiver.baud: ublox-m8 has nothing at its UART1"),
                            StartsWith("test.toml:4:1: [[fault]] 'changed_baud' will show nothing"),
                            StartsWith("test.toml:6:1: [[fault]] 'speed_mismatch' will show nothing"),
                            StartsWith("test.toml:8:1: [[command]] 'set_baud' will do nothing")));
}

TEST(IdleEntries, AFaultIsIdleOnlyWhereNoReceiverOfItShowsIt) {
    const std::string two =
        "[[receiver]]\nname = \"a\"\nboard = \"nmea-generic\"\n[[receiver]]\nname = \"b\"\n"
        "board = \"ublox-m9\"\n";
    EXPECT_THAT(idle_warnings(two + "[[fault]]\nkind = \"no_version\""), IsEmpty());
    EXPECT_THAT(idle_warnings(two + "[[fault]]\nkind = \"withheld_messages\"\nmessages = [\"GGA\", \"NAV-PVT\"]"),
                IsEmpty());
    EXPECT_THAT(idle_warnings(two + "[[fault]]\nkind = \"no_version\"\nreceiver = \"a\""),
                ElementsAre(HasSubstr("nmea-generic does not answer MON-VER")));
}

TEST(IdleEntries, PartsOfAFaultAreWarnings) {
    const std::string generic = "[[receiver]]\nboard = \"nmea-generic\"\n";
    EXPECT_THAT(idle_warnings(generic + "[[fault]]\nkind = \"outage\"\nconstellations = [\"gps\", \"galileo\"]"),
                ElementsAre(HasSubstr("'outage': constellations 'galileo' shows nothing: nmea-generic does not track "
                                      "galileo as the run starts")));
    EXPECT_THAT(idle_warnings(generic + "[[fault]]\nkind = \"outage\"\nsignals = [\"L1\", \"L5\"]"),
                ElementsAre(HasSubstr("signals 'L5' shows nothing")));
    EXPECT_THAT(idle_warnings(generic + "[[fault]]\nkind = \"spoof_satellite\"\nstep_m = 50\ndetected_after_s = 3"),
                ElementsAre(HasSubstr("detected_after_s shows nothing: nmea-generic has no message that reports")));
    EXPECT_THAT(idle_warnings(generic + "[[fault]]\nkind = \"reboots\"\nbanner = false"),
                ElementsAre(HasSubstr("banner shows nothing: nmea-generic sends no texts when it starts")));
    EXPECT_THAT(idle_warnings(generic + "[[fault]]\nkind = \"reboots\""), IsEmpty());
    EXPECT_THAT(idle_warnings(generic + "[[fault]]\nkind = \"byte_loss\"\ndirection = \"to_receiver\""),
                ElementsAre(HasSubstr("'byte_loss' will show nothing: nmea-generic takes no commands")));
    EXPECT_THAT(idle_warnings(generic + "[[fault]]\nkind = \"byte_loss\"\ndirection = \"both\""), IsEmpty());
}

TEST(IdleEntries, MessagesOfAFaultAreJudgedByWhatTheBoardDoesWithThem) {
    const auto told = [](const std::string& board, const std::string& fault) {
        const auto warnings = idle_warnings("[[receiver]]\nboard = \"" + board + "\"\n[[fault]]\nkind = " + fault);
        return warnings.empty() ? std::string() : warnings.front().substr(warnings.front().find("[[fault]]"));
    };
    EXPECT_EQ(told("ublox-m9", "\"answers_selectively\"\nmessages = [\"MON-VER\", \"CFG-RATE\"]"), "");
    EXPECT_THAT(told("ublox-m9", "\"answers_selectively\"\nmessages = [\"CFG-RST\"]"),
                HasSubstr("never answers CFG-RST"));
    EXPECT_THAT(told("ublox-m9", "\"answers_selectively\"\nmessages = [\"PUBX,41\"]"),
                HasSubstr("never answers PUBX,41"));
    EXPECT_THAT(told("mtk3339", "\"answers_selectively\"\nmessages = [\"MON-VER\"]"),
                HasSubstr("is no u-blox receiver"));
    EXPECT_THAT(told("ublox-m8", "\"refuses_messages\"\nmessages = [\"CFG-VALSET\"]"),
                HasSubstr("ublox-m8 refuses CFG-VALSET anyway"));
    EXPECT_EQ(told("ublox-m8", "\"refuses_messages\"\nmessages = [\"CFG-GNSS\"]"), "");
    EXPECT_THAT(told("ublox-m9", "\"refuses_keys\"\nkeys = [\"CFG-SPARTN-USE_SOURCE\"]"),
                HasSubstr("ublox-m9 has no CFG-SPARTN-USE_SOURCE and refuses it anyway"));
    EXPECT_THAT(told("ublox-m9", "\"withheld_messages\"\nmessages = [\"MON-VER\"]"), HasSubstr("never sends MON-VER"));
}

TEST(IdleEntries, ExpectationsThatABoardCannotFulfilAreWarnings) {
    const auto told = [](const std::string& board, const std::string& what, const std::string& rest = "") {
        const auto warnings =
            idle_warnings("[[expect]]\nwhat = \"" + what + "\"\n[[receiver]]\nboard = \"" + board + "\"\n" + rest);
        return warnings.empty() ? std::string() : warnings.front();
    };
    EXPECT_EQ(told("ublox-f9p", "receiver sends THS"),
              "test.toml:1:1: [[expect]] 'receiver sends THS' cannot be met: ublox-f9p never sends THS");
    EXPECT_THAT(told("nmea-generic", "receiver sends NAV-PVT never"), HasSubstr("shows nothing"));
    EXPECT_THAT(told("ublox-m9", "receiver sends UBX-0A-04"), HasSubstr("never sends UBX-0A-04"))
        << "a dialogue calls it MON-VER";
    for (const char* sent :
         {"receiver sends NAV-PVT", "receiver sends ACK-ACK", "receiver sends MON-VER", "receiver sends GGA",
          "receiver sends NAV-*", "receiver sends anything", "receiver sends TXT", "receiver sends \\\"PUBX,00\\\"",
          "jamming flagged", "spoofing flagged", "dead reckoning"})
        EXPECT_EQ(told("ublox-m9", sent), "") << sent;
    EXPECT_EQ(told("septentrio-sbf", "receiver sends SBF"), "");
    EXPECT_EQ(told("septentrio-sbf", "rtk fixed"), "");
    EXPECT_EQ(told("mtk3339", "receiver sends PMTK001"), "");
    EXPECT_THAT(told("mtk3339", "receiver sends TXT"), HasSubstr("never sends TXT"));
    EXPECT_THAT(told("ublox-m9", "rtk fixed"), HasSubstr("has no RTK"));
    EXPECT_EQ(told("ublox-m9", "rtk float", "[[fault]]\nkind = \"rtk_transition\""), "") << "the fault claims it";
    EXPECT_THAT(told("ublox-m8", "dgnss fix"), HasSubstr("takes no corrections"));
    EXPECT_THAT(told("mtk3339", "dead reckoning"), HasSubstr("never reports dead reckoning"));
    EXPECT_THAT(told("ublox-m8", "time only"), HasSubstr("has no CFG-TMODE"));
    EXPECT_THAT(told("nmea-generic", "jamming flagged"), HasSubstr("no message that reports jamming"));
    EXPECT_THAT(told("ublox-6", "spoofing flagged"), HasSubstr("no message that reports spoofing"));
    EXPECT_THAT(told("ublox-f10", "C/N0 of R05 below 30 dBHz"), HasSubstr("does not receive glonass"));
}

const std::string judged = "[[expect]]\nwhat = \"fix\"\n[[receiver]]\nboard = \"nmea-generic\"\n";

TEST(IdleEntries, AnIdleFaultIsRefusedInAJudgedRun) {
    const auto refused =
        idle_assembly(judged + "[[fault]]\nkind = \"no_version\"\n[[fault]]\nkind = \"receiver_deaf\"");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::input);
    EXPECT_EQ(
        refused.error().message,
        "test.toml:5:1: [[fault]] 'no_version' will show nothing: nmea-generic does not answer MON-VER, and the run "
        "is judged; expected another fault, or allow_idle = true\n"
        "test.toml:7:1: [[fault]] 'receiver_deaf' will show nothing: nmea-generic takes no commands, and the run is "
        "judged; expected another fault, or allow_idle = true");
    EXPECT_TRUE(idle_assembly(judged + "[[fault]]\nkind = \"outage\"")) << "it acts";
}

TEST(IdleEntries, AnIdleFaultThatIsAllowedIsAWarning) {
    EXPECT_THAT(idle_warnings(judged + "[[fault]]\nkind = \"no_version\"\nallow_idle = true"),
                ElementsAre(StartsWith("test.toml:5:1: [[fault]] 'no_version' will show nothing")));
    EXPECT_FALSE(idle_assembly(judged + "[[fault]]\nkind = \"no_version\"\nallow_idle = false"));
}

TEST(IdleEntries, AClockThatOnlyARunHasIsNoReasonToRefuseAScenarioThatIsChecked) {
    const std::string drifting = judged + "[[fault]]\nkind = \"clock_drift\"";
    EXPECT_THAT(idle_warnings(drifting), ElementsAre(HasSubstr("in virtual time nothing does")));
    RunMode simulated = checking();
    simulated.only_checked = false;
    EXPECT_FALSE(assemble(test::emulator_scenario(drifting), test::emulator_data(), simulated));
}

}  // namespace
}  // namespace skyloop
