#include "firmware/septentrio/sbf_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/geo/local_frame.hpp"
#include "firmware/core/solution_covariance.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/output_only/other_protocols.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

struct NumberedSignal {
    Constellation constellation;
    Signal signal;
    std::uint8_t number;
};
constexpr std::array numbered_signals{
    NumberedSignal{Constellation::gps, Signal::l1, 0},      NumberedSignal{Constellation::gps, Signal::l2, 3},
    NumberedSignal{Constellation::gps, Signal::l5, 4},      NumberedSignal{Constellation::qzss, Signal::l1, 6},
    NumberedSignal{Constellation::qzss, Signal::l2, 7},     NumberedSignal{Constellation::glonass, Signal::g1, 8},
    NumberedSignal{Constellation::glonass, Signal::g2, 11}, NumberedSignal{Constellation::beidou, Signal::l1, 13},
    NumberedSignal{Constellation::beidou, Signal::l5, 14},  NumberedSignal{Constellation::navic, Signal::l5, 15},
    NumberedSignal{Constellation::galileo, Signal::l1, 17}, NumberedSignal{Constellation::galileo, Signal::e6, 19},
    NumberedSignal{Constellation::galileo, Signal::l5, 20}, NumberedSignal{Constellation::galileo, Signal::e5b, 21},
    NumberedSignal{Constellation::sbas, Signal::l1, 24},    NumberedSignal{Constellation::sbas, Signal::l5, 25},
    NumberedSignal{Constellation::qzss, Signal::l5, 26},    NumberedSignal{Constellation::qzss, Signal::e6, 27},
    NumberedSignal{Constellation::beidou, Signal::b1i, 28}, NumberedSignal{Constellation::beidou, Signal::e5b, 29},
    NumberedSignal{Constellation::beidou, Signal::b3i, 30}};

std::uint32_t signal_bit(Constellation constellation, Signal signal) {
    const auto number = sbf_signal_number(constellation, signal);
    return number ? 1u << *number : 0;
}

}  // namespace

std::optional<std::uint8_t> sbf_signal_number(Constellation constellation, Signal signal) {
    for (const NumberedSignal& candidate : numbered_signals)
        if (candidate.constellation == constellation && candidate.signal == signal) return candidate.number;
    return std::nullopt;
}

std::uint32_t sbf_signal_info(const NavigationState& state) {
    std::uint32_t bits = 0;
    for (const SatelliteStatus& satellite : state.epoch.fix.satellites) {
        if (!satellite.used) continue;
        const Constellation system = satellite.id.constellation;
        std::uint32_t measured = 0;
        for (const Observation& o : state.epoch.observations.signals)
            if (o.satellite == satellite.id && o.pseudorange) measured |= signal_bit(system, o.signal);
        bits |= measured != 0 ? measured : signal_bit(system, first_signal(system));
    }
    return bits;
}

std::uint8_t sbf_channel_number(const NavigationState& state, SatelliteId satellite) {
    std::size_t number = 0;
    for (const SatelliteStatus& candidate : state.epoch.fix.satellites) {
        if (!candidate.cn0 || !sbf_svid(candidate.id) || number == most_items) continue;
        ++number;
        if (candidate.id == satellite) return static_cast<std::uint8_t>(number);
    }
    return 0;
}

std::uint8_t sbf_frequency_number(SatelliteId satellite, const Observations& observations) {
    if (satellite.constellation != Constellation::glonass) return 0;
    for (const Observation& o : observations.signals)
        if (o.satellite == satellite)
            return static_cast<std::uint8_t>(frequency_id(o.satellite, o.signal, o.carrier) + 1);
    return 0;
}

