#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "base/geo/geodetic.hpp"
#include "firmware/core/receiver.hpp"
#include "firmware/messages/rtcm_observations.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_legacy.hpp"
#include "receiver/protocol/rtcm3_signals.hpp"
#include "receiver/protocol/rtcm3_ublox.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "ubx_reports.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

constexpr UbxMessageId rtcm_1005{0xF5, 0x05}, rtcm_1077{0xF5, 0x4D}, rtcm_1087{0xF5, 0x57}, rtcm_1097{0xF5, 0x61},
    rtcm_1127{0xF5, 0x7F}, rtcm_1230{0xF5, 0xE6};

Observation rtcm_signal(SatelliteId satellite, Signal signal) {
    Observation o;
    o.satellite = satellite;
    o.signal = signal;
    o.carrier = carrier_frequency(signal);
    o.cn0 = DbHz(41);
    o.pseudorange = Metres(2.2e7);
    o.carrier_phase = 1.15e8;
    o.doppler = Hertz(-1000);
    o.lock_time = Seconds(5);
    return o;
}

UbxReport reference() {
    UbxReport f9(9, "2024-03-05T22:49:23.000Z");
    f9.state.epoch.observations.receive_time = f9.state.epoch.fix.time + 200us;
    f9.state.epoch.observations.signals = {
        rtcm_signal({Constellation::gps, 1}, Signal::l1), rtcm_signal({Constellation::gps, 1}, Signal::l2),
        rtcm_signal({Constellation::glonass, 5}, Signal::g1), rtcm_signal({Constellation::beidou, 63}, Signal::b1i)};
    return f9;
}

Rtcm3MsmHeader head_of(const UbxReport& f9, UbxMessageId id) {
    const auto frames = make_rtcm_message(id, f9.context());
    EXPECT_EQ(frames.size(), 1U);
    if (frames.empty()) return {};
    return decode_msm_header(*parse_rtcm3(frames.front())).value_or(Rtcm3MsmHeader{});
}

