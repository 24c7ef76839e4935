/// Faults of what is reported while the receiver itself knows better.
#pragma once

#include <vector>

#include "run/fault/fault_kind.hpp"

namespace skyloop {

/// Of places, types of fix, headings, satellites, and of whole epochs: missing, twice, out of order.
std::vector<FaultKind> report_fault_kinds();

}  // namespace skyloop
