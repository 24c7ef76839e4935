/// A sky of satellites on circular orbits above Odessa, for the effects of the modern profile.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "base/time/utc_time.hpp"
#include "world/flow/arrivals.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"
#include "world/gnss/constants.hpp"
#include "world/propagation/propagation_effect.hpp"

namespace skyloop::test {

inline const Geodetic odessa_place = Geodetic::degrees(46.4774, 30.7326, 50);
inline const GpsTime april_noon = gps_calendar_time(2025, 4, 10, 12, 0, 0);

inline TruthState truth_of(const Geodetic& place, GpsTime time) {
    TruthState truth;
    truth.time = time;
    truth.geodetic = place;
    truth.position = to_ecef(place);
    return truth;
}

/// A satellite in this direction on an orbit of this radius, moving as on a circle.
inline SatelliteInView satellite_at(SatelliteId id, double azimuth_deg, double elevation_deg,
                                    const Geodetic& place = odessa_place, double radius = 26560e3) {
    SatelliteInView satellite;
    satellite.id = id;
    satellite.azimuth = Angle::degrees(azimuth_deg);
    satellite.elevation = Angle::degrees(elevation_deg);
    const double lat = place.latitude.rad(), lon = place.longitude.rad();
    const Eigen::Vector3d east(-std::sin(lon), std::cos(lon), 0);
    const Eigen::Vector3d up(std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat));
    const Eigen::Vector3d north = up.cross(east);
    const double e = satellite.elevation.rad(), a = satellite.azimuth.rad();
    const Eigen::Vector3d ray = std::cos(e) * (std::cos(a) * north + std::sin(a) * east) + std::sin(e) * up;
    const Eigen::Vector3d from = to_ecef(place).vector();
    const double along = from.dot(ray);
    satellite.range = Metres(-along + std::sqrt(along * along + radius * radius - from.squaredNorm()));
    const Eigen::Vector3d position = from + satellite.range.value() * ray;
    satellite.position_at_transmission = Position<Ecef>(position);
    const Eigen::Vector3d level = position.cross(Eigen::Vector3d(0.3, -0.2, 1)).normalized();
    const Eigen::Vector3d inertial = level * std::sqrt(gravitational_constant_gps / radius);
    satellite.velocity_at_transmission =
        Velocity<Ecef>(inertial - Eigen::Vector3d(0, 0, earth_rotation_rate).cross(position));
    for (const Signal signal : emulated_signals(id.constellation))
        satellite.signals.push_back({signal, carrier_frequency(signal), Seconds(0)});
    return satellite;
}

/// GPS satellites G01, G02, … around the sky at this elevation.
inline SkyView gps_ring(int count, double elevation_deg = 40) {
    SkyView sky;
    for (int i = 0; i < count; ++i)
        sky.satellites.push_back(satellite_at({Constellation::gps, i + 1}, 360.0 * i / count, elevation_deg));
    return sky;
}

/// What arrives after one effect.
inline Arrivals after(PropagationEffect& effect, const SkyView& sky, const TruthState& truth) {
    Arrivals arrivals = free_space(sky);
    effect.apply(arrivals, sky, truth);
    return arrivals;
}

}  // namespace skyloop::test
