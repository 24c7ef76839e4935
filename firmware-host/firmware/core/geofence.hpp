/// Circles on the ground, and whether the receiver is inside (F9 interface description, UBX-NAV-GEOFENCE).
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/core/navigation_state.hpp"

namespace skyloop::firmware {

/// As NAV-GEOFENCE numbers them.
enum class FenceState : std::uint8_t { unknown = 0, inside = 1, outside = 2 };
struct Fence {
    std::uint8_t number = 1;
    FenceState state = FenceState::unknown;
};

/// The fences that are on. A position that is nearer to the line than so many of its standard deviations is on no side
/// for certain.
std::vector<Fence> fences_of(const ReceiverConfig& config, const NavigationState& state);
/// Inside of one at least, or outside of all.
FenceState combined_state(const std::vector<Fence>& fences);

}  // namespace skyloop::firmware
