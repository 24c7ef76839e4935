#include "firmware/septentrio/sbf_messages.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/core/navigation_state.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

constexpr double cn0_base = 10, cn0_step = 0.25, cn0_fine_step = 0.03125;
constexpr std::int64_t nothing_of_19_bits = -(1 << 18), nothing_of_21_bits = -(1 << 20),
                       nothing_of_24_bits = -(1 << 23);

// A signal that is told.
struct SbfMeasured {
    const Observation* observation;
    std::uint8_t number;          // of the signal
    double range_m;               // at the whole millisecond
    std::optional<double> phase;  // cycles, then
};
using SbfMeasuredSignals = std::vector<SbfMeasured>;

// What the receiver's clock is past the epoch's whole millisecond, s.
double past_millisecond(const NavigationState& state) {
    const GpsTime whole = std::chrono::round<std::chrono::milliseconds>(state.epoch.fix.time);
    return difference(state.epoch.observations.receive_time, whole).value();
}

std::optional<SbfMeasured> measured_then(const Observation& o, double past) {
    const auto number = sbf_signal_number(o.satellite.constellation, o.signal);
    if (!number || !o.pseudorange || !o.doppler || !sbf_svid(o.satellite)) return std::nullopt;
    const Observation then = carried(o, Seconds(past));
    return SbfMeasured{&o, *number, then.pseudorange->value(), then.carrier_phase};
}

// By satellite, each with its first signal in front: signals come ascending by satellite.
std::vector<SbfMeasuredSignals> measured_satellites(const NavigationState& state) {
    std::vector<SbfMeasuredSignals> satellites;
    if (!state.time.time || !state.time.date) return satellites;
    const double past = past_millisecond(state);
    for (const Observation& o : state.epoch.observations.signals) {
        const auto then = measured_then(o, past);
        if (!then || sbf_channel_number(state, o.satellite) == 0) continue;
        const bool further = !satellites.empty() && satellites.back().front().observation->satellite == o.satellite;
        if (!further) satellites.emplace_back();
        SbfMeasuredSignals& signals = satellites.back();
        signals.insert(o.signal == first_signal(o.satellite.constellation) ? signals.begin() : signals.end(), *then);
    }
    return satellites;
}

// C/N0 in steps of 1/32 dB from 10 dB-Hz on.
unsigned fine_cn0(const Observation& o) {
    return static_cast<unsigned>(
        std::clamp(std::floor((o.cn0.value() - cn0_base) / cn0_fine_step), 0.0, 254 * 8.0 + 7));
}
std::uint8_t cn0_of(const Observation& o) {
    return static_cast<std::uint8_t>(fine_cn0(o) / static_cast<unsigned>(cn0_step / cn0_fine_step));
}

// Of GLONASS signals the channel.
std::uint8_t obs_info(const Observation& o) {
    const unsigned channel =
        o.satellite.constellation == Constellation::glonass ? frequency_id(o.satellite, o.signal, o.carrier) + 1u : 0u;
    const bool half_unknown = o.carrier_phase && !o.half_cycle_resolved;
    return static_cast<std::uint8_t>(channel << 3 | (half_unknown ? 1u << 2 : 0u));
}

// A number in two parts, the lower one of 16 bits; the lowest number, which means nothing, where it does not fit.
std::int64_t in_parts(double value, double step, std::int64_t nothing) {
    const double steps = std::round(value / step);
    return std::abs(steps) < static_cast<double>(-nothing) ? static_cast<std::int64_t>(steps) : nothing;
}
std::uint16_t lower_part(std::int64_t value) { return static_cast<std::uint16_t>(value & 0xFFFF); }

// Beyond the range as the block tells it.
std::int64_t phase_offset(const SbfMeasured& signal, double told_range_m) {
    if (!signal.phase) return nothing_of_24_bits;
    const double wavelength = speed_of_light / signal.observation->carrier.value();
    return in_parts(*signal.phase - told_range_m / wavelength, 0.001, nothing_of_24_bits);
}

std::uint16_t lock_seconds(const Observation& o, double most, std::uint16_t nothing) {
    return o.carrier_phase ? static_cast<std::uint16_t>(std::clamp(std::floor(o.lock_time.value()), 0.0, most))
                           : nothing;
}

SbfOtherSignal other_signal(const SbfMeasured& signal, const SbfMeasured& first, double told_first_m) {
    const Observation& o = *signal.observation;
    const std::int64_t code = in_parts(signal.range_m - told_first_m, 0.001, nothing_of_19_bits);
    const double told_m = told_first_m + static_cast<double>(code) * 0.001;
    const std::int64_t phase = code == nothing_of_19_bits ? nothing_of_24_bits : phase_offset(signal, told_m);
    const double told_first_doppler = std::round(first.observation->doppler->value() / 1e-4) * 1e-4;
    const std::int64_t doppler =
        in_parts(o.doppler->value() - told_first_doppler * o.carrier.value() / first.observation->carrier.value(), 1e-4,
                 nothing_of_21_bits);
    SbfOtherSignal other;
    other.type = signal.number;
    other.lock_time = static_cast<std::uint8_t>(lock_seconds(o, 254, 255));
    other.cn0 = cn0_of(o);
    other.offsets_msb = static_cast<std::uint8_t>((code >> 16 & 7) | (doppler >> 16 & 31) << 3);
    other.carrier_msb = static_cast<std::int8_t>(phase >> 16);
    other.obs_info = obs_info(o);
    other.code_offset_lsb = lower_part(code);
    other.carrier_lsb = lower_part(phase);
    other.doppler_offset_lsb = lower_part(doppler);
    return other;
}

