/// Which signals the numbers of multiple signal messages mean.
#pragma once

#include <optional>

#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline receiver {

/// The system of a multiple signal message, 1071 … 1137 (RTCM 10403.3, table 3.5-71); nothing for other numbers.
std::optional<Constellation> msm_constellation(int number);

/// The number of the message of a system of kind 1 … 7: 1077 of GPS.
int msm_number(Constellation constellation, int kind);

/// DF394, 1 … 64: of SBAS PRN 120 is the first (RTCM 10403.3, table 3.5-101), S20 of RINEX.
int msm_satellite(SatelliteId satellite);
/// Its inverse.
SatelliteId satellite_of_msm(Constellation constellation, int number);

/// DF395 of a signal as receivers here track it (tables as below, 3.5-102 of SBAS): 1C, 2L, 5Q; 0 for none.
int msm_signal(Constellation constellation, Signal signal);

/// The carrier of a DF395 number, however it is tracked (RTCM 10403.3, tables 3.5-91, 3.5-96, 3.5-99, 3.5-105, 3.5-108,
/// 3.5-108.3; amendment of NavIC): 1C, 1P and 1W of GPS are all L1. Nothing for signals that are not emulated.
std::optional<Signal> msm_carrier(Constellation constellation, int number);

}  // namespace skyloop::inline receiver