TEST(RtcmMessages, ObservationsAreInTheTimeOfTheirSystem) {
    const UbxReport f9 = reference();
    const auto gps = head_of(f9, rtcm_1077);
    // Tuesday 22:49:23 UTC and 18 leap seconds.
    const std::uint32_t tuesday = 2 * 86'400'000, of_day = (22 * 3600 + 49 * 60 + 23) * 1000;
    EXPECT_EQ(gps.number, 1077);
    EXPECT_EQ(gps.epoch, tuesday + of_day + 18'000);
    EXPECT_EQ(gps.satellites, std::uint64_t{1} << 63);
    EXPECT_EQ(gps.signals, 1U << 30 | 1U << 16);
    EXPECT_EQ(head_of(f9, rtcm_1127).epoch, tuesday + of_day + 4'000);
    // Moscow is three hours ahead: already Wednesday.
    EXPECT_EQ(head_of(f9, rtcm_1087).epoch, 3U << 27 | (of_day + 3 * 3'600'000 - 86'400'000));
    EXPECT_TRUE(make_rtcm_message(rtcm_1097, f9.context()).empty());
}

TEST(RtcmMessages, AllButTheLastOfTheEpochSayThatMoreFollow) {
    const UbxReport f9 = reference();
    const auto more = [&](std::vector<UbxMessageId> following) {
        ReportContext context = f9.context();
        context.following = following;
        return decode_msm_header(*parse_rtcm3(make_rtcm_message(rtcm_1077, context).at(0))).value().more;
    };
    EXPECT_FALSE(more({}));
    EXPECT_TRUE(more({rtcm_1127}));
    EXPECT_FALSE(more({{0x01, 0x07}, rtcm_1230}));
    // Nothing is heard of Galileo.
    EXPECT_FALSE(more({rtcm_1097}));
    EXPECT_TRUE(more({rtcm_1097, rtcm_1127}));
}

// Messages of the observations in what left a receiver, with their "more follow", by epochs.
std::vector<std::map<int, bool>> msm_by_epoch(Receiver& receiver, int epochs) {
    std::vector<std::map<int, bool>> heard;
    StreamSplitter splitter;
    for (int i = 0; i < epochs; ++i) {
        UbxReport report = reference();
        Epoch& epoch = report.state.epoch;
        epoch.fix.time += i * 1s;
        epoch.observations.receive_time += i * 1s;
        receiver.on_epoch(epoch);
        heard.emplace_back();
        for (const Receiver::Sent& sent : receiver.output(epoch.fix.time + 999ms))
            for (const StreamPiece& piece : splitter.feed(sent.bytes))
                if (const auto head = decode_msm_header(*parse_rtcm3(piece.bytes)))
                    heard.back()[head->number] = head->more;
    }
    return heard;
}

// At other rates than the others' and withheld a message does not follow.
TEST(RtcmMessages, TheLastOfEachEpochIsToldAsSuch) {
    BoardProfile board = sample_ublox();
    board.messages = {rtcm_1077, rtcm_1087, rtcm_1097, rtcm_1127};
    board.config[*rate_key(rtcm_1077, PortId::uart1)] = 1;
    board.config[*rate_key(rtcm_1087, PortId::uart1)] = 1;
    board.config[*rate_key(rtcm_1097, PortId::uart1)] = 1;
    board.config[*rate_key(rtcm_1127, PortId::uart1)] = 3;
    board.config[key::out_protocol(PortId::uart1, 4)] = 1;
    Receiver receiver(board, {1});
    using Heard = std::map<int, bool>;
    const Heard two{{1077, true}, {1087, false}}, three{{1077, true}, {1087, true}, {1127, false}};
    EXPECT_THAT(msm_by_epoch(receiver, 5), testing::ElementsAre(three, two, two, three, two));
    FirmwareFaults faults;
    faults.withheld = {rtcm_1127};
    Receiver withholding(board, {1});
    withholding.set_faults(faults);
    EXPECT_THAT(msm_by_epoch(withholding, 1), testing::ElementsAre(two));
}

// With the clock's error its drift, 149.896 m/s here, leaves the ranges.
TEST(RtcmMessages, RatesAreThoseOfThePhases) {
    UbxReport f9 = reference();
    f9.state.epoch.observations.signals = {rtcm_signal({Constellation::gps, 1}, Signal::l1)};
    Rtcm3MsmCell cell;
    cell.wavelength_m = speed_of_light / carrier_frequency(Signal::l1).value();
    cell.range_m = 2.2e7 - 200e-6 * speed_of_light;
    cell.phase_range_m = 1.15e8 * cell.wavelength_m - 200e-6 * speed_of_light;
    cell.phase_range_rate = 1000 * cell.wavelength_m - 149.896229;
    cell.lock_s = 5;
    cell.cno_dbhz = 41;
    Rtcm3MsmObservations expected;
    expected.epoch = head_of(f9, rtcm_1077).epoch;
    expected.cells = {cell};
    EXPECT_EQ(make_rtcm_message(rtcm_1077, f9.context()), std::vector<Bytes>{encode(expected)});
}

TEST(RtcmMessages, NothingIsTrueBeforeTimeIsKnown) {
    UbxReport f9 = reference();
    f9.state.time = {};
    for (const UbxMessageId id : {rtcm_1005, rtcm_1077, rtcm_1230})
        EXPECT_TRUE(make_rtcm_message(id, f9.context()).empty());
}

// DF394 and DF395 of each system (RTCM 10403.3, tables 3.5-91 to 3.5-108).
TEST(RtcmMessages, EverySystemHasItsSatellitesAndSignals) {
    struct Case {
        int number;
        SatelliteId satellite;
        Signal signal;
        int told_satellite, told_signal;
    };
    const Case cases[] = {{1075, {Constellation::gps, 32}, Signal::l5, 32, 23},
                          {1085, {Constellation::glonass, 24}, Signal::g2, 24, 8},
                          {1095, {Constellation::galileo, 36}, Signal::e5b, 36, 15},
                          {1105, {Constellation::sbas, 36}, Signal::l1, 17, 2},  // PRN 136
                          {1115, {Constellation::qzss, 3}, Signal::l2, 3, 16},
                          {1125, {Constellation::beidou, 63}, Signal::l5, 63, 23},
                          {1135, {Constellation::navic, 9}, Signal::l5, 9, 22}};
    UbxReport report = reference();
    Observations& observations = report.state.epoch.observations;
    const RtcmEpoch epoch{observations, 18, MetresPerSecond(0), 7};
    for (const Case& one : cases) {
        observations.signals = {rtcm_signal(one.satellite, one.signal)};
        EXPECT_EQ(msm_constellation(one.number), one.satellite.constellation);
        EXPECT_EQ(msm_number(one.satellite.constellation, 5), one.number);
        const auto frames = msm_frames(epoch, one.number, false);
        ASSERT_EQ(frames.size(), 1U) << one.number;
        const auto told = decode_msm(*parse_rtcm3(frames.front()));
        ASSERT_TRUE(told && told->cells.size() == 1) << one.number;
        EXPECT_EQ(told->station, 7);
        EXPECT_EQ(told->cells[0].satellite, one.told_satellite) << one.number;
        EXPECT_EQ(told->cells[0].signal, one.told_signal) << one.number;
        EXPECT_TRUE(told->cells[0].phase_range_rate) << "MSM5 has rates";
    }
    EXPECT_TRUE(msm_frames(epoch, 1077, false).empty());
    EXPECT_TRUE(msm_frames(epoch, 1078, false).empty());
}

TEST(RtcmMessages, MoreThan64CellsAreToldInTwoMessages) {
    UbxReport report = reference();
    Observations& observations = report.state.epoch.observations;
    observations.signals.clear();
    for (int number = 1; number <= 25; ++number)
        for (const Signal signal : {Signal::l1, Signal::l2, Signal::l5})
            observations.signals.push_back(rtcm_signal({Constellation::gps, number}, signal));
    const auto frames = msm_frames({observations, 18, MetresPerSecond(0), 0}, 1077, false);
    ASSERT_EQ(frames.size(), 2U);
    const auto first = decode_msm(*parse_rtcm3(frames[0])), second = decode_msm(*parse_rtcm3(frames[1]));
    EXPECT_TRUE(first->more);
    EXPECT_FALSE(second->more);
    EXPECT_EQ(first->cells.size(), 63U);
    EXPECT_EQ(second->cells.size(), 12U);
    EXPECT_EQ(second->cells.front().satellite, 22);
}

TEST(RtcmMessages, ObservationsAreToldAsBeforeToo) {
    UbxReport f9 = reference();
    const auto told = [&](std::uint8_t id) {
        const auto frames = make_rtcm_message({0xF5, id}, f9.context());
        return frames.empty() ? Rtcm3LegacyObservables() : *decode_legacy(*parse_rtcm3(frames.front()));
    };
    const Rtcm3LegacyObservables gps = told(4), glonass = told(12);
    EXPECT_EQ(gps.number, 1004);
    EXPECT_EQ(gps.epoch, head_of(f9, rtcm_1077).epoch);
    ASSERT_EQ(gps.satellites.size(), 1U);
    EXPECT_NEAR(*gps.satellites[0].l1.range_m, 2.2e7 - 200e-6 * speed_of_light, 0.011);
    EXPECT_TRUE(gps.satellites[0].l2);
    EXPECT_EQ(gps.satellites[0].l1.cno_dbhz, 41);
    EXPECT_EQ(gps.satellites[0].l1.lock_s, 5);
    EXPECT_EQ(glonass.number, 1012);
    EXPECT_EQ(glonass.epoch, head_of(f9, rtcm_1087).epoch & 0x7FF'FFFF);
    ASSERT_EQ(glonass.satellites.size(), 1U);
    EXPECT_FALSE(glonass.satellites[0].l2);
    EXPECT_EQ(glonass.satellites[0].frequency_channel, 0);
}

TEST(RtcmMessages, AMovingBaseTellsItsPlaceAndVelocity) {
    UbxReport f9 = reference();
    f9.config.set(in_ram, 0x30090001, 12);
    const auto frames = make_rtcm_message({0xF5, 0xFE}, f9.context());
    ASSERT_EQ(frames.size(), 1U);
    const auto message = parse_rtcm3(frames.front());
    EXPECT_EQ(message->number, 4072);
    EXPECT_EQ(message->subtype, 0);
    EXPECT_EQ(message->station, 12);
    const auto told = decode_moving_station(*message);
    ASSERT_TRUE(told);
    EXPECT_EQ(told->head.epoch, head_of(f9, rtcm_1077).epoch);
    const Fix& fix = f9.state.epoch.fix;
    const Eigen::Vector3d place = to_ecef(fix.position).vector();
    double speed = 0;
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(static_cast<double>(told->position[static_cast<std::size_t>(i)]) * 1e-4, place[i], 1e-4);
        speed = std::hypot(speed, told->velocity[static_cast<std::size_t>(i)] * 1e-3);
    }
    EXPECT_NEAR(speed, std::hypot(fix.velocity.north, fix.velocity.east, fix.velocity.down), 2e-3);
    EXPECT_EQ(told->velocity_deviation, 250U);
    f9.lose_fix();
    EXPECT_TRUE(make_rtcm_message({0xF5, 0xFE}, f9.context()).empty());
}

TEST(RtcmMessages, TheBandsOfABaseHaveNoBiases) {
    const UbxReport f9 = reference();
    const auto told = decode_station_biases(*parse_rtcm3(make_rtcm_message({0xF5, 0xFD}, f9.context()).at(0)));
    ASSERT_TRUE(told);
    EXPECT_EQ(told->head.epoch, head_of(f9, rtcm_1077).epoch);
    const std::vector<Rtcm3StationBiases::Bias> bands{{0, 0, 0, 0}, {0, 1, 0, 0}, {3, 0, 0, 0}, {6, 0, 0, 0}};
    EXPECT_EQ(told->biases, bands);
}

// A ZED-F9P's 1230, as its users print it.
TEST(RtcmMessages, BiasesAreThoseOfAZedF9p) {
    const Bytes captured{0xD3, 0x00, 0x04, 0x4C, 0xE0, 0x00, 0x80, 0xED, 0xED, 0xD6};
    EXPECT_EQ(make_rtcm_message(rtcm_1230, reference().context()), std::vector<Bytes>{captured});
}

TEST(RtcmMessages, OnlyAFixedStationTellsWhereItStands) {
    UbxReport f9 = reference();
    EXPECT_TRUE(make_rtcm_message(rtcm_1005, f9.context()).empty());
    f9.config.set(in_ram, 0x20030001, 2);
    f9.config.set(in_ram, 0x40030003, 378'000'000);
    f9.config.set(in_ram, 0x20030006, 0xFD);  // -3
    const auto station = [&] {
        return decode_station(*parse_rtcm3(make_rtcm_message(rtcm_1005, f9.context()).at(0))).value();
    };
    EXPECT_EQ(station().position[0], 37'799'999'997);
    f9.config.set(in_ram, 0x20030002, 1);
    f9.config.set(in_ram, 0x40030009, 471'234'567);
    f9.config.set(in_ram, 0x2003000C, 89);
    f9.config.set(in_ram, 0x4003000A, 87'654'321);
    f9.config.set(in_ram, 0x4003000B, 51'234);
    const Eigen::Vector3d place = to_ecef(Geodetic::degrees(47.123456789, 8.7654321, 512.34)).vector();
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(static_cast<double>(station().position[static_cast<std::size_t>(i)]) * 1e-4, place[i], 1e-4);
}

// A poll is answered by the protocol of its message: a base's port has NMEA off.
TEST(RtcmMessages, PolledOnesLeaveWhereTheirProtocolMay) {
    constexpr std::uint32_t out_nmea = 0x10740002, out_rtcm = 0x10740004;
    for (const bool rtcm : {true, false}) {
        BoardProfile board = sample_ublox();
        board.messages.push_back(rtcm_1005);
        board.config = {{0x20030001, 2}, {0x40030003, 378'000'000}, {out_nmea, !rtcm}, {out_rtcm, rtcm}};
        Receiver receiver(board, {});
        const GpsTime now = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500).time;
        receiver.start(now);
        receiver.input(PortId::uart1, encode_frame(rtcm_1005, {}), now);
        std::size_t answers = 0;
        for (const Receiver::Sent& sent : receiver.output(now + 500ms))
            if (sent.port == PortId::uart1 && !sent.bytes.empty()) ++answers;
        EXPECT_EQ(answers > 0, rtcm);
    }
}

}  // namespace
}  // namespace skyloop::firmware
