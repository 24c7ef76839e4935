#include "skyloop/propagation/free_space.hpp"

#include <cmath>
#include <numbers>

#include "skyloop/gnss/constants.hpp"

namespace skyloop {

Decibels free_space_loss(Metres distance, Hertz carrier) {
    return Decibels(20 * std::log10(4 * std::numbers::pi * distance.value() * carrier.value() / speed_of_light));
}

Arrivals free_space(const SkyView& sky, Hertz carrier) {
    Arrivals arrivals;
    arrivals.satellites.reserve(sky.satellites.size());
    for (const SatelliteInView& satellite : sky.satellites) {
        Arrival arrival;
        arrival.id = satellite.id;
        arrival.free_space_loss = free_space_loss(satellite.range, carrier);
        arrivals.satellites.push_back(arrival);
    }
    return arrivals;
}

}  // namespace skyloop
