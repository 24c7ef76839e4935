/// A jammer.
#pragma once

#include "run/fault/fault_kind.hpp"

namespace skyloop {

/// "jamming": told by J/S at the antenna, or by where the jammer stands and how strong it is.
extern const FaultKind jamming_fault;

}  // namespace skyloop
