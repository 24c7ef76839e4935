#include "receiver/pvt/observation_equations.hpp"

#include <algorithm>
#include <cmath>

#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
namespace {

// A gap after which nobody can say that no cycle was lost.
constexpr double longest_phase_gap_s = 5;

}  // namespace

void CodeSmoother::smooth(Observations& observations) {
    if (window_ <= Seconds(0)) return;
    if (observations.clock_was_set) signals_.clear();
    for (Observation& o : observations.signals) {
        const std::pair key(o.satellite, o.signal);
        if (!o.pseudorange || !o.carrier_phase) {
            signals_.erase(key);
            continue;
        }
        const auto known = signals_.find(key);
        const double dt =
            known == signals_.end() ? 0 : difference(observations.receive_time, known->second.time).value();
        if (dt <= 0 || dt > longest_phase_gap_s || o.slipped) {
            signals_[key] = {observations.receive_time, o.pseudorange->value(), *o.carrier_phase, 1};
            continue;
        }
        Smoothed& s = known->second;
        const double wavelength = speed_of_light / o.carrier.value();
        s.count = std::min(s.count + 1, std::max(window_.value() / dt, 1.0));
        const double carried = s.range + wavelength * (*o.carrier_phase - s.cycles);
        s.range = carried + (o.pseudorange->value() - carried) / s.count;
        s.cycles = *o.carrier_phase;
        s.time = observations.receive_time;
        o.pseudorange = Metres(s.range);
    }
}

std::optional<RangeEquation> range_equation(TransmitterSource& transmitters, const Observation& first,
                                            std::span<const Observation* const> others, GpsTime receive_time) {
    std::optional<Transmitter> t1 = transmitters.at(first.satellite, first.signal, receive_time, *first.pseudorange);
    if (!t1) return std::nullopt;
    t1->healthy = t1->healthy && !first.called_unhealthy;
    RangeEquation e{first.satellite, *t1, *first.pseudorange, first.carrier, first.pseudorange_deviation, false};
    const Observation* second = nullptr;
    std::optional<Transmitter> t2;
    for (std::size_t i = 0; i < others.size() && !t2; ++i) {
        second = others[i];
        if (second->carrier == first.carrier) continue;
        t2 = transmitters.at(second->satellite, second->signal, receive_time, *second->pseudorange);
    }
    if (!t2) return e;
    const double ratio = first.carrier.value() / second->carrier.value();
    const double b = -1 / (ratio * ratio - 1);
    const double a = 1 - b;
    const double c = speed_of_light;
    e.pseudorange = a * *first.pseudorange + b * *second->pseudorange;
    const Seconds clock = a * t1->clock_bias + b * t2->clock_bias;
    // The first signal left later than its pseudorange says, by the delay that the combination takes out.
    const Seconds delay((*first.pseudorange - e.pseudorange).value() / c + (t1->clock_bias - clock).value());
    e.transmitter = moved(*t1, delay);
    e.transmitter.clock_bias = clock;
    e.carrier = Hertz(0);
    e.deviation =
        Metres(std::hypot(a * first.pseudorange_deviation.value(), b * second->pseudorange_deviation.value()));
    return e;
}

}  // namespace skyloop::inline receiver
