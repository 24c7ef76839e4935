// SBF blocks of measurements and of navigation messages, read back as a decoder does.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "base/geo/geodetic.hpp"
#include "firmware/septentrio/console.hpp"
#include "firmware/septentrio/rover_and_station.hpp"
#include "firmware/septentrio/sbf_messages.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "receiver/protocol/sbf_raw_blocks.hpp"
#include "sample_epochs.hpp"
#include "world/gnss/broadcast_lnav.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/sbas_message.hpp"

namespace skyloop::firmware {
namespace {

constexpr SatelliteId gps_measured{Constellation::gps, 3}, glonass_measured{Constellation::glonass, 5};

Observation measured_signal(SatelliteId satellite, Signal signal, double range_m, double doppler_hz) {
    Observation o;
    o.satellite = satellite;
    o.signal = signal;
    o.carrier = carrier_frequency(signal, satellite.constellation == Constellation::glonass ? -2 : 0);
    o.cn0 = DbHz(44.35);
    o.pseudorange = Metres(range_m);
    o.carrier_phase = range_m * o.carrier.value() / speed_of_light + 37;
    o.doppler = Hertz(doppler_hz);
    o.lock_time = Seconds(12.7);
    o.pseudorange_deviation = Metres(0.3);
    o.carrier_phase_deviation = 0.01;
    o.doppler_deviation = Hertz(0.02);
    return o;
}

// Measured while the receiver's clock was a quarter of a millisecond ahead of the epoch.
NavigationState measuring_state() {
    NavigationState state;
    Fix& fix = state.epoch.fix;
    fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
    add_satellites(fix, Constellation::gps, 1, 8);
    add_satellites(fix, Constellation::glonass, 1, 8);
    state.fix_ok = true;
    state.time = {true, true, true, true, Seconds(1e-8)};
    state.epoch.observations.receive_time = advanced(fix.time, Seconds(0.25e-3));
    state.epoch.observations.signals = {measured_signal(gps_measured, Signal::l1, 2.2e7, 3000),
                                        measured_signal(gps_measured, Signal::l2, 2.2e7 + 12.345, 2337.5),
                                        measured_signal(glonass_measured, Signal::g1, 2.1e7, -1500)};
    return state;
}

struct ReadSignal {
    double range, phase, doppler, cn0;
};

double wavelength_of(const Observation& o) { return speed_of_light / o.carrier.value(); }

ReadSignal read_first(const SbfMeasuredSatellite& s, double wavelength) {
    const double range = ((s.misc & 15) * 4294967296.0 + s.code_lsb) * 0.001;
    return {range, range / wavelength + (s.carrier_msb * 65536.0 + s.carrier_lsb) * 0.001, s.doppler * 1e-4,
            s.cn0 * 0.25 + 10};
}

int signed_bits(unsigned value, unsigned bits) {
    return value >> (bits - 1) != 0 ? static_cast<int>(value) - (1 << bits) : static_cast<int>(value);
}

ReadSignal read_other(const SbfOtherSignal& s, const ReadSignal& first, double wavelength, double first_wavelength) {
    const double range = first.range + (signed_bits(s.offsets_msb & 7u, 3) * 65536.0 + s.code_offset_lsb) * 0.001;
    return {range, range / wavelength + (s.carrier_msb * 65536.0 + s.carrier_lsb) * 0.001,
            first.doppler * first_wavelength / wavelength +
                (signed_bits(s.offsets_msb >> 3u, 5) * 65536.0 + s.doppler_offset_lsb) * 1e-4,
            s.cn0 * 0.25 + 10};
}

// What the signal would have been a quarter of a millisecond before: the range changes by −λD.
void expect_then(const ReadSignal& read, const Observation& o) {
    const double past = 0.25e-3, rate = -o.doppler->value();
    EXPECT_NEAR(read.range, o.pseudorange->value() - past * rate * wavelength_of(o), 0.0011);
    EXPECT_NEAR(read.phase, *o.carrier_phase - past * rate, 0.0011);
    EXPECT_NEAR(read.doppler, o.doppler->value(), 1.1e-4);
    EXPECT_NEAR(read.cn0, 44.35, 0.25);
}

TEST(SbfMeasurements, AreThoseOfTheWholeMillisecond) {
    const NavigationState state = measuring_state();
    const auto& signals = state.epoch.observations.signals;
    const SbfMeasEpoch block = sbf_measurements(state, {});
    ASSERT_EQ(block.satellites.size(), 2u);
    EXPECT_EQ(block.time.tow % 1000, 0u);
    const SbfMeasuredSatellite& gps = block.satellites[0];
    EXPECT_EQ(gps.svid, 3);
    EXPECT_EQ(gps.rx_channel, 3);
    EXPECT_EQ(gps.lock_time, 12);
    const ReadSignal first = read_first(gps, wavelength_of(signals[0]));
    expect_then(first, signals[0]);
    ASSERT_EQ(gps.others.size(), 1u);
    EXPECT_EQ(gps.others[0].type, 3) << "L2C";
    expect_then(read_other(gps.others[0], first, wavelength_of(signals[1]), wavelength_of(signals[0])), signals[1]);
    const SbfMeasuredSatellite& glonass = block.satellites[1];
    EXPECT_EQ(glonass.svid, 42);
    EXPECT_EQ(glonass.type, 8);
    EXPECT_EQ(glonass.obs_info >> 3, 6) << "channel −2";
    expect_then(read_first(glonass, wavelength_of(signals[2])), signals[2]);
}

TEST(SbfMeasurements, WhatIsNotThereIsNotTold) {
    NavigationState state = measuring_state();
    auto& signals = state.epoch.observations.signals;
    signals[0].carrier_phase.reset();
    signals[1].pseudorange = Metres(2.2e7 + 300);
    signals[2].doppler.reset();
    const SbfMeasEpoch block = sbf_measurements(state, {});
    ASSERT_EQ(block.satellites.size(), 1u) << "what cannot be carried to the millisecond";
    EXPECT_EQ(block.satellites[0].carrier_msb, -128);
    EXPECT_EQ(block.satellites[0].carrier_lsb, 0);
    EXPECT_EQ(block.satellites[0].lock_time, 65535);
    EXPECT_EQ(block.satellites[0].others.at(0).offsets_msb & 7, 4) << "more than 19 bits of millimetres";
    EXPECT_EQ(block.satellites[0].others.at(0).carrier_msb, -128);
    state.time.date = false;
    EXPECT_TRUE(sbf_measurements(state, {}).satellites.empty());
}

TEST(SbfMeasurements, CountsLossesAndJumpsOfTheClock) {
    NavigationState state = measuring_state();
    SbfMeasurementCounts counts;
    counts.follow(state);
    const Observation& gps = state.epoch.observations.signals[0];
    EXPECT_EQ(counts.losses(gps), 1);
    counts.follow(state);
    EXPECT_EQ(counts.losses(gps), 1);
    state.epoch.observations.signals[0].slipped = true;
    state.epoch.observations.clock_was_set = true;
    state.epoch.observations.receive_time = advanced(state.epoch.observations.receive_time, Seconds(-1e-3));
    counts.follow(state);
    EXPECT_EQ(counts.losses(gps), 2);
    EXPECT_EQ(counts.clock_jumps(), 255);
    const SbfMeasExtra extra = sbf_measurement_extra(measuring_state(), counts);
    ASSERT_EQ(extra.signals.size(), 3u);
    EXPECT_EQ(extra.signals[0].losses, 2);
    EXPECT_EQ(extra.signals[0].code_variance, 900) << "0.3 m";
    EXPECT_EQ(extra.signals[0].carrier_variance, 100) << "0.01 cycles";
    EXPECT_NEAR(static_cast<double>(extra.doppler_var_factor), 4, 1e-6);
    EXPECT_NEAR((extra.signals[0].misc & 7) * 0.03125, 0.1, 0.032) << "44.35 is 44.25 and a tenth";
}

TEST(SbfNavigation, MessagesOfSbasAreGivenAsTheyCame) {
    NavigationState state = measuring_state();
    const GpsTime end = state.epoch.fix.time;
    const SbasWords words = encode_sbas(SbasPrnMask{{1, 7, 32}, 1}, end - std::chrono::seconds(1));
    state.epoch.subframes = {{{Constellation::sbas, 36}, Signal::l1, end, 0, {words.begin(), words.end()}}};
    const auto blocks = sbf_raw_pages(SbfGeoRawL1::block_number, state);
    ASSERT_EQ(blocks.size(), 1u);
    const auto page = decode_sbf<SbfGeoRawL1>(parse_sbf(blocks[0])->body);
    ASSERT_TRUE(page);
    EXPECT_EQ(page->svid, 136);
    EXPECT_EQ(page->source, 24);
    EXPECT_TRUE(std::ranges::equal(page->words, words));
    EXPECT_TRUE(sbf_raw_pages(SbfGpsRawCa::block_number, state).empty());
}

TEST(SbfNavigation, WordsOfASubframeAreUprightWithTheirParity) {
    NavigationState state = measuring_state();
    KeplerEphemeris record;
    record.satellite = gps_measured;
    record.toe = record.toc = state.epoch.fix.time;
    record.sqrt_a = 5153.7;
    record.m0 = 1.25;
    record.iode = record.iodc = 0x55;
    const GpsTime end = state.epoch.fix.time;
    const LnavWords words = lnav_ephemeris_subframe(record, 2, end);
    Subframe subframe{gps_measured, Signal::l1, end, 0, {words.begin(), words.end()}, record};
    state.epoch.subframes = {subframe};
    EXPECT_TRUE(sbf_raw_pages(SbfGloRawCa::block_number, state).empty());
    const auto blocks = sbf_raw_pages(SbfGpsRawCa::block_number, state);
    ASSERT_EQ(blocks.size(), 1u);
    const auto page = decode_sbf<SbfGpsRawCa>(parse_sbf(blocks[0])->body);
    ASSERT_TRUE(page);
    EXPECT_EQ(page->svid, 3);
    EXPECT_EQ(page->crc_passed, 1);
    EXPECT_EQ(page->words[0] >> 22, 0x8Bu) << "the preamble";
    EXPECT_EQ(page->words[1] >> 8 & 7, 2u) << "the subframe";
    EXPECT_EQ(page->words[2] >> 22, 0x55u) << "IODE";
    EXPECT_EQ(page->time.tow, (page->words[1] >> 13 & 0x1FFFF) * 6000);

    const auto nav = decode_sbf<SbfGpsNav>(parse_sbf(sbf_record_block(subframe, state))->body);
    ASSERT_TRUE(nav);
    EXPECT_EQ(nav->iode3, 0x55);
    EXPECT_NEAR(nav->orbit.m_0, 1.25 / 3.14159265358979, 1e-12) << "semicircles";
    EXPECT_EQ(nav->orbit.toe, page->time.tow / 1000);
    EXPECT_EQ(nav->toe_week, nav->time.wnc % 1024);
}

TEST(SbfNavigation, ARecordComesAgainWhenItsHealthChanges) {
    const BoardProfile board = sample_board(NmeaVersion::v4_0, {Constellation::gps});
    NavigationState state = measuring_state();
    KeplerEphemeris record;
    record.satellite = gps_measured;
    record.toe = record.toc = state.epoch.fix.time;
    record.sqrt_a = 5153.7;
    SeptentrioState receiver;
    const auto blocks_with_health = [&](int health) {
        record.health = health;
        state.epoch.fix.time += std::chrono::seconds(30);
        state.epoch.subframes = {{gps_measured, Signal::l1, state.epoch.fix.time, 0, {}, record}};
        follow_epoch(receiver, board, state);
        return receiver.new_records.size();
    };
    EXPECT_EQ(blocks_with_health(0), 1u);
    EXPECT_EQ(blocks_with_health(0), 0u);
    EXPECT_EQ(blocks_with_health(0b111111), 1u);
    EXPECT_EQ(blocks_with_health(0b111111), 0u);
    EXPECT_EQ(blocks_with_health(0), 1u);
}

// BeiDou's week 0 began in 2006: the weeks before are counted modulo 8192, as its satellites' 13 bits do.
TEST(SbfNavigation, WeeksOfBeidouBefore2006AreCountedModulo8192) {
    NavigationState state = measuring_state();
    KeplerEphemeris record;
    record.satellite = {Constellation::beidou, 30};
    record.message = NavigationMessage::d1;
    record.toe = record.toc = gps_calendar_time(2005, 6, 1, 12, 0, 14);
    const Subframe subframe{record.satellite, Signal::b1i, record.toe, 0, {}, record};
    const auto nav = decode_sbf<SbfBdsNav>(parse_sbf(sbf_record_block(subframe, state))->body);
    ASSERT_TRUE(nav);
    EXPECT_EQ(nav->week, 8192 - 31);
    EXPECT_EQ(nav->toe_week, 8192 - 31);
    EXPECT_EQ(nav->toc_week, 8192 - 31);
}

TEST(SbfNavigation, PagesAreRowsOfBits) {
    NavigationState state = measuring_state();
    // Even and odd page of 120 bits: of the even one the last six are its tail.
    const Subframe galileo{{Constellation::galileo, 4},
                           Signal::l1,
                           state.epoch.fix.time,
                           0,
                           {0x12345678, 1, 2, 0xABCDC000, 0x80000000, 3, 4, 0xFFFFFF00},
                           {}};
    const Subframe beidou{{Constellation::beidou, 15},
                          Signal::b1i,
                          state.epoch.fix.time,
                          0,
                          {0x3FFFFFFF, 0, 0x3FFFFFFF, 0, 0, 0, 0, 0, 0, 1},
                          {}};
    state.epoch.subframes = {galileo, beidou};
    const auto page = decode_sbf<SbfGalRawInav>(parse_sbf(sbf_raw_pages(4023, state).at(0))->body);
    EXPECT_EQ(page->source, 17);
    EXPECT_EQ(page->words[0], 0x12345678u);
    EXPECT_EQ(page->words[3], 0xABCDC000u >> 14 << 14 | 0x80000000u >> 18);
    EXPECT_EQ(page->words[7], 0xFFFFFF00u << 14 & 0xFFC00000u) << "the last of 234 bits";
    const auto words = decode_sbf<SbfBdsRaw>(parse_sbf(sbf_raw_pages(4047, state).at(0))->body)->words;
    EXPECT_EQ(words[0], 0xFFFFFFFCu);
    EXPECT_EQ(words[1], 0x0000000Fu) << "the third word begins at bit 60";
    EXPECT_EQ(words[9], 1u << 20) << "300 bits";
}

TEST(SbfCartesian, IsTheGeodeticSolutionAlongOtherAxes) {
    NavigationState state = measuring_state();
    state.epoch.fix.velocity = {3, 4, -1};
    BoardProfile board = sample_board(NmeaVersion::v4_0, {Constellation::gps});
    const ReceiverConfig config;
    const SbfPvtCartesian block = sbf_pvt_cartesian({board, config, state});
    EXPECT_EQ(block.mode, 1);
    EXPECT_NEAR(std::hypot(block.x, block.y, block.z), 6366.6e3 + 500, 1e3);
    EXPECT_NEAR(std::hypot(block.vx, block.vy, block.vz), std::sqrt(26.0), 1e-5);
    const SbfPosCovCartesian turned = sbf_position_covariance_cartesian(state);
    const auto sum = [](const SbfCovariance& c) { return static_cast<double>(c[0] + c[1] + c[2]); };
    EXPECT_NEAR(sum(turned.covariance) / std::pow(state.epoch.fix.horizontal_accuracy.value(), 2) - 1,
                std::pow(state.epoch.fix.vertical_accuracy.value() / state.epoch.fix.horizontal_accuracy.value(), 2),
                1e-4);
    state.fix_ok = false;
    EXPECT_EQ(sbf_pvt_cartesian({board, config, state}).x, sbf_nothing);
    EXPECT_EQ(sbf_position_covariance_cartesian(state).covariance, no_sbf_covariance);
}

TEST(SbfCartesian, ABaseLineLeadsToTheBaseAsSeenFromTheRover) {
    NavigationState state = measuring_state();
    state.corrections.state = CorrectionState::rtk_fixed;
    state.corrections.base = to_ecef(Geodetic::degrees(47, 8.2, 600));
    state.epoch.fix.velocity = {3, -4, -1};  // north, east, down
    const SbfBaseVector line = sbf_base_vector(state).bases.at(0);
    EXPECT_GT(line.delta_east, 15000);
    EXPECT_NEAR(line.azimuth * 0.01, std::atan2(line.delta_east, line.delta_north) * 180 / std::numbers::pi, 0.006);
    EXPECT_EQ(line.vel_east, 4) << "of the base with respect to the rover";
    EXPECT_EQ(line.vel_north, -3);
    EXPECT_EQ(line.vel_up, -1);
    const SbfBaseVectorXyz cartesian = sbf_base_vector_cartesian(state).bases.at(0);
    const Eigen::Vector3d to_base = state.corrections.base->vector() - to_ecef(state.epoch.fix.position).vector();
    EXPECT_NEAR(cartesian.delta_x, to_base.x(), 1e-6);
    EXPECT_NEAR(cartesian.delta_y, to_base.y(), 1e-6);
    EXPECT_NEAR(cartesian.delta_z, to_base.z(), 1e-6);
    const float speed = std::hypot(cartesian.vel_x, cartesian.vel_y, cartesian.vel_z);
    EXPECT_NEAR(speed, std::sqrt(26), 1e-5);
    // Away from the rover's own motion.
    EXPECT_LT(static_cast<double>(cartesian.vel_z), -1.0);
}

TEST(SeptentrioModes, AllowAsMuchAsTheUserWants) {
    SeptentrioSettings settings;
    const SettingGroup* mode = nullptr;
    for (const SettingGroup& group : setting_groups())
        if (group.name == "PVTMode") mode = &group;
    using enum CorrectionState;
    EXPECT_EQ(allowed_corrections(settings, rtk_fixed), rtk_fixed);
    settings.set(*mode, {"Rover", "StandAlone+RTKFloat"});
    EXPECT_EQ(allowed_corrections(settings, rtk_fixed), rtk_float);
    EXPECT_EQ(allowed_corrections(settings, differential), none);
    settings.set(*mode, {"Rover", "RTKFixed"});
    NavigationState state = measuring_state();
    withhold_forbidden(settings, state);
    EXPECT_EQ(sbf_error(state), 8);
    state = measuring_state();
    state.epoch.fix.type = FixType::rtk_fixed;
    withhold_forbidden(settings, state);
    EXPECT_EQ(sbf_error(state), 0);
    EXPECT_FALSE(settings.set(*mode, {"Rover", "Teleport"}).error.empty());
}

}  // namespace
}  // namespace skyloop::firmware
