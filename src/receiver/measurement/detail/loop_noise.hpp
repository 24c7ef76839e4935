/// The errors of one signal's tracking loops, and how large they are.
#pragma once

#include <cstdint>
#include <optional>

#include "base/core/gauss_markov.hpp"
#include "base/core/random.hpp"
#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "receiver/measurement/measurement_parameters.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop {

/// How far each process of a signal goes in one step of time.
struct NoiseSteps {
    GaussMarkovStep code, phase, frequency, multipath, scintillation;
};

/// For processes of unit deviation. A loop of bandwidth B remembers its noise for 1/(4B): the equivalent rectangular
/// bandwidth of a first-order process is 1/(4τ). @param moving faster than 1 m/s
NoiseSteps noise_steps(const MeasurementParameters& parameters, Seconds dt, bool moving);

/// A Gauss-Markov process of unit deviation that is told its steps; the deviation may follow the signal.
class UnitProcess {
public:
    explicit UnitProcess(RandomStream stream) : stream_(stream), value_(stream_.normal()) {}
    void advance(const GaussMarkovStep& step) { value_ = step.phi * value_ + step.noise * stream_.normal(); }
    [[nodiscard]] double value() const { return value_; }

private:
    RandomStream stream_;
    double value_;
};

/// The processes of one signal, each with a stream of its own.
struct SignalProcesses {
    SignalProcesses(const MeasurementParameters& parameters, std::uint64_t seed, SatelliteId satellite, Signal signal);
    /// @param scintillates the phase does: without, its process rests
    void advance(const NoiseSteps& steps, bool scintillates);

    UnitProcess code, phase, frequency, multipath, scintillation;
};

/// How the power of a signal comes and goes while the ionosphere scintillates.
///
/// State: the scattered part of the signal, which rests while nothing scintillates.
class AmplitudeFading {
public:
    AmplitudeFading(const MeasurementParameters& parameters, std::uint64_t seed, SatelliteId satellite, Signal signal);
    /// @param s4 of this signal @return its power over the mean. Times never go back
    Decibels at(double s4, GpsTime now, const MeasurementParameters& parameters);

private:
    UnitProcess in_phase_, quadrature_;
    std::optional<GpsTime> moved_;
};

/// What scintillation makes of one signal.
struct SignalScintillation {
    double amplitude = 0;  ///< S4
    Angle phase;           ///< 1 σ
};

/// From that of the first signal: S4 grows as f^−1.5 and the phase as 1/f (weak scatter; ITU-R P.531).
SignalScintillation scintillation_at(const SignalScintillation& first, double frequency_ratio);

/// Standard deviations of one signal's loops.
struct LoopDeviations {
    Metres code;
    Angle phase;          ///< thermal
    Angle scintillation;  ///< of the phase
    Hertz frequency;
    /// Of the phase by all causes.
    [[nodiscard]] Angle total_phase() const;
};

/// Thermal jitter at a C/N0, multiplied by what scintillation of the amplitude adds; for S4 above 0.7 as at 0.7.
/// @param code_loop of this signal @param jitter_ratio of its modulation
LoopDeviations loop_deviations(const MeasurementParameters& parameters, const CodeLoop& code_loop, double jitter_ratio,
                               DbHz cn0, const SignalScintillation& scintillation);

}  // namespace skyloop
