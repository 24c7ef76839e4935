/// Faults of what is reported while the receiver itself knows better.
#pragma once

#include <vector>

#include "run/fault/fault_kind.hpp"

namespace skyloop {

std::vector<FaultKind> report_fault_kinds();  ///< of places, types of fix, headings, satellites
std::vector<FaultKind> epoch_fault_kinds();   ///< of whole epochs: missing, twice, out of order

}  // namespace skyloop
