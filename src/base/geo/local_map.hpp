/// How simulators lay their local metres on the Earth.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "base/geo/body_frame.hpp"
#include "base/geo/geodetic.hpp"

namespace skyloop {

/// The maps that simulators use (FEEDS.md 0.1). They differ by 0.1 to 0.3 % of the distance from the origin.
enum class LocalMap {
    tangent,         ///< the plane that touches the ellipsoid at the origin: gz-sim, Cesium, Unreal's GeoReferencing
    ardupilot_flat,  ///< 111 318.845 m to a degree, a parallel shrunk by the cosine half way: ArduPilot's
                     ///< AP_Common/Location
    px4_azimuthal,   ///< azimuthal equidistant on a sphere of 6 371 000 m: PX4's lib/geo
    airsim_sphere    ///< the same on a sphere of 6 378 137 m: AirSim's EarthUtils
};

/// "ardupilot_flat"
std::string_view local_map_name(LocalMap map);
/// Nothing for a name that is none.
std::optional<LocalMap> local_map_of_name(std::string_view name);

/// Where a point is that a simulator says to be so far from its origin.
/// @param ned metres north, east and down
Geodetic place_on_map(LocalMap map, const Geodetic& origin, const Eigen::Vector3d& ned);

/// The axes, as a turn to ECEF, of vectors that a simulator gives along with a point: of the tangent plane those of its
/// origin, of the other maps, which follow the Earth's curve, those of the place itself.
Eigen::Matrix3d axes_on_map(LocalMap map, const Geodetic& origin, const Geodetic& place);

}  // namespace skyloop
