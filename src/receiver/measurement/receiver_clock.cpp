#include "receiver/measurement/receiver_clock.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/core/random.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr double millisecond_of_light = speed_of_light * 1e-3;  // m
constexpr Nanoseconds clock_step = std::chrono::milliseconds(100);
constexpr std::int64_t most_steps = 10'000;

}  // namespace

ClockCovariance clock_covariance(const OscillatorNoise& noise, Seconds dt) {
    const double t = dt.value();
    const double frequency = speed_of_light * speed_of_light * noise.h0 / 2;
    const double walk = speed_of_light * speed_of_light * 2 * std::numbers::pi * std::numbers::pi * noise.h_minus_2;
    return {frequency * t + walk * t * t * t / 3, walk * t * t / 2, walk * t};
}

ReceiverClock::ReceiverClock(const ReceiverClockParameters& parameters, RandomStream stream)
    : parameters_(parameters), stream_(stream) {
    from_.bias = parameters.bias.value();
    from_.drift = parameters.steering == ClockSteering::continuous ? 0 : parameters.drift.value();
    to_ = after(from_, to_seconds(clock_step));
    look();
}

void ReceiverClock::advance(Seconds dt) {
    if (!(dt.value() > 0)) return;
    elapsed_ += to_nanoseconds(dt);
    std::int64_t due = elapsed_ / clock_step - tenth_;
    tenth_ += due;
    if (due > most_steps) {  // of a long pause only the end is drawn
        to_ = after(to_, to_seconds(clock_step) * static_cast<double>(due - 1));
        due = 1;
    }
    for (; due > 0; --due) {
        from_ = to_;
        to_ = after(from_, to_seconds(clock_step));
    }
    look();
}

// Where the clock is within its tenth: on the cubic of both ends' biases and drifts.
void ReceiverClock::look() {
    const double span = to_seconds(clock_step).value(), u = to_seconds(elapsed_ - tenth_ * clock_step).value() / span;
    const double way = to_.bias - from_.bias, start = from_.drift * span, end = to_.drift * span;
    bias_ = Metres(from_.bias + u * (start + u * (3 * way - 2 * start - end + u * (start + end - 2 * way))));
    drift_ = MetresPerSecond(from_.drift + u * (to_.drift - from_.drift));
    jump();
}

ReceiverClock::State ReceiverClock::after(State state, Seconds dt) {
    if (parameters_.steering == ClockSteering::continuous)
        pull(state, dt);
    else
        state.bias += state.drift * dt.value();
    add_noise(state, dt);
    return state;
}

void ReceiverClock::add_noise(State& state, Seconds dt) {
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
    const GaussMarkovStep warms = gauss_markov_step({model.deviation.value(), model.correlation_time}, dt);
    const Kelvin before = state.temperature;
    state.temperature = Kelvin(warms.phi * before.value() + warms.noise * third);
    const double warming = speed_of_light * model.per_kelvin * (state.temperature - before).value();

    state.bias += bias_noise + warming * remembered.value() / 2;
    state.drift += drift_noise + warming;
}

// The free response of b″ = −w² b − 2w b′, w = 1/steering time: exact for every step.
void ReceiverClock::pull(State& state, Seconds dt) const {
    const double w = 1 / std::max(parameters_.steering_time.value(), 1e-3), t = dt.value();
    const double slope = state.drift + w * state.bias, decay = std::exp(-w * t);
    state.bias = (state.bias + slope * t) * decay;
    state.drift = (state.drift - w * slope * t) * decay;
}

void ReceiverClock::jump() {
    if (parameters_.steering != ClockSteering::millisecond_jumps) return;
    const double milliseconds = std::round(bias_.value() / millisecond_of_light);
    if (milliseconds == 0) return;
    for (double* bias : {&from_.bias, &to_.bias})
        *bias -= milliseconds * millisecond_of_light;
    bias_ -= Metres(milliseconds * millisecond_of_light);
    jumped_milliseconds_ -= static_cast<int>(milliseconds);
}

}  // namespace skyloop::inline receiver
