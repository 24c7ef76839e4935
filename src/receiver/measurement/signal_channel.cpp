#include "detail/signal_channel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "receiver/measurement/tracking_jitter.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr double seconds_per_hour = 3600;

double first_to_own_frequency(const ChannelInput& input) {
    return input.arrival.signals.front().carrier.value() / input.signal.carrier.value();
}

std::optional<DbHz> arriving_cn0(const ChannelInput& input, Decibels by_echoes) {
    const Arrival& arrival = input.arrival;
    if (arrival.paths == 0 || !input.signal.arrives || !arrival.cn0 || !std::isfinite(arrival.cn0->value()))
        return std::nullopt;
    return DbHz(arrival.cn0->value() + input.signal.relative_power.value() + by_echoes.value());
}

// What may jump of a carrier's path, and how fast it changes when it does not.
Metres added_path(const Arrival& arrival) {
    return arrival.excess_path + arrival.signal_in_space_error - arrival.earlier_records.range + arrival.false_range -
           arrival.false_iono_delay;
}
MetresPerSecond added_rate(const Arrival& arrival) {
    return arrival.excess_rate + arrival.range_rate_error - arrival.earlier_records.range_rate +
           arrival.false_range_rate - arrival.false_iono_rate;
}

// Not std::hypot(): these numbers are far from overflow, and it is called for every signal.
double root_of_squares(double a, double b) { return std::sqrt(a * a + b * b); }

// What a receiver says of its ranges.
Metres known_deviation(const MeasurementParameters& p, Metres code, DbHz cn0) {
    const Metres floor = p.range_deviation_floor.value_or(p.multipath_model.floor * p.multipath_share);
    const double strong = root_of_squares(code.value(), floor.value());
    if (p.range_deviation_weak == Metres(0)) return Metres(strong);
    return Metres(root_of_squares(strong, p.range_deviation_weak.value() * std::pow(10, (30 - cn0.value()) / 10)));
}

DbHz reported_cn0(DbHz cn0, Decibels resolution) {
    // Of RTCM's six bits (10403.3, DF403), where receivers' own estimates end, too; what has gone all of a sudden is
    // tracked for a moment yet.
    constexpr double lowest = 0, highest = 63;
    const double value = std::clamp(cn0.value(), lowest, highest);
    if (!(resolution.value() > 0)) return DbHz(value);
    return DbHz(std::round(value / resolution.value()) * resolution.value());
}

int glonass_channel_of(const SignalArrival& signal) {
    const double base = carrier_frequency(signal.signal).value();
    const double step = carrier_frequency(signal.signal, 1).value() - base;
    return static_cast<int>(std::lround((signal.carrier.value() - base) / step));
}

struct ChannelBias {
    Metres code, phase;
};
ChannelBias receiver_bias(const MeasurementParameters& p, SatelliteId satellite, const SignalArrival& signal) {
    const double factor = p.receiver_biases.factor();
    ChannelBias bias{factor * p.biases.systems.at(static_cast<std::size_t>(satellite.constellation)), Metres(0)};
    if (satellite.constellation != Constellation::glonass) return bias;
    const double channel = factor * glonass_channel_of(signal);
    return {bias.code + channel * p.biases.glonass_channel_code, channel * p.biases.glonass_channel_phase};
}

double multipath_deviation(const StatisticalMultipath& model, Angle elevation) {
    return model.floor.value() + model.at_horizon.value() * low_share(elevation);
}

}  // namespace

SignalChannel::SignalChannel(const MeasurementParameters& parameters, std::uint64_t seed, SatelliteId satellite,
                             Signal signal)
    : satellite_(satellite),
      signal_(signal),
      traits_(signal_traits(satellite.constellation, signal)),
      code_loop_(code_loop_for(parameters.code_loop, traits_)),
      lock_(traits_.pilot, RandomStream(seed, signal_stream_name("acquisition", satellite, signal))),
      count_(RandomStream(seed, signal_stream_name("ambiguity", satellite, signal)),
             parameters.cycle_slips.stream(seed, signal_stream_name("cycle_slips", satellite, signal))),
      processes_(parameters, seed, satellite, signal),
      fading_(parameters, seed, satellite, signal) {
    terms_.satellite = satellite;
    terms_.signal = signal;
}

void SignalChannel::hear_echoes(const ChannelInput& input, const ChannelEpoch& epoch) {
    const MeasurementParameters& parameters = epoch.parameters;
    const double factor = parameters.multipath.factor();
    echoes_ = {};
    if (input.arrival.echoes.empty() || factor == 0) return;
    echoes_ = correlator_multipath(input.arrival.echoes,
                                   {code_loop_, parameters.phase_loop, input.signal.carrier, traits_.boc});
    echoes_.code = echoes_.code * factor;
    echoes_.phase = echoes_.phase * factor;
    echoes_.strength = echoes_.strength * factor;
}

