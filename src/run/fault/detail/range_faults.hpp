/// Measurements that are wrong in the receiver.
#pragma once

#include <vector>

#include "run/fault/fault_kind.hpp"

namespace skyloop {

/// "pseudorange_step", "pseudorange_ramp", "cycle_slips".
std::vector<FaultKind> range_fault_kinds();

}  // namespace skyloop
