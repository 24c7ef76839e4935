/// Faults that worsen a direction of a wire.
#pragma once

#include <functional>
#include <string_view>

#include "run/fault/fault_kind.hpp"

namespace skyloop::inline run {

/// Worsens one direction at a moment whose strength is above zero.
using WireWorsening = std::function<void(WireDirection&, const FaultMoment&)>;

/// What the parameter `direction` takes.
inline constexpr std::string_view wire_directions[] = {"to_client", "to_receiver", "both"};

/// The fault that does so in the direction, or both, that the parameters choose.
Fault worsened(const Parameters& parameters, WireWorsening worsen);

/// Of two independent causes at least one strikes.
inline void combine(double& probability, double with) { probability = 1 - (1 - probability) * (1 - with); }

}  // namespace skyloop::inline run
