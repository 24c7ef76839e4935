// The command line of a Septentrio receiver, and what its streams send.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "firmware/core/base_station.hpp"
#include "firmware/core/command_line_reader.hpp"
#include "firmware/core/receiver.hpp"
#include "firmware/septentrio/console.hpp"
#include "firmware/septentrio/sbf_messages.hpp"
#include "firmware/septentrio/settings.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/sbf_blocks.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "sample_epochs.hpp"
#include "septentrio_receiver.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class Console : public testing::Test {
protected:
    std::string say(const std::string& line, PortId from = PortId::uart1) {
        outcome_ = console_.execute(line, target_, from);
        return outcome_.answers.empty() ? "" : to_string(outcome_.answers.front());
    }
    BoardProfile board_ = septentrio_board();
    const SeptentrioTarget start_ = SeptentrioTarget::at_start(board_, {});
    SeptentrioTarget target_ = start_;
    SeptentrioConsole console_{board_, start_};
    CommandOutcome outcome_;
};

TEST(CommandLineReader, CutsLinesAtAnyEndAndLeavesCorrectionsOut) {
    CommandLineReader reader;
    EXPECT_TRUE(reader.feed(to_bytes("gec")).empty());
    EXPECT_THAT(reader.feed(to_bytes("m\r\n\nsso\r")), ElementsAre("gecm", "", "sso"));
    // The body of a frame may look like anything.
    Bytes frame{0xD3, 0x00, 0x04, 'a', '\n', 'b', '\n', 1, 2, 3};
    const Bytes behind = to_bytes("grc\n");
    frame.insert(frame.end(), behind.begin(), behind.end());
    EXPECT_THAT(reader.feed(frame), ElementsAre("grc"));
    EXPECT_THAT(reader.feed(Bytes{'x', 0x80, 'g', 'c', 's', '\n'}), ElementsAre("gcs")) << "behind noise";
}

TEST_F(Console, RepeatsACommandToTheLetterAndTellsWhatIsSet) {
    EXPECT_EQ(say("sso, stream2, com1, dop+PVTGeodetic, MSEC200 "),
              "$R: sso, stream2, com1, dop+PVTGeodetic, MSEC200 \r\n"
              "  SBFOutput, Stream2, COM1, DOP+PVTGeodetic, msec200\r\nCOM1>");
    EXPECT_EQ(say("getSBFOutput, Stream2", PortId::usb),
              "$R: getSBFOutput, Stream2\r\n  SBFOutput, Stream2, COM1, DOP+PVTGeodetic, msec200\r\nUSB1>");
    EXPECT_THAT(say("setElevationMask, all, 12"),
                HasSubstr("  ElevationMask, Tracking, 12\r\n  ElevationMask, PVT, 12\r\n"));
    EXPECT_DOUBLE_EQ(target_.config.elevation_mask.deg(), 12);
}

TEST_F(Console, AddsToListsAndTakesAway) {
    say("sso,Stream3,COM1,DOP,sec1");
    EXPECT_THAT(say("sso,Stream3,,+PVTGeodetic+EndOfPVT"), HasSubstr("COM1, DOP+PVTGeodetic+EndOfPVT, sec1"));
    EXPECT_THAT(say("sso,Stream3,,-DOP"), HasSubstr("COM1, PVTGeodetic+EndOfPVT, sec1"));
    EXPECT_THAT(say("sso,Stream3,,none"), HasSubstr("COM1, none, sec1"));
    EXPECT_THAT(say("sst, -GALILEO"), HasSubstr("  SatelliteTracking, GPS\r\n"));
    EXPECT_THAT(say("sst,+SBAS"), HasSubstr("  SatelliteTracking, GPS+SBAS\r\n"));
}