namespace {

constexpr std::uint32_t antenna_active = 1u << 1, week_set = 1u << 4, tow_set = 1u << 5, fine_time = 1u << 6,
                        corrections_come = 1u << 17;
constexpr std::uint32_t antenna_error = 1u << 5;

// The first bit of that signal in the statuses of ChannelStatus.
int sbf_status_shift(Constellation constellation) { return constellation == Constellation::galileo ? 2 : 0; }

// What PVTGeodetic and PVTCartesian both have: everything but the axes. @param accuracy of the block
template <class Block>
void put_sbf_solution(const ReportContext& context, Block& to, SbfPvtAccuracy& accuracy) {
    const NavigationState& state = context.state;
    to.mode = sbf_mode(state);
    to.error = sbf_error(state);
    if (!has_solution(state)) return;
    const Fix& fix = state.epoch.fix;
    to.undulation.set(fix.geoid_undulation.value());
    if (state.course && fix.speed.value() >= 0.1) to.course.set(state.course->deg());
    to.clock_bias = fix.clock_bias.value() / speed_of_light * 1e3;
    to.clock_drift.set(fix.clock_drift.value() / speed_of_light * 1e6);
    to.time_system = 0;
    to.datum = 0;
    to.num_sv = reported_satellites(fix);
    to.signal_info = sbf_signal_info(state);
    if (state.corrections.age) to.mean_corr_age.set(state.corrections.age->value());
    if (state.corrections.station) to.reference_id.set(*state.corrections.station);
    to.num_bases = state.corrections.state == CorrectionState::none ? 0 : 1;
    accuracy.latency.set(context.board.solution_latency.value());
    accuracy.h_accuracy.set(2 * fix.horizontal_accuracy.value());
    accuracy.v_accuracy.set(2 * fix.vertical_accuracy.value());
}

// Of east, north, up and clock the variances of north, east, up and clock, and the covariances in SBF's order.
SbfCovariance sbf_covariance(const Eigen::Matrix4d& enu_clock) {
    constexpr Eigen::Index elements[][2] = {{1, 1}, {0, 0}, {2, 2}, {3, 3}, {1, 0},
                                            {1, 2}, {1, 3}, {0, 2}, {0, 3}, {2, 3}};
    SbfCovariance covariance;
    std::transform(std::begin(elements), std::end(elements), covariance.begin(),
                   [&](const auto& at) { return static_cast<float>(enu_clock(at[0], at[1])); });
    return covariance;
}

constexpr std::array<std::size_t, 4> sbf_of_height{2, 5, 7, 9}, sbf_of_clock{3, 6, 8, 9};

void say_nothing_of(const std::array<std::size_t, 4>& elements, SbfCovariance& covariance) {
    for (const std::size_t element : elements)
        covariance[element] = static_cast<float>(sbf_nothing);
}

// @param solved there is a solution that uses satellites
SbfChannel sbf_channel(const SatelliteStatus& satellite, std::uint8_t svid, bool solved) {
    const int shift = sbf_status_shift(satellite.id.constellation);
    const auto status = [shift](unsigned value) { return static_cast<std::uint16_t>(value << shift); };
    SbfChannel channel;
    channel.svid = svid;
    // Whether it rises is not known here.
    const unsigned degrees = static_cast<unsigned>(std::lround(satellite.azimuth.deg() + 360)) % 360u;
    channel.azimuth = static_cast<std::uint16_t>(degrees | 3u << 14);
    channel.elevation.set(satellite.elevation.deg());
    channel.health_status = status(!satellite.has_ephemeris ? 0 : satellite.healthy ? 1 : 3);
    channel.tracking_status = status(3);
    channel.pvt_status = status(solved && satellite.used ? 2 : satellite.has_ephemeris ? 0 : 1);
    return channel;
}

}  // namespace

SbfPvtGeodetic sbf_pvt_geodetic(const ReportContext& context) {
    auto block = sbf_block<SbfPvtGeodetic>(context.state);
    put_sbf_solution(context, block, block.accuracy.emplace());
    if (!has_solution(context.state)) return block;
    const Fix& fix = context.state.epoch.fix;
    block.latitude = fix.position.latitude.rad();
    block.longitude = fix.position.longitude.rad();
    block.height = fix.position.height.above_ellipsoid.value();
    block.vel_north.set(fix.velocity.north);
    block.vel_east.set(fix.velocity.east);
    block.vel_up.set(-fix.velocity.down);
    return block;
}

SbfPvtCartesian sbf_pvt_cartesian(const ReportContext& context) {
    auto block = sbf_block<SbfPvtCartesian>(context.state);
    put_sbf_solution(context, block, block.accuracy);
    if (!has_solution(context.state)) return block;
    const Fix& fix = context.state.epoch.fix;
    const Eigen::Vector3d place = to_ecef(fix.position).vector();
    const Velocity<Enu> local(fix.velocity.east, fix.velocity.north, -fix.velocity.down);
    const Eigen::Vector3d speed = LocalFrame(fix.position).to_ecef(local).vector();
    block.x = place.x();
    block.y = place.y();
    block.z = place.z();
    block.vx.set(speed.x());
    block.vy.set(speed.y());
    block.vz.set(speed.z());
    return block;
}

SbfPosCovGeodetic sbf_position_covariance(const NavigationState& state) {
    SbfPosCovGeodetic block{sbf_time(state), sbf_mode(state), sbf_error(state), no_sbf_covariance};
    const Fix& fix = state.epoch.fix;
    const auto ellipse = error_ellipse(fix);
    if (!has_solution(state) || !ellipse) return block;
    block.covariance = sbf_covariance(position_covariance(fix, *ellipse));
    if (fix.type == FixType::fix_2d) say_nothing_of(sbf_of_height, block.covariance);
    return block;
}