SbfMeasuredSatellite measured_satellite(const SbfMeasuredSignals& signals, const NavigationState& state) {
    const SbfMeasured& first = signals.front();
    const Observation& o = *first.observation;
    constexpr double most_mm = 68719476735.0;  // 36 bits
    const auto millimetres = static_cast<std::uint64_t>(std::clamp(std::round(first.range_m * 1000), 0.0, most_mm));
    const double told_m = static_cast<double>(millimetres) * 0.001;
    const std::int64_t phase = phase_offset(first, told_m);
    SbfMeasuredSatellite satellite;
    satellite.rx_channel = sbf_channel_number(state, o.satellite);
    satellite.type = first.number;
    satellite.svid = *sbf_svid(o.satellite);
    satellite.misc = static_cast<std::uint8_t>(millimetres >> 32);
    satellite.code_lsb = static_cast<std::uint32_t>(millimetres & 0xFFFFFFFF);
    satellite.doppler.set(o.doppler->value());
    satellite.carrier_lsb = lower_part(phase);
    satellite.carrier_msb = static_cast<std::int8_t>(phase >> 16);
    satellite.cn0 = cn0_of(o);
    satellite.lock_time = lock_seconds(o, 65534, 0xFFFF);
    satellite.obs_info = obs_info(o);
    for (std::size_t i = 1; i < signals.size(); ++i)
        satellite.others.push_back(other_signal(signals[i], first, told_m));
    return satellite;
}

SbfSignalExtra signal_extra(const SbfMeasured& signal, const NavigationState& state,
                            const SbfMeasurementCounts& counts) {
    const Observation& o = *signal.observation;
    SbfSignalExtra extra;
    extra.rx_channel = sbf_channel_number(state, o.satellite);
    extra.type = signal.number;
    extra.code_variance.set(std::pow(o.pseudorange_deviation.value(), 2));
    if (o.carrier_phase) extra.carrier_variance.set(std::pow(o.carrier_phase_deviation, 2));
    extra.lock_time = lock_seconds(o, 65534, 0xFFFF);
    extra.losses = counts.losses(o);
    extra.misc = static_cast<std::uint8_t>(fine_cn0(o) % 8);
    return extra;
}

}  // namespace

void SbfMeasurementCounts::follow(const NavigationState& state) {
    const Observations& observations = state.epoch.observations;
    if (!observations.signals.empty()) {
        const double clock_ms = past_millisecond(state) * 1e3;
        if (observations.clock_was_set && clock_ms_)
            clock_jumps_ = static_cast<std::uint8_t>(clock_jumps_ + std::lround(clock_ms - *clock_ms_));
        clock_ms_ = clock_ms;
    }
    std::map<std::pair<SatelliteId, Signal>, bool> locked;
    for (const Observation& o : observations.signals)
        if (o.carrier_phase) locked[{o.satellite, o.signal}] = o.slipped;
    for (auto& [signal, phase] : phases_)
        phase.locked = phase.locked && locked.contains(signal);
    for (const auto& [signal, slipped] : locked) {
        Phase& phase = phases_[signal];
        if (!phase.locked || slipped) ++phase.losses;
        phase.locked = true;
    }
}

std::uint8_t SbfMeasurementCounts::losses(const Observation& observation) const {
    const auto found = phases_.find({observation.satellite, observation.signal});
    return found == phases_.end() ? std::uint8_t{0} : found->second.losses;
}

SbfMeasEpoch sbf_measurements(const NavigationState& state, const SbfMeasurementCounts& counts) {
    auto block = sbf_block<SbfMeasEpoch>(state);
    block.clock_jumps = counts.clock_jumps();
    for (const SbfMeasuredSignals& signals : measured_satellites(state))
        block.satellites.push_back(measured_satellite(signals, state));
    return block;
}

SbfMeasExtra sbf_measurement_extra(const NavigationState& state, const SbfMeasurementCounts& counts) {
    auto block = sbf_block<SbfMeasExtra>(state);
    double carrier = 0, doppler = 0;
    for (const SbfMeasuredSignals& signals : measured_satellites(state))
        for (const SbfMeasured& signal : signals) {
            block.signals.push_back(signal_extra(signal, state, counts));
            if (!signal.phase) continue;
            carrier += std::pow(signal.observation->carrier_phase_deviation, 2);
            doppler += std::pow(signal.observation->doppler_deviation.value(), 2);
        }
    if (carrier > 0) block.doppler_var_factor.set(doppler / carrier);
    return block;
}

SbfEndOfMeas sbf_end_of_measurements(const NavigationState& state) { return {sbf_time(state)}; }

}  // namespace skyloop::firmware