void SignalChannel::track(const ChannelInput& input, const ChannelEpoch& epoch) {
    visited_ = epoch.now;
    hear_echoes(input, epoch);
    const SignalScintillation scintillation = scintillation_at(
        {input.arrival.amplitude_scintillation, input.arrival.phase_scintillation}, first_to_own_frequency(input));
    faded_ = fading_.at(scintillation.amplitude, epoch.now, epoch.parameters);
    const std::optional<DbHz> cn0 = arriving_cn0(input, echoes_.strength + faded_);
    const bool had_phase = lock_.phase_locked();
    lock_.advance(epoch.parameters.acquisition,
                  {cn0, input.aided ? StartKind::hot : epoch.knowledge, input.searchable,
                   scintillation.amplitude < strongest_scintillation},
                  epoch.now);
    if (!lock_.code_locked()) return;
    // The formulas for a signal that fades want its mean.
    const DbHz mean_cn0 = *cn0 - DbHz(faded_.value());
    deviations_ = loop_deviations(epoch.parameters,
                                  {code_loop_, traits_.jitter_ratio, input.signal.carrier, lock_.phase_locked(),
                                   lock_.code_locked_for(epoch.now), aided_for(mean_cn0, epoch)},
                                  mean_cn0, scintillation);
    draw_errors(input, epoch);
    follow_cycles(input, epoch, had_phase);
}

Seconds SignalChannel::aided_for(DbHz cn0, const ChannelEpoch& epoch) {
    if (cn0 < epoch.parameters.aiding_threshold) unaided_at_ = epoch.now;
    return difference(epoch.now, unaided_at_);
}

void SignalChannel::miss(const ChannelEpoch& epoch) { lock_.advance(epoch.parameters.acquisition, {}, epoch.now); }

void SignalChannel::forget() {
    lock_.forget();
    ever_counted_ = false;
}

void SignalChannel::draw_errors(const ChannelInput& input, const ChannelEpoch& epoch) {
    const Seconds passed = new_ ? Seconds(0) : difference(epoch.now, processed_);
    const MeasurementParameters& parameters = epoch.parameters;
    const bool aided = unaided_at_ < epoch.now;
    const Hertz code_bandwidth = aided ? code_loop_.bandwidth : parameters.unaided_bandwidth;
    processes_.code.advance(epoch.now, memory_of(code_bandwidth), passed);
    processes_.multipath.advance(
        epoch.now, multipath_memory(parameters.multipath_model, input.arrival.direction.elevation, epoch.moving),
        passed);
    if (!new_)
        processes_.advance(passed == epoch.since_last ? epoch.steps : noise_steps(parameters, passed),
                           deviations_.scintillation.rad() > 0);
    new_ = false;
    processed_ = epoch.now;

    const double metres_per_radian = speed_of_light / input.signal.carrier.value() / (2 * std::numbers::pi);
    terms_.code_noise = deviations_.code * (parameters.code_noise.factor() * processes_.code.value());
    const double thermal = parameters.phase_noise.factor() * deviations_.phase.rad() * processes_.phase.value();
    // A term of its own: its scale is in the deviation that arrives.
    const double scintillating = deviations_.scintillation.rad() * processes_.scintillation.value();
    terms_.phase_noise = Metres(metres_per_radian * (thermal + scintillating));
    terms_.doppler_noise = deviations_.frequency * (parameters.doppler_noise.factor() * processes_.frequency.value());
    if (input.arrival.echoes_known) {
        // Without the line of sight the detour of the ray that is tracked is the error (MODELS.md 7.10): echoes that
        // equal it make what the formulas of a dominant ray do not hold for.
        terms_.multipath = input.arrival.line_of_sight ? echoes_.code : Metres(0);
        terms_.phase_multipath = echoes_.phase;
        return;
    }
    // Without the line of sight the excess path is the error, and the scene has told it.
    const double multipath =
        input.arrival.line_of_sight ? parameters.multipath.factor() * parameters.multipath_share : 0;
    const double smooth =
        processes_.smooth_multipath.follow(processes_.multipath.value(), passed, parameters.multipath_smoothing);
    terms_.multipath =
        Metres(multipath * smooth * multipath_deviation(parameters.multipath_model, input.arrival.direction.elevation));
    terms_.phase_multipath = parameters.multipath_model.phase_ratio * terms_.multipath;
    // Surroundings without a scene add theirs.
    if (input.arrival.line_of_sight) terms_.multipath += echoes_.code;
    terms_.phase_multipath += echoes_.phase;
}