TEST_F(Console, RefusesWhatItDoesNotHaveAndChangesNothing) {
    EXPECT_EQ(say("sso,Stream1,COM1,DOP,msec7"), "$R? SBFOutput: Argument 'Interval' is invalid!\r\nCOM1>");
    EXPECT_EQ(say("sso,Stream11,COM1,DOP,sec1"), "$R? SBFOutput: Argument 'Index' is invalid!\r\nCOM1>");
    EXPECT_EQ(say("sso,Stream1,COM1,Dope,sec1"), "$R? SBFOutput: Argument 'Messages' is invalid!\r\nCOM1>");
    EXPECT_EQ(say("scs,COM1,baud12345"), "$R? COMSettings: Argument 'Rate' is invalid!\r\nCOM1>");
    EXPECT_EQ(say("sem,PVT,95"), "$R? ElevationMask: Argument 'Mask' is invalid!\r\nCOM1>");
    EXPECT_EQ(say("srd,a,b,c"), "$R? ReceiverDynamics: Argument 'c' is invalid!\r\nCOM1>");
    EXPECT_EQ(say("make coffee"), "$R? ASCII commands: Invalid command!\r\nCOM1>");
    EXPECT_THAT(say("gso,Stream1"), HasSubstr("none, none, off"));
}

TEST_F(Console, RefusesWordsThatThereAreNot) {
    const std::pair<const char*, const char*> wrong[] = {
        {"sst, GPS+GALLILEO", "SatelliteTracking: Argument 'Satellite'"},
        {"ssu, FOO", "SatelliteUsage: Argument 'Satellite'"},
        {"sst, G33", "SatelliteTracking: Argument 'Satellite'"},
        {"sdio, COM1, , FOO", "DataInOut: Argument 'Output'"},
        {"sdio, COM1, nonsense", "DataInOut: Argument 'Input'"},
        {"scs, COM1, baud115200, bits9", "COMSettings: Argument 'DataBits'"},
        {"scs, COM1, baud115200, bits8, Maybe", "COMSettings: Argument 'Parity'"},
        {"scs, COM1, baud115200, bits8, No, bit7", "COMSettings: Argument 'StopBits'"},
        {"scs, COM1, baud115200, bits8, No, bit1, flow", "COMSettings: Argument 'FlowControl'"},
        {"sao, Main, abc, 0, 0", "AntennaOffset: Argument 'DeltaE'"},
        {"sao, Main, 0, 0, 1000.1", "AntennaOffset: Argument 'DeltaU'"},
        {"snti, XX", "NMEATalkerID: Argument 'TalkerID'"},
        {"shm, Tracking, maybe", "HealthMask: Argument 'Mask'"},
        {"spps, furlong1", "PPSParameters: Argument 'Interval'"},
        {"erst, Bogus, none", "exeResetReceiver: Argument 'Level'"},
        {"erst, Soft, none+everything", "exeResetReceiver: Argument 'EraseMemory'"},
        {"exeResetReceiver", "exeResetReceiver: Argument 'Level'"},
        {"eccf, Foo, Boot", "exeCopyConfigFile: Argument 'Source'"},
        {"eccf, Current, RxDefault", "exeCopyConfigFile: Argument 'Target'"},
        {"emd, DSK9, Mount", "exeManageDisk: Argument 'Disk'"},
        {"emd, DSK1, Explode", "exeManageDisk: Argument 'Action'"},
        {"emd, DSK1, Unmount, now", "exeManageDisk: Argument 'now'"}};
    for (const auto& [line, why] : wrong) {
        EXPECT_EQ(say(line), std::string("$R? ") + why + " is invalid!\r\nCOM1>") << line;
        EXPECT_FALSE(outcome_.reset) << line;
    }
    EXPECT_THAT(say("gst"), HasSubstr("  SatelliteTracking, GPS+GALILEO\r\n"));
    EXPECT_TRUE(console_.state().disk_mounted);
}

