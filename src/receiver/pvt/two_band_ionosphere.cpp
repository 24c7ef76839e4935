#include "receiver/pvt/two_band_ionosphere.hpp"

#include <algorithm>
#include <cmath>

#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr double longest_absence_s = 60;  // over which the delay is carried on
constexpr double alike_s = 100;  // for so long echoes of the code stay alike at rest between houses, about; ours

double metres_of_phase(const Observation& o) { return *o.carrier_phase * speed_of_light / o.carrier.value(); }

std::optional<double> phase_difference(const Observation& first, const Observation& second) {
    const bool counted = first.carrier_phase && second.carrier_phase && !first.slipped && !second.slipped;
    if (!counted) return std::nullopt;
    return metres_of_phase(second) - metres_of_phase(first);
}

}  // namespace

void TwoBandIonosphere::average(Average& known, double code, std::optional<double> phase, double per_phase,
                                GpsTime time) const {
    const double dt = difference(time, known.time).value();
    if (phase && known.phase) known.delay -= (*phase - *known.phase) * per_phase;
    known.averaged = std::min(known.averaged + dt, memory_.value());
    known.delay += dt / (known.averaged + dt) * (code - known.delay);
    known.phase = phase;
    known.time = time;
}

std::optional<MeasuredDelay> TwoBandIonosphere::measure(TransmitterSource& transmitters, const Transmitter& sent,
                                                        const Observation& first,
                                                        std::span<const Observation* const> others,
                                                        GpsTime receive_time) {
    if (memory_ <= Seconds(0)) return std::nullopt;
    const auto second =
        std::find_if(others.begin(), others.end(), [&](const Observation* o) { return o->carrier != first.carrier; });
    if (second == others.end()) return std::nullopt;
    const auto other = transmitters.at(first.satellite, (*second)->signal, receive_time, *(*second)->pseudorange);
    if (!other) return std::nullopt;
    const double ratio = first.carrier.value() / (*second)->carrier.value();
    const double per_code = 1 / (ratio * ratio - 1);
    const double code = per_code * ((**second).pseudorange->value() - first.pseudorange->value() +
                                    speed_of_light * (other->clock_bias - sent.clock_bias).value());
    const std::optional<double> phase = phase_difference(first, **second);
    Average& known = satellites_.try_emplace(first.satellite, Average{receive_time, code, phase, 0}).first->second;
    const double gap = difference(receive_time, known.time).value();
    if (gap < 0 || gap > longest_absence_s)
        known = {receive_time, code, phase, 0};
    else if (gap > 0)
        average(known, code, phase, per_code, receive_time);
    return MeasuredDelay{Metres(known.delay), 2 * per_code * per_code * alike_s / (alike_s + known.averaged)};
}

}  // namespace skyloop::inline receiver
