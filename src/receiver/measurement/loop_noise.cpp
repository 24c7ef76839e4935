#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detail/loop_noise.hpp"
#include "receiver/measurement/tracking_jitter.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr double boc_jitter_ratio = 0.6;

// To 1.023 Mchip/s, in the order of Signal.
constexpr std::array<double, signal_names.size()> chip_rate_ratios{
    1, 1, 10, 10, 5, 2, 10, 0.511 / 1.023, 0.511 / 1.023};

}  // namespace

SignalTraits signal_traits(Constellation constellation, Signal signal) {
    SignalTraits traits{chip_rate_ratios.at(static_cast<std::size_t>(signal)), 1, false, false};
    const bool galileo = constellation == Constellation::galileo;
    traits.boc = galileo && signal == Signal::l1;
    if (traits.boc) traits.jitter_ratio = boc_jitter_ratio;
    const bool navic = constellation == Constellation::navic;
    traits.pilot = galileo || signal == Signal::l2 || (signal == Signal::l5 && !navic);
    if (navic) traits.chip_rate_ratio = 1;  // SPS: BPSK(1) on L5 (IRNSS SIS ICD 1.1)
    if (constellation == Constellation::beidou && signal == Signal::e5b) traits.chip_rate_ratio = 2;  // B2I
    return traits;
}

CodeLoop code_loop_for(const CodeLoop& loop, const SignalTraits& traits) {
    CodeLoop result = loop;
    result.chip_rate = loop.chip_rate * traits.chip_rate_ratio;
    if (traits.chip_rate_ratio > 1)
        result.front_end_bandwidth = std::max(loop.front_end_bandwidth, result.chip_rate * 2);
    return result;
}

std::string signal_stream_name(std::string_view process, SatelliteId satellite, Signal signal) {
    std::string name(process);
    name += '.';
    name += to_string(satellite);
    name += '.';
    name += signal_names.at(static_cast<std::size_t>(signal));
    return name;
}

namespace {

constexpr double strongest_tracked_s4 = 0.7;
constexpr Seconds least_memory_of_slow{2};

}  // namespace

Seconds memory_of(Hertz bandwidth) { return Seconds(bandwidth.value() > 0 ? 1 / (4 * bandwidth.value()) : 0); }

NoiseSteps noise_steps(const MeasurementParameters& parameters, Seconds dt) {
    const auto unit = [dt](Seconds correlation_time) { return gauss_markov_step({1, correlation_time}, dt); };
    const Seconds window = parameters.doppler_window;
    return {unit(memory_of(parameters.phase_loop.bandwidth)),
            unit(window > Seconds(0) ? window * 0.5 : memory_of(parameters.frequency_loop.bandwidth)),
            unit(parameters.scintillation_time)};
}

double low_share(Angle elevation) {
    constexpr double fall = 10;  // degrees of elevation over which m1 falls to 1/e
    return std::exp(-elevation.deg() / fall);
}

Seconds multipath_memory(const StatisticalMultipath& model, Angle elevation, bool moving) {
    return moving ? model.moving_time : model.static_time + model.horizon_time * low_share(elevation);
}

SlowProcess::SlowProcess(Seconds shortest, RandomStream stream) : fast_(stream), value_(fast_.value()) {
    // The knots lie a tenth of the memory apart, or a second: that is close enough for a smooth path.
    constexpr Seconds whole_second{10};
    if (shortest >= least_memory_of_slow)
        slow_.emplace(GaussMarkovParameters{1, std::max(shortest, whole_second)}, std::chrono::seconds(1), stream);
}

void SlowProcess::advance(GpsTime now, Seconds memory, Seconds dt) {
    if (slow_) {
        slow_->set_correlation_time(memory);
        value_ = slow_->at(now);
    } else if (dt > Seconds(0)) {
        fast_.advance(gauss_markov_step({1, memory}, dt));
        value_ = fast_.value();
    }
}