TEST_F(Console, TakesWhatDriversSay) {
    for (const char* line : {"sst, All",
                             "sst, -s120+G05",
                             "ssu, GPS+GLONASS+GALILEO+SBAS+BEIDOU",
                             "sdio,COM1,Auto,SBF",
                             "sdio, USB1, RTCMv3, +NMEA",
                             "sdio, NTR1, auto, none",
                             "sdio,all,CMD,none",
                             "sdio, COM1, auto, SBF+NMEA",
                             "scs,COM1,baud230400,bits8,No,bit1,none",
                             "scs, COM1, baud115200, bits8, No, bit1, off",
                             "scs, COM1, baud115200, bits8, No, bit1, RTS|CTS",
                             "sao, Main, 0, 0, 0, \"Unknown\", Unknown",
                             "spps, sec1, Low2High, 0.00, GPS, 60, 5.000000",
                             "spps, msec10, , , UTC",
                             "shm, all, off",
                             "emd, DSK1, Unmount",
                             "emd,DSK1,Mount",
                             "eccf,RxDefault,Boot",
                             "eccf, RxDefault, Current",
                             "erst,soft,config",
                             "erst, Hard"}) {
        say("SSSSSSSSSS");
        EXPECT_THAT(say(line), StartsWith("$R: ")) << line;
    }
    EXPECT_THAT(say("gao, Main"),
                HasSubstr("  AntennaOffset, Main, 0.0000, 0.0000, 0.0000, \"Unknown\", Unknown, 0\r\n"));
}

TEST_F(Console, KeepsPlacesOfReferenceStations) {
    EXPECT_EQ(say("setStaticPosGeodetic, Geodetic1, 47.000000, 8.000000, 400.000000"),
              "$R: setStaticPosGeodetic, Geodetic1, 47.000000, 8.000000, 400.000000\r\n"
              "  StaticPosGeodetic, Geodetic1, 47.000000000, 8.000000000, 400.0000, WGS84\r\nCOM1>");
    EXPECT_THAT(say("sspg, Geodetic2, -0.000000, -180, -1000, etrs89"),
                HasSubstr("Geodetic2, 0.000000000, -180.000000000, -1000.0000, ETRS89\r\n"));
    EXPECT_THAT(say("gspg, Geodetic1"), HasSubstr("  StaticPosGeodetic, Geodetic1, 47.000000000, 8.000000000"));
    EXPECT_THAT(say("sspc, Cartesian1, 4019952.028, 331452.954, 4924307.458"),
                HasSubstr("  StaticPosCartesian, Cartesian1, 4019952.0280, 331452.9540, 4924307.4580, WGS84\r\n"));
    EXPECT_THAT(say("getStaticPosCartesian"), HasSubstr("Cartesian5, 0.0000, 0.0000, 0.0000, WGS84\r\n"));
    EXPECT_EQ(say("sspg, Geodetic1, 90.1"), "$R? StaticPosGeodetic: Argument 'Latitude' is invalid!\r\nCOM1>");
    EXPECT_EQ(say("sspg, Geodetic1, 9, east"), "$R? StaticPosGeodetic: Argument 'Longitude' is invalid!\r\nCOM1>");
    EXPECT_EQ(say("sspg, Geodetic1, 9, 9, nan"), "$R? StaticPosGeodetic: Argument 'Altitude' is invalid!\r\nCOM1>");
    EXPECT_EQ(say("sspg, Geodetic1, , , , Moon"), "$R? StaticPosGeodetic: Argument 'Datum' is invalid!\r\nCOM1>");
    EXPECT_EQ(say("sspc, Cartesian1, 8000001"), "$R? StaticPosCartesian: Argument 'X' is invalid!\r\nCOM1>");
    EXPECT_EQ(say("sspc, Geodetic1, 1"), "$R? StaticPosCartesian: Argument 'Index' is invalid!\r\nCOM1>");
    EXPECT_EQ(say("spm, Static, , Geodetic6"), "$R? PVTMode: Argument 'StaticPosition' is invalid!\r\nCOM1>");
}

