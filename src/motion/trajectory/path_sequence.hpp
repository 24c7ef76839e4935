/// Paths one after the other.
#pragma once

#include <vector>

#include "motion/trajectory/local_shape.hpp"
#include "motion/trajectory/vehicle.hpp"

namespace skyloop {

/// One of the paths of a sequence; all of them lie on one plane.
struct SequenceStep {
    std::shared_ptr<const LocalShape> shape;
    double seconds = LocalShape::endless;  ///< after which it is left, if it has not ended before
    VehicleLimits vehicle{};               ///< which goes it
};

/// From the end of each path a curve of the fifth degree leads to the beginning of the next, as long as its speed,
/// acceleration, jerk, climb, sink and slope need it and a turn of at most 90° a second; each is told. Where one curve
/// does not keep the limits, it stops on its way. Planes, boats and cars go round corners, as through waypoints, from
/// where they have come to rest. Position, velocity and acceleration are continuous (FEEDS.md 2.6), as are heading,
/// roll and pitch with both derivatives. Each step's vehicle stands as such; it becomes the next one on the curve
/// between.
/// @param vehicle whose limits joints keep, unless both steps are of another class: then those of the step that is left
/// @param loop after the last path comes the first one again
/// No plan: a path without an end that is not the last one; no curve within the limits.
PathPlanResult plan_sequence(const std::vector<SequenceStep>& steps, const VehicleLimits& vehicle, bool loop);

}  // namespace skyloop
