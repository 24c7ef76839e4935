#include "skyloop/measurement/receiver_clock.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "skyloop/gnss/constants.hpp"

namespace skyloop {
namespace {

constexpr double millisecond_of_light = speed_of_light * 1e-3;  // m

}  // namespace

ClockCovariance clock_covariance(const OscillatorNoise& noise, Seconds dt) {
    const double t = dt.value();
    const double frequency = speed_of_light * speed_of_light * noise.h0 / 2;
    const double walk = speed_of_light * speed_of_light * 2 * std::numbers::pi * std::numbers::pi * noise.h_minus_2;
    return {frequency * t + walk * t * t * t / 3, walk * t * t / 2, walk * t};
}

ReceiverClock::ReceiverClock(const ReceiverClockParameters& parameters, RandomStream stream)
    : noise_(parameters.noise),
      steering_(parameters.steering),
      stream_(stream),
      bias_(parameters.bias),
      drift_(parameters.drift) {
    steer();
}

void ReceiverClock::advance(Seconds dt) {
    if (dt.value() <= 0) return;
    const ClockCovariance q = clock_covariance(noise_, dt);
    const double first = stream_.normal(), second = stream_.normal();
    // Drift first: its factor of Q is one number, and the bias takes its share of it.
    const double share = q.drift > 0 ? q.bias_drift / q.drift : 0;
    const double drift_noise = std::sqrt(q.drift) * first;
    const double bias_noise = share * drift_noise + std::sqrt(std::max(q.bias - share * q.bias_drift, 0.0)) * second;
    bias_ += Metres(drift_.value() * dt.value() + bias_noise);
    drift_ += MetresPerSecond(drift_noise);
    steer();
}

void ReceiverClock::steer() {
    if (steering_ != ClockSteering::millisecond_jumps) return;
    const double milliseconds = std::round(bias_.value() / millisecond_of_light);
    bias_ -= Metres(milliseconds * millisecond_of_light);
    jumped_milliseconds_ -= static_cast<int>(milliseconds);
}

}  // namespace skyloop