TEST_F(Console, StandsWhereItWasTold) {
    const auto place = [&] { return target_.config.place.value_or(BasePlace{}).position.vector(); };
    say("spm, Static, , Geodetic1");
    EXPECT_FALSE(target_.config.place) << "a position that was not set is none";
    say("sspg, Geodetic1, 47, 8, 400");
    EXPECT_LT((place() - to_ecef(Geodetic::degrees(47, 8, 400)).vector()).norm(), 1e-4);
    say("sspc, Cartesian3, -4019952.0287, 331452.9541, 4924307.458");
    say("setPVTMode, Static, All, cartesian3");
    EXPECT_LT((place() - Eigen::Vector3d(-4019952.0287, 331452.9541, 4924307.458)).norm(), 1e-4);
    say("spm, , , auto");
    EXPECT_FALSE(target_.config.place);
    say("spm, Static, , Cartesian3");
    say("spm, Rover");
    EXPECT_FALSE(target_.config.place);
}

TEST_F(Console, IsToldOfTheMessagesOfAReferenceStation) {
    EXPECT_THAT(
        say("sr3o, COM1, RTCM1005+msm4"),
        HasSubstr("  RTCMv3Output, COM1, RTCM1005+RTCM1074+RTCM1084+RTCM1094+RTCM1104+RTCM1114+RTCM1124+RTCM1134"
                  "\r\n"));
    EXPECT_THAT(say("sr3o, COM1, -MSM4+RTCM1230"), HasSubstr("  RTCMv3Output, COM1, RTCM1005+RTCM1230\r\n"));
    EXPECT_THAT(say("setRTCMv3Output, COM1+COM3+USB1, none"),
                HasSubstr("  RTCMv3Output, COM1, none\r\n  RTCMv3Output, USB1, none\r\n"));
    EXPECT_EQ(say("sr3o, COM1, RTCM999"), "$R? RTCMv3Output: Argument 'Messages' is invalid!\r\nCOM1>");
    EXPECT_THAT(say("sr3i, RTCM1005|6+MSM7, 0.5"),
                HasSubstr("  RTCMv3Interval, RTCM1005|6, 0.5\r\n  RTCMv3Interval, MSM7, 0.5\r\n"));
    EXPECT_THAT(say("gr3i, MSM4"), HasSubstr("  RTCMv3Interval, MSM4, 1\r\n"));
    EXPECT_EQ(say("sr3i, MSM4, 601"), "$R? RTCMv3Interval: Argument 'Interval' is invalid!\r\nCOM1>");
    EXPECT_THAT(say("setRTCMv3Formatting, 123"), HasSubstr("  RTCMv3Formatting, 123, all\r\n"));
    EXPECT_EQ(say("sr3f, 4096"), "$R? RTCMv3Formatting: Argument 'ReferenceID' is invalid!\r\nCOM1>");
    EXPECT_EQ(say("sr3f, 1.5"), "$R? RTCMv3Formatting: Argument 'ReferenceID' is invalid!\r\nCOM1>");
    EXPECT_THAT(say("gdio, COM1"), HasSubstr("  DataInOut, COM1, auto, SBF+NMEA, (on)\r\n"));
}

TEST_F(Console, KeepsWhereItGetsTheTimeFrom) {
    EXPECT_THAT(say("snc, on, pool.ntp.org"), HasSubstr("  NtpClient, on, pool.ntp.org\r\n"));
    EXPECT_THAT(say("getNtpClient"), HasSubstr("  NtpClient, on, pool.ntp.org\r\n"));
    EXPECT_EQ(say("snc, perhaps"), "$R? NtpClient: Argument 'Mode' is invalid!\r\nCOM1>");
}

