#include "world/propagation/propagation_effect.hpp"

#include <cmath>
#include <numbers>

#include "world/gnss/constants.hpp"

namespace skyloop::inline world {

Decibels free_space_loss(Metres distance, Hertz carrier) {
    return Decibels(20 * std::log10(4 * std::numbers::pi * distance.value() * carrier.value() / speed_of_light));
}

namespace {

Arrival arrival_of(const SatelliteInView& satellite) {
    Arrival arrival;
    arrival.id = satellite.id;
    arrival.direction = direction_of(satellite);
    arrival.range = satellite.range;
    arrival.range_rate = satellite.range_rate;
    arrival.clock_bias = satellite.clock_bias;
    arrival.clock_drift = satellite.clock_drift;
    arrival.earlier_records.jumped = satellite.earlier_records.jumped;
    for (const TransmittedSignal& s : satellite.signals)
        arrival.signals.push_back({s.signal, s.carrier, s.group_delay, Decibels(0)});
    arrival.free_space_loss = free_space_loss(satellite.range, first_carrier(arrival));
    return arrival;
}

}  // namespace

Hertz first_carrier(const Arrival& arrival) {
    return arrival.signals.empty() ? Hertz(carrier_frequency_l1) : arrival.signals.front().carrier;
}

Arrivals free_space(const SkyView& sky) {
    Arrivals arrivals;
    arrivals.satellites.reserve(sky.satellites.size());
    for (const SatelliteInView& satellite : sky.satellites)
        arrivals.satellites.push_back(arrival_of(satellite));
    return arrivals;
}

}  // namespace skyloop::inline world
