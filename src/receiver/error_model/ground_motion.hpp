/// Velocity and course from one position to the next.
#pragma once

#include <optional>

#include "world/flow/fix.hpp"

namespace skyloop {

/// A position and when it was.
struct TimedPosition {
    GpsTime time;
    Geodetic position;
};

/// Motion over the ground.
struct GroundMotion {
    VelocityNed velocity;
    MetresPerSecond speed;  ///< horizontal
    Angle course;           ///< 0 … 360°, clockwise from true north; 0 at rest
};

/// Speed and course of a velocity.
GroundMotion ground_motion(const VelocityNed& velocity);

/// Differences of geodetic coordinates over time, with the radii of curvature at the mean latitude and height
/// (MODELS.md 3.10). Beyond 89.9° of latitude, where longitudes lose their meaning, the straight way in the local frame
/// of `after`. No motion when no time passes.
GroundMotion motion_between(const TimedPosition& before, const TimedPosition& after);

/// The motion of a series of fixes, each against the one before. The first fix, and the first after a gap, has nothing
/// to compare with and reports no motion.
class MotionOfFixes {
public:
    GroundMotion next(const TimedPosition& fix);
    /// There is no fix: the next one is a first again.
    void interrupt() { last_.reset(); }

private:
    std::optional<TimedPosition> last_;
};

}  // namespace skyloop