TEST_F(Console, PromptsWhoAsksForIt) {
    EXPECT_EQ(say(""), "COM1>");
    EXPECT_EQ(say("# nothing"), "COM1>");
    EXPECT_EQ(say("SSSSSSSSSS"), "COM1>");
    EXPECT_TRUE(target_.config.port(PortId::uart1).in.rtcm3);
    say("sdio,COM1,none");
    EXPECT_FALSE(target_.config.port(PortId::uart1).in.rtcm3);
    EXPECT_TRUE(target_.config.port(PortId::usb).in.rtcm3);
    EXPECT_EQ(say("gecm"), "");
    EXPECT_THAT(say("gecm", PortId::usb), StartsWith("$R: gecm\r\n"));
    EXPECT_EQ(say("SSSSSSSSSS"), "COM1>");
    EXPECT_THAT(say("gecm"), StartsWith("$R: gecm\r\n"));
}

TEST_F(Console, SolvesAsOftenAsItsStreamsNeed) {
    const auto period = [&] { return target_.config.settings.navigation_period / 1ms; };
    const std::int64_t own = period();
    say("sso,Stream1,COM1,DOP,msec100");
    EXPECT_EQ(period(), 100);
    say("sno,Stream1,COM1,GGA,msec50");
    EXPECT_EQ(period(), 50);
    say("sso,all,none,none,off");
    EXPECT_EQ(period(), 50);
    say("sno,all,none,none,off");
    EXPECT_EQ(period(), own);
    say("sso,Stream1,COM1,DOP,sec10");
    EXPECT_EQ(period(), 1000) << "a solution each second at least";
    say("sso,Stream1,COM1,DOP,msec20");
    EXPECT_EQ(period(), 20);
    EXPECT_THAT(say("sso,Stream1,COM1,DOP,msec10"), StartsWith("$R: ")) << "ROS asks for it";
}

TEST_F(Console, SaysWhatIsTrackedAndHowItMoves) {
    using enum Constellation;
    const auto measures_l2c = [&] { return target_.config.settings.signals.contains({gps, Signal::l2}); };
    EXPECT_FALSE(measures_l2c());
    say("snt,+GPSL2C");
    EXPECT_TRUE(measures_l2c());
    say("snt,-GPSL1CA-GPSL2C");
    EXPECT_FALSE(target_.config.has_on(gps)) << "a system without a signal";
    say("snt,+GPSL1CA");
    EXPECT_TRUE(target_.config.has_on(gps));
    EXPECT_FALSE(measures_l2c());
    say("sst,+QZSS");
    say("ssu,+QZSS");
    EXPECT_TRUE(target_.config.has_on(qzss)) << "its signal is among those of the factory";
    EXPECT_EQ(say("snt,GPSL7"), "$R? SignalTracking: Argument 'Signal' is invalid!\r\nCOM1>");
    const int own = target_.config.limits.dynamic_model;
    say("gso");
    EXPECT_EQ(target_.config.limits.dynamic_model, own) << "until it is told";
    say("srd,Moderate,UAV");
    EXPECT_EQ(target_.config.limits.dynamic_model, 8);
    say("sem,PVT,10");
    say("sem,Tracking,15");
    EXPECT_DOUBLE_EQ(target_.config.elevation_mask.deg(), 15) << "what is not tracked is not used";
    say("snti, GP");
    EXPECT_EQ(target_.config.nmea.talker, "GP");
}

TEST_F(Console, StartsAgainAsSaved) {
    say("sem,PVT,20");
    say("sso,Stream1,COM1,DOP,sec1");
    EXPECT_THAT(say("eccf, Current, Boot"),
                StartsWith("$R: eccf, Current, Boot\r\n  CopyConfigFile, Current, Boot\r\n"));
    say("sem,PVT,30");
    EXPECT_EQ(say("erst,soft,none"), "$R: erst,soft,none\r\n  ResetReceiver, soft, none\r\nSTOP>");
    EXPECT_EQ(outcome_.reset->forgotten.kind(), StartKind::hot);
    console_.restart(target_);
    EXPECT_DOUBLE_EQ(target_.config.elevation_mask.deg(), 20);
    EXPECT_THAT(say("gso,Stream1"), HasSubstr("COM1, DOP, sec1"));
    say("erst,soft,PVTData");
    EXPECT_EQ(outcome_.reset->forgotten.kind(), StartKind::warm);
    say("exeResetReceiver, hard, SatData+PVTData");
    EXPECT_EQ(outcome_.reset->forgotten.kind(), StartKind::cold);
}

