/// The clock of a receiver: a crystal that wanders, and what the firmware does about it.
#pragma once

#include "base/core/random.hpp"
#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline receiver {

/// The two coefficients of an oscillator's Allan variance that a two-state clock follows.
struct OscillatorNoise {
    double h0 = 2e-19;         ///< white frequency noise, s; the default is a TCXO
    double h_minus_2 = 2e-20;  ///< random walk of frequency, 1/s
};

/// Covariance of what a step of time adds to bias and drift.
struct ClockCovariance {
    double bias = 0;        ///< m²
    double bias_drift = 0;  ///< m²/s
    double drift = 0;       ///< m²/s²
};

/// Q = c² [S_f Δt + S_g Δt³/3, S_g Δt²/2; ·, S_g Δt] with S_f = h0/2 and S_g = 2π² h₋₂ (Brown and Hwang;
/// MODELS.md 7.12).
ClockCovariance clock_covariance(const OscillatorNoise& noise, Seconds dt);

/// How the firmware keeps its time near that of the satellites.
enum class ClockSteering {
    free_running,       ///< not at all
    millisecond_jumps,  ///< whole milliseconds, whenever the bias passes half of one: pseudoranges jump along
    continuous,         ///< the oscillator is pulled to the time of the satellites: within tens of nanoseconds
};

/// The slow temperature of the oscillator against that of the start: a Gauss-Markov process, and what it does to the
/// frequency (MODELS.md 7.12).
struct OscillatorTemperature {
    double per_kelvin = 5e-8;       ///< change of frequency, 1/K
    Kelvin deviation{0.2};          ///< 1 σ; 0: constant
    Seconds correlation_time{600};  ///< of it
};

/// What a receiver's clock is and where it starts.
struct ReceiverClockParameters {
    OscillatorNoise noise;
    Metres bias;                 ///< at the start
    MetresPerSecond drift{150};  ///< at the start; 0.5 parts per million; continuous steering starts with it taken out
    ClockSteering steering = ClockSteering::free_running;
    OscillatorTemperature temperature{};
    Seconds steering_time{10};  ///< of the critically damped loop of continuous steering
};

/// A seeded two-state clock at a temperature. It is drawn each tenth of a second since its start, with a cubic between,
/// so that its path does not depend on how often it is looked at.
///
/// State: bias, drift and temperature at both ends of the present tenth, how often it has jumped, its own stream of
/// random numbers.
class ReceiverClock {
public:
    /// @param stream of this clock alone
    ReceiverClock(const ReceiverClockParameters& parameters, RandomStream stream);

    /// Receiver time minus true time, times the speed of light.
    [[nodiscard]] Metres bias() const { return bias_; }
    [[nodiscard]] MetresPerSecond drift() const { return drift_; }
    /// Sum of all jumps so far, whole milliseconds.
    [[nodiscard]] int jumped_milliseconds() const { return jumped_milliseconds_; }

    /// Lets `dt` pass. The same number of random numbers is taken whatever the noise.
    void advance(Seconds dt);

private:
    struct State {
        double bias = 0, drift = 0;  // m, m/s
        Kelvin temperature;
    };
    State after(State state, Seconds dt);
    void add_noise(State& state, Seconds dt);
    void pull(State& state, Seconds dt) const;
    void look();
    void jump();

    ReceiverClockParameters parameters_;
    RandomStream stream_;
    State from_, to_;
    std::int64_t tenth_ = 0;  // from_ is its start
    Nanoseconds elapsed_{0};
    Metres bias_;
    MetresPerSecond drift_;
    int jumped_milliseconds_ = 0;
};

}  // namespace skyloop::inline receiver
