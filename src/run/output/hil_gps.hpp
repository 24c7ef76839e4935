/// What a receiver reports, as PX4's simulators tell it.
#pragma once

#include "firmware/navigation_state.hpp"
#include "receiver/protocol/mavlink_vehicle.hpp"
#include "run/output/output_settings.hpp"

namespace skyloop {

/// HIL_GPS of MAVLink's common.xml. Its values without a fix: fix type 1 and, but for the time while it is known, those
/// that mean unknown. Fix types above 3D are told as 3D, the highest that it has. Velocities beyond the fields are
/// their limits (327.67 m/s, over ground 655.34 m/s).
MavlinkHilGps mavlink_hil_gps(const firmware::NavigationState& state, HilGpsAccuracy accuracy);

}  // namespace skyloop
