#include "receiver/measurement/tracking_jitter.hpp"

#include <cmath>
#include <numbers>

#include "world/gnss/constants.hpp"

namespace skyloop {

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

MetresPerSecond range_rate_of(Hertz frequency_error, Hertz carrier) {
    return MetresPerSecond(speed_of_light / carrier.value() * frequency_error.value());
}

}  // namespace skyloop