SbfVelCovGeodetic sbf_velocity_covariance(const NavigationState& state) {
    SbfVelCovGeodetic block{sbf_time(state), sbf_mode(state), sbf_error(state), no_sbf_covariance};
    const Fix& fix = state.epoch.fix;
    const bool flat = fix.type == FixType::fix_2d;
    const double all = std::hypot(fix.dop.ndop, fix.dop.edop, flat ? 0 : fix.dop.vdop);
    if (!has_solution(state) || !(all > 0)) return block;
    const double one = fix.speed_accuracy.value() / all;
    const Eigen::Vector3d deviations = one * Eigen::Vector3d(fix.dop.edop, fix.dop.ndop, flat ? 0 : fix.dop.vdop);
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
    covariance.topLeftCorner<3, 3>() = velocity_covariance(fix, deviations.cwiseAbs2(), 0);
    block.covariance = sbf_covariance(covariance);
    // Of the drift nothing is known; nor of what stands still in two dimensions.
    say_nothing_of(sbf_of_clock, block.covariance);
    if (flat) say_nothing_of(sbf_of_height, block.covariance);
    return block;
}

SbfDop sbf_dop(const NavigationState& state) {
    auto block = sbf_block<SbfDop>(state);
    if (!has_solution(state)) return block;
    const Fix& fix = state.epoch.fix;
    block.num_sv = reported_satellites(fix);
    block.pdop.set(fix.dop.pdop);
    block.tdop.set(fix.dop.tdop);
    block.hdop.set(fix.dop.hdop);
    block.vdop.set(fix.dop.vdop);
    return block;
}

SbfAttEuler sbf_attitude(const NavigationState& state) {
    auto block = sbf_block<SbfAttEuler>(state);
    const auto attitude = pair_attitude(state);
    if (!attitude) return block;
    block.num_sv = reported_satellites(state.epoch.fix);
    block.error = 0;
    block.mode = attitude->fixed ? 2 : 1;
    block.heading.set(attitude->heading_deg);
    block.pitch.set(attitude->pitch_deg);
    return block;
}

SbfAuxAntPositions sbf_other_antenna(const NavigationState& state) {
    auto block = sbf_block<SbfAuxAntPositions>(state);
    if (!pair_attitude(state)) return block;
    const RelativePosition& relative = *state.epoch.relative;
    SbfAuxAntenna antenna;
    antenna.num_sv = reported_satellites(state.epoch.fix);
    antenna.ambiguity_type = relative.fixed ? 0 : 1;
    antenna.delta_east = relative.east_m;
    antenna.delta_north = relative.north_m;
    antenna.delta_up = -relative.down_m;
    block.antennas.push_back(antenna);
    return block;
}

SbfEndOfPvt sbf_end_of_pvt(const NavigationState& state) { return {sbf_time(state)}; }

SbfChannelStatus sbf_channel_status(const NavigationState& state) {
    auto block = sbf_block<SbfChannelStatus>(state);
    for (const SatelliteStatus& satellite : state.epoch.fix.satellites) {
        const auto svid = sbf_svid(satellite.id);
        const std::uint8_t number = sbf_channel_number(state, satellite.id);
        if (number == 0) continue;
        block.channels.push_back(sbf_channel(satellite, *svid, has_solution(state)));
        block.channels.back().freq_nr = sbf_frequency_number(satellite.id, state.epoch.observations);
        block.channels.back().rx_channel = number;
    }
    return block;
}

namespace {

// Gain and variance of the samples follow the counts of a u-blox receiver (invented): 20 to 50 dB, and 100 where the
// automatic gain keeps up.
SbfFrontEnd front_end_of(std::uint8_t id, const BandMonitor& band) {
    constexpr double least_db = 20, range_db = 30, full_count = 8191, settled = 96, per_indicator = 0.3;
    SbfFrontEnd front_end;
    front_end.id = id;
    front_end.gain = nearest<std::int8_t>(least_db + range_db * band.agc / full_count);
    front_end.sample_variance = nearest<std::uint8_t>(settled + per_indicator * band.jamming_indicator);
    return front_end;
}

}  // namespace

SbfReceiverStatus sbf_receiver_status(const NavigationState& state) {
    auto block = sbf_block<SbfReceiverStatus>(state);
    block.up_time.set(std::floor(state.since_start.value()));
    block.rx_state = (state.monitors.antenna_power == 1 ? antenna_active : 0) | (state.time.date ? week_set : 0) |
                     (state.time.time ? tow_set : 0) | (has_solution(state) ? fine_time : 0) |
                     (state.corrections.come ? corrections_come : 0);
    block.rx_error = state.monitors.antenna == AntennaStatus::short_circuit ? antenna_error : 0;
    // Codes of front ends: 0 of L1 and E1, 3 of L2 (mosaic-X5 reference guide, AGCState).
    constexpr std::uint8_t of_l1 = 0, of_l2 = 3, degrees_offset = 100;
    block.temperature = nearest<std::uint8_t>(state.monitors.temperature + degrees_offset);
    block.front_ends.push_back(front_end_of(of_l1, state.monitors.upper));
    if (state.monitors.lower.agc > 0) block.front_ends.push_back(front_end_of(of_l2, state.monitors.lower));
    return block;
}

}  // namespace skyloop::firmware
