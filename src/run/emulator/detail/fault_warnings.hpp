/// Faults and commands of a scenario of which nothing will be seen.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "run/emulator/station.hpp"
#include "run/scenario/scenario.hpp"
#include "world/gnss/navigation_source.hpp"

namespace skyloop {

/// What a fault is for and the run does not have: satellites and signals that no receiver tracks as it starts, a pair
/// of antennas, an ionosphere, echoes, a clock. One sentence for each such fault.
/// So are commands of live runs. @param virtual_time the run has no clock beside it
std::vector<std::string> idle_fault_warnings(const Scenario& scenario, const NavigationSource& navigation,
                                             std::span<const Station> stations, bool virtual_time);

}  // namespace skyloop
