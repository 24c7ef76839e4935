/// Circles on the ground, and whether the receiver is inside (F9 interface description, UBX-NAV-GEOFENCE).
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/config/config_store.hpp"
#include "firmware/navigation_state.hpp"

namespace skyloop::firmware {

/// The items of a fence, CFG-GEOFENCE-USE_FENCE1 … RAD and so on. @param number 1 … most_fences
struct FenceKeys {
    explicit constexpr FenceKeys(std::uint32_t number)
        : use(0x1024'0010u + 0x10 * number),
          latitude(0x4024'0011u + 0x10 * number),
          longitude(0x4024'0012u + 0x10 * number),
          radius(0x4024'0013u + 0x10 * number) {}
    std::uint32_t use, latitude, longitude, radius;
};
inline constexpr std::uint32_t most_fences = 4;

/// As NAV-GEOFENCE numbers them.
enum class FenceState : std::uint8_t { unknown = 0, inside = 1, outside = 2 };
struct Fence {
    std::uint8_t number = 1;
    FenceState state = FenceState::unknown;
};

/// The fences that are on. A position that is nearer to the line than its standard deviation times CFG-GEOFENCE-CONFLVL
/// is on no side for certain.
std::vector<Fence> fences_of(const ConfigStore& config, const NavigationState& state);
/// Inside of one at least, or outside of all.
FenceState combined_state(const std::vector<Fence>& fences);

}  // namespace skyloop::firmware
