/// The flat frame of a game level, laid on the Earth.
#pragma once

#include <Eigen/Core>

#include "base/geo/local_frame.hpp"

namespace skyloop {

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
    [[nodiscard]] Position<Level> to_level(const Position<Ecef>& point) const;
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

}  // namespace skyloop
