/// Echoes that come and go.
#pragma once

#include "run/fault/fault_kind.hpp"

namespace skyloop {

/// "multipath_burst".
extern const FaultKind multipath_burst_fault;

}  // namespace skyloop
