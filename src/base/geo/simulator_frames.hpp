/// The flat frame of a game level, laid on the Earth.
/// How simulators lay their local metres on the Earth.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <string_view>

#include "base/geo/attitude.hpp"
#include "base/geo/geodetic.hpp"
#include "base/geo/local_frame.hpp"

namespace skyloop::inline base {

/// Cartesian coordinates of a game level, in the level's own unit.
struct Level {};

/// Where and how a level lies on the Earth (MODELS.md 3.2; a game engine with centimetres, X forward, Y right, Z up has
/// unit 0.01 m and is left-handed).
struct LevelPlacement {
    Geodetic origin;           ///< where the level's origin is
    Angle yaw;                 ///< azimuth of the level's X axis, clockwise from true north
    Metres unit{1.0};          ///< length of one level unit
    bool left_handed = false;  ///< true: Y points to the right of X; false: to the left
    Metres reach{4000.0};      ///< horizontal distance to which a plane is good enough for the curved Earth
};

/// The game level frame. The level is flat: a point at distance d lies d²/2R above the ellipsoid.
class LevelFrame {
public:
    explicit LevelFrame(const LevelPlacement& placement);

    [[nodiscard]] Position<Ecef> to_ecef(const Position<Level>& point) const;
    /// A velocity in level units per second.
    [[nodiscard]] Velocity<Ecef> to_ecef(const Velocity<Level>& velocity) const;
    /// True where the tangent plane has been left too far behind and should be anchored anew.
    [[nodiscard]] bool beyond_reach(const Position<Level>& point) const;
    [[nodiscard]] const LevelPlacement& placement() const { return placement_; }

private:
    LevelPlacement placement_;
    LocalFrame local_;
    Eigen::Matrix3d level_to_enu_;  ///< metres of ENU per level unit
};

/// The maps that simulators use (FEEDS.md 0.1). They differ by 0.1 to 0.3 % of the distance from the origin.
enum class LocalMap {
    tangent,         ///< the plane that touches the ellipsoid at the origin: gz-sim, Cesium, Unreal's GeoReferencing
    ardupilot_flat,  ///< 111 318.845 m to a degree, a parallel shrunk by the cosine half way: ArduPilot's
                     ///< AP_Common/Location
    px4_azimuthal,   ///< azimuthal equidistant on a sphere of 6 371 000 m: PX4's lib/geo
    airsim_sphere    ///< the same on a sphere of 6 378 137 m: AirSim's EarthUtils
};

/// Of "ardupilot_flat" and so on; nothing for a name that is none.
std::optional<LocalMap> local_map_of_name(std::string_view name);

/// Where a point is that a simulator says to be so far from its origin.
/// @param ned metres north, east and down
Geodetic place_on_map(LocalMap map, const Geodetic& origin, const Eigen::Vector3d& ned);

/// The axes, as a turn to ECEF, of vectors that a simulator gives along with a point: of the tangent plane those of its
/// origin, of the other maps, which follow the Earth's curve, those of the place itself.
Eigen::Matrix3d axes_on_map(LocalMap map, const Geodetic& origin, const Geodetic& place);

}  // namespace skyloop::inline base
