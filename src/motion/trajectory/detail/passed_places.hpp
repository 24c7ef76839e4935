// Places of a route that its vehicle goes past, because it cannot turn there.
#pragma once

#include <cstddef>
#include <vector>

#include "motion/trajectory/waypoint_plan.hpp"

namespace skyloop {

// Places that lie at another height than the one before, straight above or below it.
struct LeftOutAbove {
    std::size_t count = 0;
    double most = 0;  // of height, m
};

// Places above one another become one, at the height of the last; those above the first at the height of that, for
// there the way begins.
LeftOutAbove leave_out_same_ground(std::vector<PlannedWaypoint>& waypoints);

struct PassedPlaces {
    std::size_t count = 0;
    double farthest = 0;  // from the straight way between those beside it, m
};

// Leaves out places until every turn fits, but for the first and the last. Of neighbours that do not fit only the first
// goes at a time: without it the turn at the next one is another. Takes time in proportion to the places, for after the
// first look only those beside a place that is gone are looked at again.
// waypoints: after leave_out_same_ground(), and so afterwards
PassedPlaces pass_by_tight_turns(std::vector<PlannedWaypoint>& waypoints, const VehicleLimits& vehicle);

}  // namespace skyloop