TEST_F(Console, OutlivesTheProcessAsSaved) {
    say("sem,PVT,20");
    say("sso,Stream1,COM1,DOP,sec1");
    EXPECT_EQ(console_.boot_text(), "") << "nothing is saved yet";
    say("eccf, Current, Boot");
    SeptentrioConsole next(board_, start_);
    SeptentrioTarget target = start_;
    ASSERT_TRUE(next.load(console_.boot_text(), "state", target)) << console_.boot_text();
    EXPECT_EQ(next.boot_text(), console_.boot_text());
    EXPECT_DOUBLE_EQ(target.config.elevation_mask.deg(), 20);
    EXPECT_EQ(target.config.settings.navigation_period, target_.config.settings.navigation_period);
    EXPECT_EQ(next.load("\nTea, 1\n", "state", target).error().message, "state:2: 'Tea' is no setting of sample");
    EXPECT_EQ(next.load("SBFOutput, Stream1, COM1, Tea, sec1\n", "state", target).error().message,
              "state:1: SBFOutput: Argument 'Messages' is invalid!");
    EXPECT_DOUBLE_EQ(target.config.elevation_mask.deg(), 20) << "nothing of it is taken";
}

TEST(SilentConsole, SendsNothingUntilItIsToldAndAfterItsFactorySettings) {
    const BoardProfile board = septentrio_board();
    SeptentrioTarget target = SeptentrioTarget::at_start(board, {});
    SeptentrioConsole console(board, target);
    const auto say = [&](const char* line) {
        return to_string(console.execute(line, target, PortId::uart1).answers.at(0));
    };
    EXPECT_THAT(say("gso,Stream1"), HasSubstr("  SBFOutput, Stream1, none, none, off\r\n"));
    say("sso,Stream1,COM1,DOP,sec1");
    say("eccf,Current,Boot");
    console.restart(target);
    EXPECT_THAT(say("gso,Stream1"), HasSubstr("COM1, DOP, sec1"));
    say("eccf,RxDefault,Boot");
    console.restart(target);
    EXPECT_THAT(say("gso,Stream1"), HasSubstr("  SBFOutput, Stream1, none, none, off\r\n"));
}

NavigationState solved_state() {
    NavigationState state;
    state.epoch.fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
    add_satellites(state.epoch.fix, Constellation::gps, 1, 8);
    state.fix_ok = true;
    state.time = {true, true, true, true, Seconds(1e-8)};
    return state;
}

TEST(SbfStatus, APairHasABaseLineAndACovariance) {
    NavigationState state = solved_state();
    EXPECT_TRUE(sbf_base_vector(state).bases.empty());
    EXPECT_EQ(sbf_attitude_covariance(state).error, 1);
    state.epoch.relative = RelativePosition{0, 2, -1, Metres(0.02)};
    const SbfBaseVectorGeod block = sbf_base_vector(state);
    ASSERT_EQ(block.bases.size(), 1U);
    EXPECT_EQ(block.bases[0].delta_east, -2) << "from the rover to the base";
    EXPECT_EQ(block.bases[0].delta_up, -1);
    EXPECT_EQ(block.bases[0].mode, 7);
    EXPECT_EQ(block.bases[0].azimuth, 27000) << "the base is in the west";
    EXPECT_EQ(block.bases[0].elevation, -2657);
    EXPECT_NEAR(sbf_attitude_covariance(state).heading, 0.3283, 1e-4) << "0.01 rad, in square degrees";
}