double Smoothed::follow(double now, Seconds dt, Seconds memory) {
    const double before = before_;
    before_ = now;
    if (!started_ || !(memory > Seconds(0)) || !(dt > Seconds(0))) {
        if (!started_ || !(memory > Seconds(0))) value_ = now;
        started_ = true;
        return value_;
    }
    const double forgotten = -std::expm1(-dt.value() / memory.value());
    value_ += forgotten * (before - value_) + (1 - forgotten * memory.value() / dt.value()) * (now - before);
    return value_;
}

SignalProcesses::SignalProcesses(const MeasurementParameters& parameters, std::uint64_t seed, SatelliteId satellite,
                                 Signal signal)
    : code(memory_of(parameters.code_loop.bandwidth),
           parameters.code_noise.stream(seed, signal_stream_name("code_noise", satellite, signal))),
      multipath(std::min(parameters.multipath_model.static_time, parameters.multipath_model.moving_time),
                parameters.multipath.stream(seed, signal_stream_name("multipath", satellite, signal))),
      phase(parameters.phase_noise.stream(seed, signal_stream_name("phase_noise", satellite, signal))),
      frequency(parameters.doppler_noise.stream(seed, signal_stream_name("doppler_noise", satellite, signal))),
      scintillation(
          parameters.scintillation.stream(seed, signal_stream_name("phase_scintillation", satellite, signal))) {}

void SignalProcesses::advance(const NoiseSteps& steps, bool scintillates) {
    phase.advance(steps.phase);
    frequency.advance(steps.frequency);
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

namespace {

// Of the phase over a window, and beside it what the oscillator itself does to each of two readings.
Hertz doppler_jitter(Angle phase, Seconds window, Hertz carrier) {
    constexpr double oscillator_mps = 0.003;
    const double own = oscillator_mps * carrier.value() / speed_of_light;
    const double thermal = std::numbers::sqrt2 * phase.rad() / (2 * std::numbers::pi * window.value());
    return Hertz(std::sqrt(thermal * thermal + own * own));
}

// Wide enough to follow what the code loop has had time to average.
Hertz acting_bandwidth(Hertz settled, const MeasurementParameters& parameters, const TrackedSignal& signal) {
    constexpr Seconds shortest{0.5};
    const Seconds averaged =
        std::min(signal.code_locked + shortest, signal.aided + memory_of(parameters.unaided_bandwidth));
    return std::max(settled, Hertz(1 / (4 * averaged.value())));
}

}  // namespace

LoopDeviations loop_deviations(const MeasurementParameters& parameters, const TrackedSignal& signal, DbHz cn0,
                               const SignalScintillation& scintillation) {
    // Near the threshold a frequency loop is twice as noisy in power.
    const double threshold_factor = cn0 >= parameters.acquisition.phase_threshold ? 1 : 2;
    const CarrierToNoise power(cn0);
    CodeLoop code_loop = signal.code_loop;
    code_loop.bandwidth = acting_bandwidth(code_loop.bandwidth, parameters, signal);
    LoopDeviations result{code_jitter(code_loop, power) * signal.jitter_ratio,
                          phase_jitter(parameters.phase_loop, power), scintillation.phase,
                          frequency_jitter(parameters.frequency_loop, power, threshold_factor)};
    if (scintillation.amplitude > 0) {
        const double s4 = std::min(scintillation.amplitude, strongest_tracked_s4);
        // The published formula has no front end: only its growth with S4 is taken.
        result.code = result.code * (scintillating_code_jitter_chips(code_loop, power, s4) /
                                     scintillating_code_jitter_chips(code_loop, power, 0));
        result.phase = scintillating_phase_jitter(parameters.phase_loop, power, s4);
    }
    if (signal.phase_locked && parameters.doppler_window > Seconds(0))
        result.frequency = doppler_jitter(result.total_phase(), parameters.doppler_window, signal.carrier);
    return result;
}

}  // namespace skyloop::inline receiver
