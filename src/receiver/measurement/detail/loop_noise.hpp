/// The errors of one signal's tracking loops, and how large they are.
/// How a signal is modulated, as far as tracking it is concerned.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/random.hpp"
#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "base/time/knotted_process.hpp"
#include "receiver/measurement/measurement_parameters.hpp"
#include "receiver/measurement/tracking_jitter.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline receiver {

/// What sets a signal's tracking apart from that of GPS L1 C/A.
struct SignalTraits {
    double chip_rate_ratio = 1;  ///< to 1.023 Mchip/s
    double jitter_ratio = 1;     ///< of the code's noise to that of BPSK at the same chip rate
    bool boc = false;            ///< BOC(1,1): the peak of correlation is three times as steep, with side peaks
    bool pilot = false;          ///< tracked without data bits: the component named by rinex_signal_code()
};

/// Chip rates: IS-GPS-200 and 705, Galileo OS SIS ICD, BDS-SIS-ICD-2.1 (B1I and B2I), BeiDou B3I ICD, GLONASS ICD L1,
/// L2 (0.511 Mchip/s). BOC of Galileo E1: 0.6 (MODELS.md 7.9).
SignalTraits signal_traits(Constellation constellation, Signal signal);

/// The receiver's code loop on such a signal: its chip rate in proportion, and a front end that passes at least the
/// main lobe.
CodeLoop code_loop_for(const CodeLoop& loop, const SignalTraits& traits);

/// "code_noise.G07.L1": the stream of random numbers of one process of one signal.
std::string signal_stream_name(std::string_view process, SatelliteId satellite, Signal signal);

/// How far each process of a signal goes in one step of time.
struct NoiseSteps {
    GaussMarkovStep phase, frequency, scintillation;
};

/// How long a loop of bandwidth B remembers its noise: 1/(4B), as the equivalent rectangular bandwidth of a first-order
/// process is 1/(4τ).
Seconds memory_of(Hertz bandwidth);

/// For processes of unit deviation.
NoiseSteps noise_steps(const MeasurementParameters& parameters, Seconds dt);

/// How long the multipath of one signal is remembered. @param moving faster than 1 m/s
Seconds multipath_memory(const StatisticalMultipath& model, Angle elevation, bool moving);
/// What of m1 is left at an elevation.
double low_share(Angle elevation);

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

/// The same with a path that does not depend on the rate of the epochs, where it remembers for two seconds or more: it
/// is drawn at whole seconds of GPS time then.
class SlowProcess {
public:
    /// @param shortest that it will ever remember
    SlowProcess(Seconds shortest, RandomStream stream);
    /// @param memory from now on @param dt since the last time
    void advance(GpsTime now, Seconds memory, Seconds dt);
    [[nodiscard]] double value() const { return value_; }

private:
    UnitProcess fast_;
    std::optional<KnottedProcess> slow_;
    double value_;
};

/// What a first-order filter makes of a process: it follows a straight line between two epochs exactly.
class Smoothed {
public:
    /// @param now the process @param dt since the last time  @param memory of the filter; 0: none
    double follow(double now, Seconds dt, Seconds memory);

private:
    double value_ = 0, before_ = 0;
    bool started_ = false;
};

/// The processes of one signal, each with a stream of its own.
struct SignalProcesses {
    SignalProcesses(const MeasurementParameters& parameters, std::uint64_t seed, SatelliteId satellite, Signal signal);
    /// @param scintillates the phase does: without, its process rests
    void advance(const NoiseSteps& steps, bool scintillates);

    SlowProcess code, multipath;  ///< which are advanced by themselves
    Smoothed smooth_multipath;
    UnitProcess phase, frequency, scintillation;
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
/// With the phase locked the frequency is its change over `doppler_window`, two readings of independent noise, and the
/// oscillator's own noise; without, that of the frequency loop.
struct TrackedSignal {
    const CodeLoop& code_loop;  ///< of this signal
    double jitter_ratio = 1;    ///< of its modulation
    Hertz carrier;
    bool phase_locked = false;
    Seconds code_locked{1e6};  ///< for so long: the code loop begins wide, and narrows to its bandwidth
    Seconds aided{1e6};        ///< by the carrier, for so long
};
LoopDeviations loop_deviations(const MeasurementParameters& parameters, const TrackedSignal& signal, DbHz cn0,
                               const SignalScintillation& scintillation);

}  // namespace skyloop::inline receiver
