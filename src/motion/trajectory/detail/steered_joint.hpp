// From where a plane, a boat or a car has come to rest to where it begins anew.
#pragma once

#include "motion/trajectory/local_shape.hpp"
#include "motion/trajectory/vehicle.hpp"

namespace skyloop {

// Ahead from where it stands, round corners, and ahead into where it is to stand, in both of which it is at rest and
// level. Nothing where no such way of a reasonable length keeps the vehicle's turns, slope, climb and sink.
std::shared_ptr<const LocalShape> steered_joint(const LocalMotion& from, const LocalMotion& to,
                                                const VehicleLimits& vehicle);

}  // namespace skyloop
