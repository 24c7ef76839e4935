/// Paths one after the other.
#pragma once

#include <vector>

#include "skyloop/trajectory/local_shape.hpp"
#include "skyloop/trajectory/speed_profile.hpp"
#include "skyloop/trajectory/vehicle_class.hpp"

namespace skyloop {

/// One of the paths of a sequence; all of them lie on one plane.
struct SequenceStep {
    std::shared_ptr<const LocalShape> shape;
    double seconds = LocalShape::endless;             ///< after which it is left, if it has not ended before
    VehicleClass vehicle = VehicleClass::multirotor;  ///< as which it is gone
};

/// From the end of each path a curve of the fifth degree leads to the beginning of the next, as long as its speed,
/// acceleration and jerk need it and a turn of at most 90° a second; each is told. Where one curve does not keep the
/// limits, it stops on its way. Position, velocity and acceleration are continuous (FEEDS.md 2.6), as are heading, roll
/// and pitch with both derivatives. Each step's vehicle stands as such; it becomes the next one on the curve between.
/// @param loop after the last path comes the first one again
/// No plan: a path without an end that is not the last one; no curve within the limits.
PathPlanResult plan_sequence(const std::vector<SequenceStep>& steps, const SpeedLimits& limits, bool loop);

}  // namespace skyloop
