#include "firmware/septentrio/sbf_messages.hpp"

#include <cmath>
#include <numbers>

#include "base/geo/local_frame.hpp"

namespace skyloop::firmware {
namespace {

constexpr double sbf_degrees = 180.0 / std::numbers::pi;

// From the rover to the base, in the rover's east, north and up (mosaic-X5 reference guide, BaseVectorGeod: the base
// "as seen from the rover").
struct BaseLine {
    double east = 0, north = 0, up = 0;
    bool moving = false;
};

std::optional<BaseLine> base_line(const NavigationState& state) {
    if (state.epoch.relative) {
        const RelativePosition& r = *state.epoch.relative;
        // Taken from 0, which stays without a sign.
        return BaseLine{0 - r.east_m, 0 - r.north_m, r.down_m, r.base_moves};
    }
    if (!state.corrections.base || state.corrections.state == CorrectionState::none) return std::nullopt;
    const Position<Enu> base = LocalFrame(state.epoch.fix.position).to_enu(*state.corrections.base);
    return BaseLine{base.vector().x(), base.vector().y(), base.vector().z(), false};
}

// Modes of a moving base are 3 more than those of one that stands (7 fixed, 8 float).
std::uint8_t base_mode(const NavigationState& state, bool moving) {
    constexpr std::uint8_t fixed = 4, floating = 5, to_moving = 3;
    if (!moving) return sbf_mode(state);
    return static_cast<std::uint8_t>((state.epoch.relative->fixed ? fixed : floating) + to_moving);
}

SbfIndicator indicator(unsigned type, double value) {
    const auto grade = static_cast<unsigned>(std::lround(std::clamp(value, 0.0, 10.0)));
    return {static_cast<std::uint16_t>(type | grade << 8)};
}

// 10 with twelve satellites of 45 dB-Hz on the average.
double quality_of_signals(const Fix& fix) {
    constexpr double least_cn0 = 25, best_cn0 = 45, best_count = 12;
    double sum = 0;
    int count = 0;
    for (const SatelliteStatus& s : fix.satellites)
        if (s.used && s.cn0) {
            sum += s.cn0->value();
            ++count;
        }
    if (count == 0) return 0;
    const double strength = (sum / count - least_cn0) / (best_cn0 - least_cn0);
    return 10 * std::clamp(strength, 0.0, 1.0) * std::min(1.0, count / best_count);
}

SbfRfBand disturbed_band(double frequency_hz, const BandMonitor& band) {
    constexpr int critical = 3;
    constexpr std::uint8_t mitigated = 2, interference = 8;
    // Its width is not known here; a continuous wave's is what the receiver resolves.
    constexpr std::uint16_t width_khz = 1000;
    return {static_cast<std::uint32_t>(frequency_hz), width_khz,
            band.jamming_state >= critical ? interference : mitigated, 0};
}

}  // namespace

SbfAttCovEuler sbf_attitude_covariance(const NavigationState& state) {
    auto block = sbf_block<SbfAttCovEuler>(state);
    if (!pair_attitude(state)) return block;
    const RelativePosition& r = *state.epoch.relative;
    const auto square_deg = [&](Metres sigma, double length) {
        return static_cast<float>(std::pow(sigma.value() / length * sbf_degrees, 2));
    };
    block.error = 0;
    block.heading = square_deg(r.deviation, std::hypot(r.north_m, r.east_m));
    block.pitch = square_deg(r.down_deviation, std::hypot(r.north_m, r.east_m, r.down_m));
    block.heading_pitch = 0;
    return block;
}

SbfBaseVectorGeod sbf_base_vector(const NavigationState& state) {
    auto block = sbf_block<SbfBaseVectorGeod>(state);
    if (!has_solution(state)) return block;
    const auto line = base_line(state);
    if (!line) return block;
    SbfBaseVector base;
    base.num_sv = reported_satellites(state.epoch.fix);
    base.mode = base_mode(state, line->moving);
    base.delta_east = line->east;
    base.delta_north = line->north;
    base.delta_up = line->up;
    const VelocityNed& v = state.epoch.fix.velocity;
    if (!line->moving) {
        base.vel_east.set(0 - v.east);
        base.vel_north.set(0 - v.north);
        base.vel_up.set(v.down);
    }
    const double horizontal = std::hypot(line->east, line->north);
    const double azimuth = std::atan2(line->east, line->north) * sbf_degrees;
    base.azimuth = static_cast<std::uint16_t>(std::lround((azimuth < 0 ? azimuth + 360 : azimuth) * 100) % 36000);
    base.elevation.set(std::atan2(line->up, horizontal) * sbf_degrees);
    if (state.corrections.station) base.reference_id.set(*state.corrections.station);
    if (state.corrections.age) base.corr_age.set(state.corrections.age->value());
    base.signal_info = sbf_signal_info(state);
    block.bases.push_back(base);
    return block;
}

SbfEndOfAtt sbf_end_of_attitude(const NavigationState& state) { return {sbf_time(state)}; }

SbfQualityInd sbf_quality(const NavigationState& state) {
    constexpr unsigned overall = 0, signals = 1, radio = 11, processor = 21, base_station = 30;
    constexpr double head_room = 8, fresh_s = 1, stale_s = 20;
    auto block = sbf_block<SbfQualityInd>(state);
    const double of_signals = quality_of_signals(state.epoch.fix);
    const double of_radio = state.monitors.jamming_state() >= 2 ? 10 - 3.5 * state.monitors.jamming_state() : 10;
    block.indicators = {indicator(overall, has_solution(state) ? std::min(of_signals, of_radio) : 0),
                        indicator(signals, of_signals), indicator(radio, of_radio), indicator(processor, head_room)};
    if (state.corrections.age)
        block.indicators.push_back(
            indicator(base_station, 10 * (stale_s - state.corrections.age->value()) / (stale_s - fresh_s)));
    return block;
}

SbfRfStatus sbf_radio_status(const NavigationState& state) {
    constexpr int noticed = 2;
    auto block = sbf_block<SbfRfStatus>(state);
    block.flags = state.monitors.spoofing >= SpoofingIndication::indicated ? 1 : 0;
    constexpr double l1 = 1575.42e6, l2 = 1227.60e6;
    if (state.monitors.upper.jamming_state >= noticed) block.bands.push_back(disturbed_band(l1, state.monitors.upper));
    if (state.monitors.lower.jamming_state >= noticed) block.bands.push_back(disturbed_band(l2, state.monitors.lower));
    return block;
}

SbfGalAuthStatus sbf_authentication(const NavigationState& state) { return sbf_block<SbfGalAuthStatus>(state); }

SbfReceiverTime sbf_receiver_time(const NavigationState& state) {
    auto block = sbf_block<SbfReceiverTime>(state);
    block.sync_level = static_cast<std::uint8_t>((state.time.date ? 1 : 0) | (state.time.time ? 2 : 0) |
                                                 (has_solution(state) ? 4 : 0));
    if (!state.time.date || !state.time.time) return block;
    const UtcTime utc = reported_utc(state);
    block.year = static_cast<std::int8_t>(utc.year % 100);
    block.month = static_cast<std::int8_t>(utc.month);
    block.day = static_cast<std::int8_t>(utc.day);
    block.hour = static_cast<std::int8_t>(utc.hour);
    block.minute = static_cast<std::int8_t>(utc.minute);
    block.second = static_cast<std::int8_t>(utc.second);
    block.leap_seconds =
        static_cast<std::int8_t>(reported_leap_seconds(state).offset(to_gps_time(gps_stamp(state.epoch.fix.time))));
    return block;
}

}  // namespace skyloop::firmware
