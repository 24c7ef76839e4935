#include "firmware/output_only/other_protocols.hpp"
#include "firmware/makers.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "sample_epochs.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::firmware {
namespace {

NavigationState navigating() {
    NavigationState state;
    state.epoch.fix = sample_fix("2026-03-01T23:59:58.2Z", 46.4775, -30.7326, 77);
    add_satellites(state.epoch.fix, Constellation::gps, 1, 8);
    add_satellites(state.epoch.fix, Constellation::galileo, 3, 4);
    state.epoch.fix.velocity = {-1.5, 2.25, 0.5};
    state.epoch.fix.speed_accuracy = MetresPerSecond(0.4);
    state.fix_ok = true;
    state.time = {true, true, true, true, Seconds(1e-8)};
    state.course = Angle::degrees(77.77);
    state.epoch_index = 130;
    state.since_start = Seconds(33.9);
    return state;
}

NavigationState without_fix() {
    NavigationState state;
    state.epoch.fix.time = navigating().epoch.fix.time;
    return state;
}

class OtherProtocols : public testing::Test {
protected:
    OtherProtocols() { board_.solution_latency = Seconds(0.05); }
    SbfPvtGeodetic pvt(const NavigationState& state) { return sbf_pvt_geodetic({board_, config_, state}); }
    MavlinkSent sent_;
    BoardProfile board_;
    ReceiverConfig config_;
};

TEST_F(OtherProtocols, MspTellsTheSolution) {
    const MspSensorGps m = msp_sensor_gps(navigating());
    EXPECT_EQ(m.gps_week, 2408);
    EXPECT_EQ(m.ms_tow, 86416200u);  // the end of Sunday, and 18 leap seconds
    EXPECT_EQ(m.fix_type, 3);
    EXPECT_EQ(m.satellites, 9);
    EXPECT_EQ(m.h_acc, 330);
    EXPECT_EQ(m.v_acc, 504);
    EXPECT_EQ(m.speed_acc, 40);
    EXPECT_EQ(m.dop, 110);
    EXPECT_EQ(m.latitude, 464775000);
    EXPECT_EQ(m.longitude, -307326000);
    EXPECT_EQ(m.msl_altitude, 5563);
    EXPECT_EQ(m.vel_north, -150);
    EXPECT_EQ(m.vel_down, 50);
    EXPECT_EQ(m.course, 7777);
    EXPECT_EQ(m.true_yaw, 0xFFFF);
    EXPECT_EQ(m.year, 2026);
    EXPECT_EQ(m.day, 1);
    EXPECT_EQ(m.second, 58);  // cut, not rounded
}

TEST_F(OtherProtocols, MspWithoutAFixHasNoPosition) {
    const MspSensorGps m = msp_sensor_gps(without_fix());
    EXPECT_EQ(m.gps_week, 0xFFFF);
    EXPECT_EQ(m.fix_type, 0) << "any other number is a fix to Betaflight";
    EXPECT_EQ(m.latitude, 0);
    EXPECT_EQ(m.h_acc, 0xFFFF);
    EXPECT_EQ(m.dop, 9999);
    EXPECT_EQ(m.year, 0);
    const MspSetRawGps raw = msp_set_raw_gps(without_fix());
    EXPECT_EQ(raw.fix, 0);
    EXPECT_EQ(raw.latitude, 0);
}

// A vehicle whose receiver has lost its fix is not in the Gulf of Guinea: clients take the position whatever the fix
// type.
TEST_F(OtherProtocols, TheLastPositionStaysWithoutAFix) {
    NavigationState lost = navigating();
    lost.epoch.fix.type = FixType::none;
    lost.position_known = lost.ever_had_fix = true;
    const MspSensorGps msp = msp_sensor_gps(lost);
    EXPECT_EQ(msp.fix_type, 0);
    EXPECT_EQ(msp.latitude, 464775000);
    EXPECT_EQ(msp.longitude, -307326000);
    EXPECT_EQ(msp.msl_altitude, 5563);
    EXPECT_EQ(msp.h_acc, 0xFFFF);
    EXPECT_EQ(msp.vel_north, 0);
    const MspSetRawGps raw = msp_set_raw_gps(lost);
    EXPECT_EQ(raw.fix, 0);
    EXPECT_EQ(raw.latitude, 464775000);
    EXPECT_EQ(raw.altitude, 56);
    EXPECT_EQ(raw.speed, 0);
    const MavlinkGpsInput input = mavlink_gps_input(lost);
    EXPECT_EQ(input.fix_type, 1);
    EXPECT_EQ(input.lat, 464775000);
    EXPECT_FLOAT_EQ(input.alt, 55.63F);
    EXPECT_EQ(input.ignore_flags, 0xFE) << "the altitude is there, the rest is not";
    EXPECT_EQ(input.hdop, 65535);
}

TEST_F(OtherProtocols, AnUnknownWeekLeavesTheTimeOfWeek) {
    NavigationState state = navigating();
    const std::uint32_t tow = msp_sensor_gps(state).ms_tow;
    state.time.date = false;
    EXPECT_EQ(msp_sensor_gps(state).gps_week, 0xFFFF);
    EXPECT_EQ(msp_sensor_gps(state).ms_tow, tow);
    EXPECT_EQ(mavlink_gps_input(state).time_week, 0);
    EXPECT_EQ(mavlink_gps_input(state).time_week_ms, tow);
    EXPECT_EQ(sbf_receiver_status(state).time.wnc, 0xFFFF);
    EXPECT_EQ(sbf_receiver_status(state).time.tow, tow);
    EXPECT_EQ(sbf_receiver_status(state).rx_state & 0x30, 0x20U);
}

TEST_F(OtherProtocols, AFixBeyondTheUsersLimitsIsNone) {
    NavigationState state = navigating();
    state.fix_ok = false;
    EXPECT_EQ(msp_sensor_gps(state).fix_type, 0);
    EXPECT_EQ(mavlink_gps_input(state).ignore_flags, 0xFF);
    EXPECT_EQ(pvt(state).mode, 0);
}

TEST_F(OtherProtocols, FixTypesAreThoseOfTheAutopilots) {
    NavigationState state = navigating();
    const std::pair<FixType, int> kinds[] = {
        {FixType::none, 1},  {FixType::dead_reckoning, 1}, {FixType::fix_2d, 2},    {FixType::fix_3d, 3},
        {FixType::dgnss, 4}, {FixType::rtk_float, 5},      {FixType::rtk_fixed, 6}, {FixType::time_only, 1}};
    for (const auto& [type, code] : kinds) {
        state.epoch.fix.type = type;
        EXPECT_EQ(msp_sensor_gps(state).fix_type, code == 1 ? 0 : code);
        EXPECT_EQ(mavlink_gps_input(state).fix_type, code);
    }
}

TEST_F(OtherProtocols, TheShortMspFormHasMetresAndNothingBelowSeaLevel) {
    NavigationState state = navigating();
    MspSetRawGps m = msp_set_raw_gps(state);
    EXPECT_EQ(m.fix, 1);
    EXPECT_EQ(m.altitude, 56);
    EXPECT_EQ(m.speed, 1250);
    state.epoch.fix.position.height.above_ellipsoid = Metres(-400);
    EXPECT_EQ(msp_set_raw_gps(state).altitude, 0);
}

TEST_F(OtherProtocols, GpsInputTellsTheSolution) {
    const MavlinkGpsInput m = mavlink_gps_input(navigating());
    EXPECT_EQ(m.time_usec, 1772409598200000u);  // 2026-03-01T23:59:58.2Z as POSIX counts
    EXPECT_EQ(m.time_week, 2408);
    EXPECT_EQ(m.time_week_ms, 86416200u);
    EXPECT_EQ(m.ignore_flags, 0);
    EXPECT_EQ(m.lat, 464775000);
    EXPECT_FLOAT_EQ(m.alt, 55.63F);
    EXPECT_FLOAT_EQ(m.hdop, 1.1F);
    EXPECT_FLOAT_EQ(m.vn, -1.5F);
    EXPECT_EQ(m.yaw, 0);
    const MavlinkGpsInput none = mavlink_gps_input(without_fix());
    EXPECT_EQ(none.ignore_flags, 0xFF);
    EXPECT_EQ(none.fix_type, 1);
    EXPECT_EQ(none.time_week, 0);
    EXPECT_EQ(none.hdop, 65535);
    NavigationState without_dop = navigating();
    without_dop.epoch.fix.dop = {};
    EXPECT_EQ(mavlink_gps_input(without_dop).ignore_flags, 2 | 4);
}

TEST_F(OtherProtocols, APairTellsWhereItPoints) {
    NavigationState state = navigating();
    state.epoch.relative = RelativePosition{1, 0, -1, Metres(0.01)};
    EXPECT_EQ(mavlink_gps_input(state).yaw, 36000);  // north; 0 would mean unknown
    EXPECT_EQ(msp_sensor_gps(state).true_yaw, 0);
    const SbfAttEuler attitude = sbf_attitude(state);
    EXPECT_FLOAT_EQ(attitude.heading, 0);
    EXPECT_FLOAT_EQ(attitude.pitch, 45);
    EXPECT_EQ(attitude.mode, 2);
    const SbfAuxAntPositions antennas = sbf_other_antenna(state);
    ASSERT_EQ(antennas.antennas.size(), 1u);
    EXPECT_EQ(antennas.antennas[0].error, 0);
    EXPECT_EQ(antennas.antennas[0].ambiguity_type, 0);
    EXPECT_DOUBLE_EQ(antennas.antennas[0].delta_north, 1);
    EXPECT_DOUBLE_EQ(antennas.antennas[0].delta_east, 0);
    EXPECT_DOUBLE_EQ(antennas.antennas[0].delta_up, 1);
    state.epoch.relative->north_m = 0;
    state.epoch.relative->east_m = -1;
    EXPECT_EQ(msp_sensor_gps(state).true_yaw, 27000);
    state.epoch.relative->base_moves = false;
    EXPECT_EQ(msp_sensor_gps(state).true_yaw, 0xFFFF);
    EXPECT_EQ(sbf_attitude(state).error, 1);
    EXPECT_TRUE(sbf_other_antenna(state).antennas.empty());
}

TEST_F(OtherProtocols, MavlinkHasAHeartbeatASecondAndCountsItsFramesWithoutAGap) {
    constexpr std::uint32_t heartbeat = 0, gps_input = 232;
    NavigationState state = navigating();
    sent_.sequence = 253;
    std::vector<int> sequence;
    std::vector<std::uint32_t> kinds;
    for (const double since_boot : {3.75, 4.0, 4.25, 4.75, 5.25}) {
        state.since_boot = Seconds(since_boot);
        for (const Bytes& frame : mavlink_messages(state, sent_)) {
            const auto view = parse_mavlink(frame);
            ASSERT_TRUE(view);
            sequence.push_back(view->source.sequence);
            kinds.push_back(view->message);
        }
    }
    EXPECT_EQ(kinds,
              (std::vector{heartbeat, gps_input, heartbeat, gps_input, gps_input, gps_input, heartbeat, gps_input}));
    EXPECT_EQ(sequence, (std::vector<int>{253, 254, 255, 0, 1, 2, 3, 4}));
}

TEST_F(OtherProtocols, SbfTellsTheSolution) {
    NavigationState state = navigating();
    const SbfPvtGeodetic m = pvt(state);
    EXPECT_EQ(m.time.wnc, 2408);
    EXPECT_EQ(m.time.tow, 86416200u);
    EXPECT_EQ(m.mode, 1);
    EXPECT_EQ(m.error, 0);
    EXPECT_NEAR(m.latitude, 46.4775 * std::numbers::pi / 180, 1e-15);
    EXPECT_DOUBLE_EQ(m.height, 77);
    EXPECT_FLOAT_EQ(m.vel_up, -0.5F);
    EXPECT_FLOAT_EQ(m.course, 77.77F);
    EXPECT_EQ(m.num_sv, 9);
    EXPECT_EQ(m.signal_info, 1u | 1u << 17);
    ASSERT_TRUE(m.accuracy);
    EXPECT_EQ(m.accuracy->latency, 500);
    EXPECT_EQ(m.accuracy->h_accuracy, 660);  // twice the root mean square
    EXPECT_EQ(m.accuracy->v_accuracy, 1008);
    state.epoch.fix.type = FixType::fix_2d;
    EXPECT_EQ(pvt(state).mode, 0x81);
    state.epoch.fix.type = FixType::dgnss;
    EXPECT_EQ(pvt(state).mode, 6);
    state.corrections.state = CorrectionState::differential;
    EXPECT_EQ(pvt(state).mode, 2);
    state.epoch.fix.speed = MetresPerSecond(0.05);
    EXPECT_EQ(pvt(state).course, static_cast<float>(sbf_nothing));
}

TEST_F(OtherProtocols, SbfWithoutAFixSaysNothing) {
    const SbfPvtGeodetic m = pvt(without_fix());
    EXPECT_EQ(m.time.tow, 0xFFFFFFFFu);
    EXPECT_EQ(m.error, 1);
    EXPECT_EQ(m.latitude, sbf_nothing);
    EXPECT_EQ(m.accuracy->h_accuracy, 0xFFFF);
    EXPECT_EQ(sbf_dop(without_fix()).pdop, 0);
    EXPECT_EQ(sbf_position_covariance(without_fix()).covariance, no_sbf_covariance);
    EXPECT_EQ(sbf_velocity_covariance(without_fix()).covariance, no_sbf_covariance);
    EXPECT_EQ(sbf_receiver_status(without_fix()).rx_state, 0u);
}

TEST_F(OtherProtocols, SbfLeavesOutTheDopsOfAHeightThatIsHeld) {
    NavigationState state = navigating();
    Fix& fix = state.epoch.fix;
    fix.type = FixType::fix_2d;
    fix.dop.gdop = fix.dop.pdop = fix.dop.vdop = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(sbf_dop(state).pdop, 0);
    EXPECT_EQ(sbf_dop(state).vdop, 0);
    EXPECT_EQ(sbf_dop(state).hdop, 110);
    const auto velocity = sbf_velocity_covariance(state).covariance;
    EXPECT_NEAR(velocity[0] + velocity[1], std::pow(fix.speed_accuracy.value(), 2), 1e-6);
    EXPECT_EQ(velocity[2], static_cast<float>(sbf_nothing));
}

TEST_F(OtherProtocols, CovariancesAddUpToTheAccuracies) {
    const NavigationState state = navigating();
    const auto position = sbf_position_covariance(state).covariance;
    EXPECT_NEAR(position[0] + position[1], 3.3 * 3.3, 1e-4);
    EXPECT_NEAR(position[2], 5.04 * 5.04, 1e-4);
    EXPECT_LE(position[4] * position[4], position[0] * position[1]);
    const auto velocity = sbf_velocity_covariance(state).covariance;
    EXPECT_NEAR(velocity[0] + velocity[1] + velocity[2], 0.4 * 0.4, 1e-6);
    EXPECT_EQ(velocity[3], static_cast<float>(sbf_nothing));
}

TEST_F(OtherProtocols, ChannelsAreTheTrackedSatellites) {
    NavigationState state = navigating();
    const SatelliteId glonass{Constellation::glonass, 7};
    state.epoch.fix.satellites.push_back({glonass, Angle::degrees(10), Angle::degrees(20), DbHz(40), true});
    state.epoch.observations.signals.emplace_back();
    state.epoch.observations.signals.back().satellite = glonass;
    state.epoch.observations.signals.back().signal = Signal::g1;
    state.epoch.observations.signals.back().carrier = carrier_frequency(Signal::g1, -4);
    EXPECT_EQ(sbf_channel_status(state).channels.back().freq_nr, 4);
    EXPECT_EQ(sbf_channel_status(state).channels.front().freq_nr, 0);
    const SbfChannelStatus m = sbf_channel_status(navigating());
    ASSERT_EQ(m.channels.size(), 9u);
    EXPECT_EQ(m.channels[0].svid, 1);
    EXPECT_EQ(m.channels[0].azimuth, 11 | 3 << 14);
    EXPECT_EQ(m.channels[0].elevation, 8);
    EXPECT_EQ(m.channels[0].tracking_status, 3);
    EXPECT_EQ(m.channels[0].pvt_status, 2);
    EXPECT_EQ(m.channels[6].svid, 73);
    EXPECT_EQ(m.channels[6].tracking_status, 3 << 2);  // Galileo's first two bits are another signal's
    EXPECT_EQ(m.channels[6].rx_channel, 7);
}

TEST_F(OtherProtocols, ChannelsAreUsedInASolutionAlone) {
    NavigationState state = navigating();
    for (const FixType type : {FixType::none, FixType::dead_reckoning, FixType::time_only}) {
        state.epoch.fix.type = type;
        for (const SbfChannel& channel : sbf_channel_status(state).channels)
            EXPECT_EQ(channel.pvt_status, 0) << fix_type_name(type);
    }
}

// What is due on a port at an epoch.
std::vector<Bytes> due_of(MakerKind kind, PortId port) {
    BoardProfile board;
    board.maker = kind;
    board.ports = {PortId::uart1, PortId::usb};
    const std::unique_ptr<Maker> maker = maker_row(kind).make(board, {});
    const NavigationState state = navigating();
    EpochMessages made({board, maker->config(), state});
    const DueMessages due = maker->due(port, made, {});
    std::vector<Bytes> frames;
    for (const ByteSpan frame : due.frames)
        frames.emplace_back(frame.begin(), frame.end());
    return frames;
}

TEST(OutputOnly, SendsItsOwnFramesByUart1Alone) {
    EXPECT_EQ(parse_msp(due_of(MakerKind::msp, PortId::uart1).at(0))->function, 0x1F03);
    EXPECT_EQ(parse_msp(due_of(MakerKind::msp_v1, PortId::uart1).at(0))->function, 201);
    EXPECT_EQ(parse_mavlink(due_of(MakerKind::mavlink, PortId::uart1).at(1))->message, 232u);
    for (const MakerKind kind : {MakerKind::msp, MakerKind::msp_v1, MakerKind::mavlink})
        EXPECT_TRUE(due_of(kind, PortId::usb).empty());
    EXPECT_TRUE(due_of(MakerKind::sbf, PortId::uart1).empty()) << "its streams say what it sends";
    EXPECT_TRUE(due_of(MakerKind::mute, PortId::uart1).empty());
}

}  // namespace
}  // namespace skyloop::firmware
