/// Echoes that come and go.
#pragma once

#include "run/fault/fault_kind.hpp"

namespace skyloop {

/// "multipath_burst".
FaultKind multipath_burst_fault_kind();

}  // namespace skyloop