TEST(SbfStatus, CorrectionsHaveTheBaseLineOfTheirStation) {
    NavigationState state = solved_state();
    state.corrections.state = CorrectionState::rtk_fixed;
    state.corrections.base = to_ecef(Geodetic::degrees(47, 8, 400));
    state.corrections.station = 12;
    state.corrections.age = Seconds(0.8);
    state.epoch.fix.type = FixType::rtk_fixed;
    const SbfBaseVectorGeod block = sbf_base_vector(state);
    ASSERT_EQ(block.bases.size(), 1U);
    EXPECT_NEAR(block.bases[0].delta_up, -100, 1e-6);
    EXPECT_EQ(block.bases[0].mode, 4);
    EXPECT_EQ(block.bases[0].reference_id, 12);
    EXPECT_EQ(block.bases[0].corr_age, 80);
    EXPECT_EQ(sbf_receiver_status(state).rx_state >> 17 & 1, 0U);
    state.corrections.come = true;
    EXPECT_EQ(sbf_receiver_status(state).rx_state >> 17 & 1, 1U);
}

TEST(SbfStatus, TellsJammingSpoofingAndQuality) {
    NavigationState state = solved_state();
    EXPECT_TRUE(sbf_radio_status(state).bands.empty());
    const unsigned good = sbf_quality(state).indicators.at(0).value >> 8;
    state.monitors.upper.jamming_state = 3;
    state.monitors.spoofing = SpoofingIndication::indicated;
    const SbfRfStatus radio = sbf_radio_status(state);
    ASSERT_EQ(radio.bands.size(), 1U);
    EXPECT_EQ(radio.bands[0].frequency, 1575420000U);
    EXPECT_EQ(radio.bands[0].info & 15, 8);
    EXPECT_EQ(radio.flags, 1);
    EXPECT_LT(sbf_quality(state).indicators.at(0).value >> 8, good);
    state.fix_ok = false;
    EXPECT_EQ(sbf_quality(state).indicators.at(0).value, 0);
}

TEST(SbfStatus, TellsUtc) {
    const SbfReceiverTime time = sbf_receiver_time(solved_state());
    EXPECT_EQ(time.year, 24);
    EXPECT_EQ(time.hour, 12);
    EXPECT_EQ(time.second, 0);
    EXPECT_EQ(time.leap_seconds, 18);
    EXPECT_EQ(time.sync_level, 7);
    EXPECT_EQ(sbf_receiver_time({}).hour, -128);
}

// Blocks of a receiver that its client has told to send.
std::vector<int> blocks_in(const std::vector<StreamPiece>& pieces) {
    std::vector<int> numbers;
    for (const StreamPiece& piece : pieces)
        if (piece.kind == StreamKind::sbf) numbers.push_back(parse_sbf(piece.bytes)->number);
    return numbers;
}

TEST_F(SeptentrioReceiver, SendsFromTheFactoryOnWhatItsBoardNames) {
    BoardProfile board = septentrio_board();
    board.sbf_blocks = {"PVTGeodetic",     "PosCovGeodetic", "VelCovGeodetic", "DOP",           "AttEuler",
                        "AuxAntPositions", "EndOfPVT",       "ChannelStatus",  "ReceiverStatus"};
    receiver_ = Receiver(board, {});
    receiver_.start(now_);
    const auto first = blocks_in(wait(1010ms));
    ASSERT_GE(first.size(), 9U);
    EXPECT_EQ(std::vector<int>(first.begin(), first.begin() + 9),
              (std::vector<int>{4007, 5906, 5908, 4001, 5938, 5942, 5921, 4013, 4014}));
    say("sso,Stream1,COM1,none,off");
    wait(100ms);
    EXPECT_TRUE(blocks_in(wait(1s)).empty());
}

