/// First-order Gauss-Markov processes: errors that forget themselves with time.
#pragma once

#include "base/core/random.hpp"
#include "base/core/units.hpp"

namespace skyloop {

/// The two numbers that say all of a first-order Gauss-Markov process.
struct GaussMarkovParameters {
    double sigma = 0;          ///< stationary standard deviation, in the unit of the process
    Seconds correlation_time;  ///< over which the autocorrelation falls to 1/e; 0: white
};

/// x[k+1] = φ x[k] + w with w ~ N(0, noise²).
struct GaussMarkovStep {
    double phi = 0;
    double noise = 0;  ///< standard deviation of w
};

/// The discrete form over a step of time: φ = exp(−Δt/τ), noise = σ √(1 − φ²) (MODELS.md 7.15; Brown and Hwang).
/// @param dt not negative
GaussMarkovStep gauss_markov_step(const GaussMarkovParameters& parameters, Seconds dt);

/// A seeded process that starts in its stationary distribution.
///
/// State: the present value and its own stream of random numbers.
class GaussMarkov {
public:
    /// @param stream of this process alone, named for what it drives
    GaussMarkov(GaussMarkovParameters parameters, RandomStream stream);
    [[nodiscard]] double value() const { return value_; }
    /// Lets `dt` pass and returns the new value. No time, no change and no random number taken.
    double advance(Seconds dt);

private:
    GaussMarkovParameters parameters_;
    RandomStream stream_;
    double value_;
};

}  // namespace skyloop
