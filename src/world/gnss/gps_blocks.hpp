/// Which blocks of satellites send under the PRNs of GPS, and with that which civil signals.
#pragma once

#include "base/time/gps_time.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop {

/// Whether the satellite that has a PRN at a time sends L1, L2C or L5. Of the blocks, IIR-M is the first with L2C, IIF
/// the first with L5 (IS-GPS-200, IS-GPS-705). A satellite counts from its launch on; one that will come under a PRN of
/// today's Block IIR sends what that sends.
/// @param prn 1 … 32; above it: all signals
bool gps_sends(int prn, Signal signal, GpsTime when);

}  // namespace skyloop
