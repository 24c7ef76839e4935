/// Which signals the numbers of multiple signal messages mean.
#pragma once

#include <optional>

#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline receiver {

/// The system of a multiple signal message, 1071 … 1137 (RTCM 10403.3, table 3.5-71); nothing for other numbers.
std::optional<Constellation> msm_constellation(int number);

/// The carrier of a DF395 number, however it is tracked (RTCM 10403.3, tables 3.5-91, 3.5-96, 3.5-99, 3.5-105, 3.5-108,
/// 3.5-108.3; amendment of NavIC): 1C, 1P and 1W of GPS are all L1. Nothing for signals that are not emulated.
std::optional<Signal> msm_carrier(Constellation constellation, int number);

}  // namespace skyloop::inline receiver