TEST_F(SeptentrioReceiver, SendsNothingAndThenWhatItIsTold) {
    EXPECT_TRUE(wait(2s).empty());
    say("sso,Stream1,COM1,Attitude,msec100");
    say("sso,Stream2,COM1,RFStatus+QualityInd,sec1");
    wait(100ms);
    const auto later = blocks_in(wait(2s));
    EXPECT_EQ(std::count(later.begin(), later.end(), 5938), 20);
    EXPECT_EQ(std::count(later.begin(), later.end(), 5939), 20);
    EXPECT_EQ(std::count(later.begin(), later.end(), 5943), 20);
    EXPECT_EQ(std::count(later.begin(), later.end(), 4092), 2);
    EXPECT_EQ(std::count(later.begin(), later.end(), 4082), 2);
}

TEST_F(SeptentrioReceiver, SendsItsSetupAtAnIntervalOrWhenItChanges) {
    say("sso,Stream1,COM1,ReceiverSetup,OnChange");
    wait(100ms);
    wait(500ms);
    EXPECT_TRUE(blocks_in(wait(2s)).empty());
    say("smp,ODESSA");
    wait(50ms);
    EXPECT_EQ(blocks_in(wait(2s)), std::vector<int>{5902});
    say("sso,Stream1,COM1,,sec1");
    wait(100ms);
    EXPECT_EQ(blocks_in(wait(3s)), (std::vector<int>{5902, 5902, 5902}));
    EXPECT_FALSE(receiver_.settings_at(now_).subframes);
    say("sso,Stream2,COM1,RawNavBits,OnChange");
    wait(100ms);
    EXPECT_TRUE(receiver_.settings_at(now_).subframes) << "asked of whoever receives them";
}

TEST_F(SeptentrioReceiver, TellsNothingOfSatellitesBelowTheMaskOfTracking) {
    const auto lowest = [&] {
        int elevation = 90;
        for (const StreamPiece& piece : wait(1s)) {
            const auto block = parse_sbf(piece.bytes);
            if (!block || block->number != SbfChannelStatus::block_number) continue;
            const auto status = decode_sbf<SbfChannelStatus>(block->body);
            for (const SbfChannel& channel : status->channels)
                elevation = std::min<int>(elevation, channel.elevation);
        }
        return elevation;
    };
    say("sso,Stream1,COM1,ChannelStatus,sec1");
    wait(100ms);
    EXPECT_EQ(lowest(), 8);
    say("sem,Tracking,20");
    wait(300ms);
    EXPECT_EQ(lowest(), 25);
}

TEST_F(SeptentrioReceiver, SendsSentencesToo) {
    say("sso,all,none,none,off");
    say("sno,Stream1,COM1,GGA+RMC,sec1");
    wait(100ms);
    std::string text;
    for (const StreamPiece& piece : wait(2s))
        if (piece.kind == StreamKind::nmea) text += to_string(piece.bytes);
    EXPECT_THAT(text, HasSubstr("GGA,120001.00,"));
    EXPECT_THAT(text, HasSubstr("RMC,120002.00,"));
    say("sdio,COM1,,-NMEA");
    wait(100ms);
    for (const StreamPiece& piece : wait(2s))
        EXPECT_NE(piece.kind, StreamKind::nmea);
}

TEST_F(SeptentrioReceiver, AnswersAtItsNewSpeedAndOnePieceAtATime) {
    say("sso,all,none,none,off");
    wait(100ms);
    say("scs,COM1,baud230400");
    std::string text;
    std::uint32_t baud = 0;
    for (int i = 0; i < 100; ++i) {
        now_ += 1ms;
        for (const Receiver::Sent& sent : receiver_.output(now_)) {
            text += to_string(sent.bytes);
            baud = sent.baud;
        }
    }
    EXPECT_EQ(baud, 230400U);
    EXPECT_EQ(text, "$R: scs,COM1,baud230400\r\n  COMSettings, COM1, baud230400, bits8, No, bit1, none\r\nCOM1>");
    say("erst,hard,none");
    wait(4s);
    say("gcs,COM1");
    EXPECT_EQ(receiver_.baud(PortId::uart1), 115200U) << "it was not saved";
}

}  // namespace
}  // namespace skyloop::firmware
