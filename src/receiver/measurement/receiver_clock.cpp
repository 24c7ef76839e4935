#include "receiver/measurement/receiver_clock.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/core/random.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
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
    : parameters_(parameters),
      stream_(stream),
      bias_(parameters.bias),
      drift_(parameters.steering == ClockSteering::continuous ? MetresPerSecond(0) : parameters.drift) {
    jump();
}

void ReceiverClock::advance(Seconds dt) {
    if (!(dt.value() > 0)) return;
    if (parameters_.steering == ClockSteering::continuous)
        pull(dt);
    else
        bias_ += Metres(drift_.value() * dt.value());
    add_noise(dt);
    jump();
}

void ReceiverClock::add_noise(Seconds dt) {
    // A steered clock forgets what lies further back than its loop's time.
    const bool steered = parameters_.steering == ClockSteering::continuous;
    const Seconds remembered = steered ? std::min(dt, parameters_.steering_time) : dt;
    const ClockCovariance q = clock_covariance(parameters_.noise, remembered);
    const double first = stream_.normal(), second = stream_.normal(), third = stream_.normal();
    // Drift first: its factor of Q is one number, and the bias takes its share of it.
    const double share = q.drift > 0 ? q.bias_drift / q.drift : 0;
    const double drift_noise = std::sqrt(q.drift) * first;
    const double bias_noise = share * drift_noise + std::sqrt(std::max(q.bias - share * q.bias_drift, 0.0)) * second;

    const OscillatorTemperature& model = parameters_.temperature;
    const GaussMarkovStep step = gauss_markov_step({model.deviation.value(), model.correlation_time}, dt);
    const Kelvin before = temperature_;
    temperature_ = Kelvin(step.phi * before.value() + step.noise * third);
    const double warming = speed_of_light * model.per_kelvin * (temperature_ - before).value();

    bias_ += Metres(bias_noise + warming * remembered.value() / 2);
    drift_ += MetresPerSecond(drift_noise + warming);
}

// The free response of b″ = −w² b − 2w b′, w = 1/steering time: exact for every step.
void ReceiverClock::pull(Seconds dt) {
    const double w = 1 / std::max(parameters_.steering_time.value(), 1e-3), t = dt.value();
    const double b = bias_.value(), slope = drift_.value() + w * b, decay = std::exp(-w * t);
    bias_ = Metres((b + slope * t) * decay);
    drift_ = MetresPerSecond((drift_.value() - w * slope * t) * decay);
}

void ReceiverClock::jump() {
    if (parameters_.steering != ClockSteering::millisecond_jumps) return;
    const double milliseconds = std::round(bias_.value() / millisecond_of_light);
    bias_ -= Metres(milliseconds * millisecond_of_light);
    jumped_milliseconds_ -= static_cast<int>(milliseconds);
}

}  // namespace skyloop::inline receiver
