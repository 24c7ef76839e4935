#include "detail/range_equation.hpp"

#include <cmath>

#include "world/gnss/constants.hpp"

namespace skyloop {

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

}  // namespace skyloop
