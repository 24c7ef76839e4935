/// Signals in empty space: the start of everything that arrives.
#pragma once

#include "base/core/units.hpp"
#include "world/flow/arrivals.hpp"
#include "world/flow/sky_view.hpp"

namespace skyloop {

/// 20 log10(4π d f / c) (MODELS.md 3.6, L_s).
Decibels free_space_loss(Metres distance, Hertz carrier);

/// The carrier of the satellite's first signal; L1 for a satellite without signals.
Hertz first_carrier(const Arrival& arrival);

/// One arrival for each satellite of `sky`, in its order: in line of sight, without delay, weakened by distance alone.
Arrivals free_space(const SkyView& sky);

}  // namespace skyloop
