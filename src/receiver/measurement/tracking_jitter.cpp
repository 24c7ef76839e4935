#include "receiver/measurement/tracking_jitter.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {

CarrierToNoise::CarrierToNoise(DbHz cn0) : ratio_(std::pow(10, cn0.value() / 10)) {}

Metres CodeLoop::chip_length() const { return Metres(speed_of_light / chip_rate.value()); }

double code_jitter_chips(const CodeLoop& loop, CarrierToNoise cn0) {
    const double cn = cn0.ratio(), spacing = loop.spacing_chips;
    const double b = loop.front_end_bandwidth.value() / loop.chip_rate.value();
    const double per_integration = 1 / (loop.integration.value() * cn);
    const double thermal = loop.bandwidth.value() / (2 * cn);
    if (spacing * b <= 1) return std::sqrt(thermal / b * (1 + per_integration));
    const double squaring = 1 + 2 * per_integration / (2 - spacing);
    if (spacing * b >= std::numbers::pi) return std::sqrt(thermal * spacing * squaring);
    const double wider = spacing - 1 / b;
    return std::sqrt(thermal * (1 / b + b / (std::numbers::pi - 1) * wider * wider) * squaring);
}

Metres code_jitter(const CodeLoop& loop, CarrierToNoise cn0) {
    return loop.chip_length() * code_jitter_chips(loop, cn0);
}

Angle phase_jitter(const CarrierLoop& loop, CarrierToNoise cn0) {
    const double cn = cn0.ratio();
    return Angle::radians(std::sqrt(loop.bandwidth.value() / cn * (1 + 1 / (2 * loop.integration.value() * cn))));
}

Hertz frequency_jitter(const CarrierLoop& loop, CarrierToNoise cn0, double threshold_factor) {
    const double cn = cn0.ratio(), t = loop.integration.value();
    return Hertz(std::sqrt(4 * threshold_factor * loop.bandwidth.value() / cn * (1 + 1 / (t * cn))) /
                 (2 * std::numbers::pi * t));
}

namespace {

// What the fading of the amplitude leaves of C/N0, and of T·C/N0 in the squaring loss.
struct FadedSignal {
    double tracked;
    double squared;
};

FadedSignal faded(CarrierToNoise cn0, double s4) {
    assert(s4 >= 0 && s4 < strongest_scintillation);
    return {cn0.ratio() * (1 - s4 * s4), cn0.ratio() * (1 - 2 * s4 * s4)};
}

}  // namespace

double nakagami_m(double s4) { return 1 / (s4 * s4); }

double scintillating_power(double s4, double in_phase, double quadrature) {
    if (!(s4 > 0)) return 1;
    const double m = nakagami_m(std::min(s4, 1.0)), root = std::sqrt(m * m - m);
    const double k = root / (m - root);
    const double steady = std::sqrt(k / (k + 1)), scattered = std::sqrt(1 / (2 * (k + 1)));
    const double along = steady + scattered * in_phase, across = scattered * quadrature;
    return along * along + across * across;
}

double scintillating_code_jitter_chips(const CodeLoop& loop, CarrierToNoise cn0, double s4) {
    const FadedSignal signal = faded(cn0, s4);
    const double squaring = 1 + 1 / (loop.integration.value() * signal.squared);
    return std::sqrt(loop.bandwidth.value() * loop.spacing_chips * squaring / (2 * signal.tracked));
}

Angle scintillating_phase_jitter(const CarrierLoop& loop, CarrierToNoise cn0, double s4) {
    const FadedSignal signal = faded(cn0, s4);
    const double squaring = 1 + 1 / (2 * loop.integration.value() * signal.squared);
    return Angle::radians(std::sqrt(loop.bandwidth.value() * squaring / signal.tracked));
}

}  // namespace skyloop::inline receiver
