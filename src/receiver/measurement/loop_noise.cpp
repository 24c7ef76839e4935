#include "detail/loop_noise.hpp"

#include <algorithm>
#include <cmath>

#include "detail/signal_traits.hpp"
#include "receiver/measurement/scintillation.hpp"

namespace skyloop {
namespace {

constexpr double strongest_tracked_s4 = 0.7;

Seconds memory_of(Hertz bandwidth) { return Seconds(bandwidth.value() > 0 ? 1 / (4 * bandwidth.value()) : 0); }

}  // namespace

NoiseSteps noise_steps(const MeasurementParameters& parameters, Seconds dt, bool moving) {
    const auto unit = [dt](Seconds correlation_time) { return gauss_markov_step({1, correlation_time}, dt); };
    const StatisticalMultipath& multipath = parameters.multipath_model;
    return {unit(memory_of(parameters.code_loop.bandwidth)), unit(memory_of(parameters.phase_loop.bandwidth)),
            unit(memory_of(parameters.frequency_loop.bandwidth)),
            unit(moving ? multipath.moving_time : multipath.static_time), unit(parameters.scintillation_time)};
}

SignalProcesses::SignalProcesses(const MeasurementParameters& parameters, std::uint64_t seed, SatelliteId satellite,
                                 Signal signal)
    : code(parameters.code_noise.stream(seed, signal_stream_name("code_noise", satellite, signal))),
      phase(parameters.phase_noise.stream(seed, signal_stream_name("phase_noise", satellite, signal))),
      frequency(parameters.doppler_noise.stream(seed, signal_stream_name("doppler_noise", satellite, signal))),
      multipath(parameters.multipath.stream(seed, signal_stream_name("multipath", satellite, signal))),
      scintillation(
          parameters.scintillation.stream(seed, signal_stream_name("phase_scintillation", satellite, signal))) {}

void SignalProcesses::advance(const NoiseSteps& steps, bool scintillates) {
    code.advance(steps.code);
    phase.advance(steps.phase);
    frequency.advance(steps.frequency);
    multipath.advance(steps.multipath);
    if (scintillates) scintillation.advance(steps.scintillation);
}

AmplitudeFading::AmplitudeFading(const MeasurementParameters& parameters, std::uint64_t seed, SatelliteId satellite,
                                 Signal signal)
    : in_phase_(parameters.scintillation.stream(seed, signal_stream_name("fading.in_phase", satellite, signal))),
      quadrature_(parameters.scintillation.stream(seed, signal_stream_name("fading.quadrature", satellite, signal))) {}

Decibels AmplitudeFading::at(double s4, GpsTime now, const MeasurementParameters& parameters) {
    if (!(s4 > 0)) return Decibels(0);
    constexpr double deepest = 1e-4;  // 40 dB, where nothing is tracked any more
    if (moved_ && *moved_ < now) {
        const GaussMarkovStep step = gauss_markov_step({1, parameters.scintillation_time}, difference(now, *moved_));
        in_phase_.advance(step);
        quadrature_.advance(step);
    }
    moved_ = now;
    return Decibels(10 *
                    std::log10(std::max(deepest, scintillating_power(s4, in_phase_.value(), quadrature_.value()))));
}

SignalScintillation scintillation_at(const SignalScintillation& first, double frequency_ratio) {
    if (frequency_ratio == 1) return first;
    return {first.amplitude * frequency_ratio * std::sqrt(frequency_ratio), first.phase * frequency_ratio};
}

Angle LoopDeviations::total_phase() const {
    return Angle::radians(std::sqrt(phase.rad() * phase.rad() + scintillation.rad() * scintillation.rad()));
}

LoopDeviations loop_deviations(const MeasurementParameters& parameters, const CodeLoop& code_loop, double jitter_ratio,
                               DbHz cn0, const SignalScintillation& scintillation) {
    // Near the threshold a frequency loop is twice as noisy in power.
    const double threshold_factor = cn0 >= parameters.acquisition.phase_threshold ? 1 : 2;
    const CarrierToNoise power(cn0);
    LoopDeviations result{code_jitter(code_loop, power) * jitter_ratio, phase_jitter(parameters.phase_loop, power),
                          scintillation.phase, frequency_jitter(parameters.frequency_loop, power, threshold_factor)};
    if (!(scintillation.amplitude > 0)) return result;
    const double s4 = std::min(scintillation.amplitude, strongest_tracked_s4);
    // The published formula has no front end: only its growth with S4 is taken.
    result.code = result.code * (scintillating_code_jitter_chips(code_loop, power, s4) /
                                 scintillating_code_jitter_chips(code_loop, power, 0));
    result.phase = scintillating_phase_jitter(parameters.phase_loop, power, s4);
    return result;
}

}  // namespace skyloop
