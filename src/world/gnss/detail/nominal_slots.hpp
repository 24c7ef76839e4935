/// Where the satellites of NominalSky stand at its epoch, but those of GPS.
#pragma once

#include <span>

#include "world/gnss/satellite.hpp"

namespace skyloop::inline world {

/// On an inclined orbit, at 2023-01-01T00:00:00 of GPS time.
struct InclinedSlot {
    SatelliteId satellite;
    double inclination_deg;
    double node_deg;      ///< longitude of the ascending node
    double argument_deg;  ///< mean argument of latitude
    int channel = 0;      ///< of GLONASS
    double eccentricity = 0, perigee_deg = 0;
};
/// At one longitude over the equator.
struct GeostationarySlot {
    SatelliteId satellite;
    double longitude_deg;
};

std::span<const InclinedSlot> inclined_slots();
std::span<const GeostationarySlot> geostationary_slots();

}  // namespace skyloop::inline world