// The count of cycles does not survive when another ray is tracked, nor when echoes that outdo it turn the phase over,
// nor when the satellite's orbit, its clock, a false signal or a storm of the ionosphere jumps.
bool SignalChannel::path_changed(const ChannelInput& input, const ChannelEpoch& epoch) const {
    const Arrival& arrival = input.arrival;
    if (arrival.line_of_sight != line_of_sight_) return true;
    const std::optional<GpsTime>& jumped = arrival.earlier_records.jumped;
    if (jumped && difference(epoch.now, *jumped) < epoch.since_last) return true;
    const double steady = added_rate(arrival).value() * epoch.since_last.value();
    const double jump = (added_path(arrival) - added_path_).value() - steady;
    constexpr double beyond_any_motion = 0.5;  // m: what the rate leaves of a ray's change in an epoch
    if (std::abs(jump) > beyond_any_motion + 0.1 * std::abs(steady)) return true;
    if (!arrival.echoes_known && arrival.echoes.empty()) return false;
    const Metres half_wave(speed_of_light / input.signal.carrier.value() / 2);
    return std::abs((terms_.phase_multipath - phase_multipath_).value()) > half_wave.value();
}

void SignalChannel::follow_cycles(const ChannelInput& input, const ChannelEpoch& epoch, bool had_phase) {
    slipped_ = false;
    if (!lock_.phase_locked()) return;
    const MeasurementParameters& parameters = epoch.parameters;
    const double factor = parameters.cycle_slips.factor();
    const bool another_ray = path_changed(input, epoch);
    line_of_sight_ = input.arrival.line_of_sight;
    added_path_ = added_path(input.arrival);
    phase_multipath_ = terms_.phase_multipath;
    if (!had_phase) {
        count_.start(factor > 0 && !lock_.half_cycle_resolved());
        half_cycle_resolved_ = lock_.half_cycle_resolved();
        counting_since_ = epoch.now;
        slipped_ = ever_counted_;
        ever_counted_ = true;
        return;
    }
    slipped_ = another_ray;
    if (factor > 0) {
        const double rate = parameters.slips_per_hour / seconds_per_hour +
                            slips_per_second(parameters.phase_loop, deviations_.total_phase());
        if (count_.slip(factor * rate * epoch.since_last.value(), half_cycle_resolved_)) slipped_ = true;
    }
    if (lock_.half_cycle_resolved() && !half_cycle_resolved_ && count_.resolve_half_cycle()) slipped_ = true;
    half_cycle_resolved_ = lock_.half_cycle_resolved();
    if (slipped_) counting_since_ = epoch.now;
}

Observation SignalChannel::observation(const ChannelInput& input, const ChannelEpoch& epoch) const {
    const Arrival& arrival = input.arrival;
    const MeasurementParameters& parameters = epoch.parameters;
    const double carrier = input.signal.carrier.value(), wavelength = speed_of_light / carrier;
    const double ratio = first_to_own_frequency(input);
    const double iono = arrival.iono_delay.value() * ratio * ratio;
    const double path = arrival.range.value() + epoch.clock_bias.value() - speed_of_light * arrival.clock_bias.value() +
                        arrival.signal_in_space_error.value() + arrival.tropo_delay.value() +
                        arrival.excess_path.value() + arrival.false_range.value() + arrival.solid_tide.value() +
                        input.signal.satellite_antenna.value() + input.signal.receiver_antenna.value();
    const double path_rate = arrival.range_rate.value() + arrival.range_rate_error.value() +
                             arrival.excess_rate.value() + arrival.false_range_rate.value() -
                             arrival.false_iono_rate.value() * ratio * ratio + epoch.clock_drift.value() -
                             speed_of_light * arrival.clock_drift;
    Observation result;
    result.satellite = satellite_;
    result.signal = signal_;
    result.carrier = input.signal.carrier;
    result.cn0 = reported_cn0(*arriving_cn0(input, echoes_.strength + faded_ + parameters.cn0_offset),
                              parameters.cn0_resolution);
    const ChannelBias bias = receiver_bias(parameters, satellite_, input.signal);
    result.pseudorange = Metres(path + speed_of_light * input.signal.group_delay.value() + iono +
                                terms_.multipath.value() + terms_.code_noise.value() + bias.code.value());
    result.pseudorange_deviation = known_deviation(parameters, deviations_.code, result.cn0);
    result.doppler = Hertz(-path_rate / wavelength + terms_.doppler_noise.value());
    result.doppler_deviation = deviations_.frequency;
    result.half_cycle_resolved = lock_.half_cycle_resolved();
    result.called_unhealthy = arrival.called_unhealthy;
    if (arrival.echoes_known) result.correlation_distortion = std::abs(echoes_.distortion);
    if (!lock_.phase_locked()) return result;
    const double carrier_path =
        path - iono + bias.phase.value() + terms_.phase_multipath.value() + terms_.phase_noise.value();
    result.carrier_phase = carrier_path / wavelength + arrival.wind_up + count_.cycles();
    // What the loop itself sees: multipath does not shake it.
    result.carrier_phase_deviation = deviations_.total_phase().rad() / (2 * std::numbers::pi);
    result.slipped = slipped_;
    result.lock_time = difference(epoch.now, counting_since_);
    return result;
}

}  // namespace skyloop::inline receiver
