// A Septentrio receiver as the reference station of others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_descriptors.hpp"
#include "receiver/protocol/rtcm3_ephemeris.hpp"
#include "receiver/protocol/sbf_blocks.hpp"
#include "septentrio_receiver.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

std::vector<int> corrections_in(const std::vector<StreamPiece>& pieces) {
    std::vector<int> numbers;
    for (const StreamPiece& piece : pieces)
        if (piece.kind == StreamKind::rtcm3) numbers.push_back(parse_rtcm3(piece.bytes)->number);
    return numbers;
}

TEST_F(SeptentrioReceiver, IsAReferenceStationAtThePlaceThatItWasTold) {
    Observation signal;
    signal.satellite = {Constellation::gps, 1};
    signal.signal = Signal::l1;
    signal.carrier = carrier_frequency(Signal::l1);
    signal.cn0 = DbHz(41);
    signal.pseudorange = Metres(2.2e7);
    observations_.signals = {signal};
    say("sso,Stream1,COM1,PVTGeodetic,sec1");
    say("sdio,COM1,auto,SBF");
    say("sr3f,123");
    say("sr3i,MSM4,0.5");
    wait(1s);
    EXPECT_THAT(corrections_in(wait(2s)), ElementsAre()) << "it is not let out";
    say("sdio,COM1,,+RTCMv3");
    wait(1s);
    EXPECT_THAT(corrections_in(wait(1s)), ElementsAre(1033, 1074, 1230, 1074)) << "it moves";
    say("sao,Main,0,0,1.5");
    say("sspg,Geodetic1,47.5,8.25,400");
    say("spm,Static,,Geodetic1");
    wait(1s);
    const std::vector<StreamPiece> pieces = wait(1s);
    EXPECT_THAT(corrections_in(pieces), ElementsAre(1006, 1033, 1074, 1230, 1074));
    for (const StreamPiece& piece : pieces) {
        if (piece.kind == StreamKind::sbf) {
            const auto pvt = decode_sbf<SbfPvtGeodetic>(parse_sbf(piece.bytes)->body);
            EXPECT_EQ(pvt->mode, 3) << "fixed location";
            EXPECT_EQ(pvt->error, 0);
            EXPECT_NEAR(pvt->latitude, Angle::degrees(47.5).rad(), 1e-10);
            EXPECT_EQ(pvt->vel_north, 0);
        } else if (piece.kind != StreamKind::rtcm3) {
            continue;
        } else if (const auto station = decode_station(*parse_rtcm3(piece.bytes))) {
            EXPECT_EQ(station->station, 123);
            EXPECT_EQ(station->antenna_height, 15000);
            EXPECT_EQ(station->position[0],
                      std::llround(to_ecef(Geodetic::degrees(47.5, 8.25, 400)).vector().x() * 1e4));
        }
    }
}

Observation measured_signal(SatelliteId satellite, Signal signal) {
    Observation o;
    o.satellite = satellite;
    o.signal = signal;
    o.carrier = carrier_frequency(signal);
    o.cn0 = DbHz(41);
    o.pseudorange = Metres(2.2e7);
    return o;
}

TEST_F(SeptentrioReceiver, TellsRoversEveryKindOfObservations) {
    observations_.signals = {
        measured_signal({Constellation::gps, 1}, Signal::l1), measured_signal({Constellation::galileo, 4}, Signal::l1),
        measured_signal({Constellation::sbas, 23}, Signal::l1), measured_signal({Constellation::qzss, 2}, Signal::l1)};
    say("sdio,COM1,auto,RTCMv3");
    say("sr3o,COM1,RTCM1004+RTCM1012+MSM5+RTCM1107+RTCM1137");
    wait(1s);
    EXPECT_THAT(corrections_in(wait(1s)), ElementsAre(1004, 1075, 1095, 1105, 1107, 1115));
    say("sr3i,MSM5,2");
    wait(1s);
    EXPECT_THAT(corrections_in(wait(2s)), ElementsAre(1004, 1107, 1004, 1075, 1095, 1105, 1107, 1115));
}

TEST_F(SeptentrioReceiver, NamesItsAntennaToRovers) {
    say("sdio,COM1,auto,RTCMv3");
    say("sr3f,123");
    say("sao,Main,0,0,1.5,\"SEPCHOKE_B3E6 SPKE\",5447,2");
    say("sr3o,COM1,RTCM1007+RTCM1008+RTCM1033");
    wait(1s);
    std::vector<Rtcm3Descriptors> told;
    for (const StreamPiece& piece : wait(1s)) {
        if (piece.kind != StreamKind::rtcm3) continue;
        if (const auto one = decode_descriptors(*parse_rtcm3(piece.bytes))) told.push_back(*one);
    }
    const BoardProfile board = septentrio_board();
    EXPECT_THAT(told, ElementsAre(Rtcm3Descriptors{1007, 123, "SEPCHOKE_B3E6 SPKE", 2, "", "", "", ""},
                                  Rtcm3Descriptors{1008, 123, "SEPCHOKE_B3E6 SPKE", 2, "5447", "", "", ""},
                                  Rtcm3Descriptors{1033, 123, "SEPCHOKE_B3E6 SPKE", 2, "5447", board.identity.hardware,
                                                   board.identity.software, ""}));
}

TEST_F(SeptentrioReceiver, HandsTheRecordsOfTrackedSatellitesOn) {
    KeplerEphemeris gps;
    gps.satellite = {Constellation::gps, 1};
    gps.toe = gps.toc = now_;
    gps.iode = gps.iodc = 77;
    GlonassEphemeris gone;
    gone.satellite = {Constellation::glonass, 5};
    gone.toe = now_;
    observations_.signals = {measured_signal(gps.satellite, Signal::l1)};
    say("sdio,COM1,auto,RTCMv3");
    say("sr3o,COM1,MSM4");
    wait(100ms);
    EXPECT_FALSE(receiver_.settings_at(now_).subframes);
    say("sr3o,COM1,RTCM1019+RTCM1020");
    wait(1s);
    EXPECT_TRUE(receiver_.settings_at(now_).subframes) << "asked of whoever receives them";
    EXPECT_THAT(corrections_in(wait(2s)), ElementsAre()) << "none has been received";
    subframes_ = {{gps.satellite, Signal::l1, now_, 0, {}, gps}, {gone.satellite, Signal::g1, now_, 0, {}, gone}};
    wait(1s);
    subframes_.clear();
    say("sr3i,RTCM1019,2");
    wait(1s);
    const std::vector<StreamPiece> pieces = wait(2s);
    ASSERT_THAT(corrections_in(pieces), ElementsAre(1019)) << "that of GLONASS is not tracked";
    for (const StreamPiece& piece : pieces) {
        if (piece.kind != StreamKind::rtcm3) continue;
        EXPECT_EQ(iode_of(*decode_ephemeris(*parse_rtcm3(piece.bytes), now_)), 77);
    }
}

}  // namespace
}  // namespace skyloop::firmware
