/// What reaches the antenna.
#pragma once

#include <optional>
#include <vector>

#include "skyloop/base/units.hpp"
#include "skyloop/gnss/satellite.hpp"

namespace skyloop {

/// One satellite's signal as it reaches the antenna: what delayed it and what weakened it, each cause by itself.
struct Arrival {
    SatelliteId id;
    bool line_of_sight = true;
    int paths = 1;        ///< rays that arrive; 0: the satellite is hidden
    int reflections = 0;  ///< of the shortest path
    Metres excess_path;   ///< of the shortest path over the direct one
    Metres iono_delay;
    Metres tropo_delay;
    Decibels free_space_loss;
    Decibels gas_loss;
    Decibels cloud_loss;
    Decibels rain_loss;
    Decibels iono_loss;
    Decibels reflection_loss;
    std::optional<DbHz> cn0;  ///< nothing until a link budget has been made, or for a hidden satellite
};

/// One arrival for each satellite of the SkyView, in its order.
struct Arrivals {
    std::vector<Arrival> satellites;
};

}  // namespace skyloop
