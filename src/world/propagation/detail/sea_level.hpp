/// Heights above sea level for models of the air, with or without a geoid.
#pragma once

#include "base/geo/geodetic.hpp"
#include "base/geo/geoid.hpp"

namespace skyloop {

/// Height above the geoid; without a geoid the ellipsoid stands in for the sea (MODELS.md D-03).
inline MslHeight sea_level_height(const Geodetic& place, const Geoid* geoid) {
    const Metres undulation = geoid != nullptr ? geoid->undulation(place.latitude, place.longitude) : Metres(0);
    return above_sea_level(place.height, undulation);
}

}  // namespace skyloop
