/// One satellite in one direction, for effects that treat each satellite by itself.
#pragma once

#include "world/flow/arrivals.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"
#include "world/gnss/constants.hpp"
#include "world/propagation/propagation_effect.hpp"

namespace skyloop::test {

/// A sky with one satellite, what arrives from it, and where the antenna is.
struct OneSatellite {
    SkyView sky;
    TruthState truth;
    Arrivals arrivals;

    OneSatellite(Angle elevation, Metres range, const Geodetic& place) {
        SatelliteInView satellite;
        satellite.id = {Constellation::gps, 1};
        satellite.elevation = elevation;
        satellite.range = range;
        sky.satellites.push_back(satellite);
        truth.geodetic = place;
        truth.position = to_ecef(place);
        truth.time = to_gps_time(2111, 360000.0);
        arrivals = free_space(sky);
    }
    Arrival& arrival() { return arrivals.satellites.front(); }
    /// The arrival after `effect`.
    const Arrival& after(PropagationEffect& effect) {
        effect.apply(arrivals, sky, truth);
        return arrival();
    }
};

}  // namespace skyloop::test
