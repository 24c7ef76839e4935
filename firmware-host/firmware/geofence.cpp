#include "firmware/geofence.hpp"

#include <algorithm>

#include "base/geo/geodetic.hpp"
#include "firmware/config/config_keys.hpp"

namespace skyloop::firmware {
namespace {

FenceState state_in(const ConfigStore& config, const FenceKeys& fence, const Fix& fix) {
    const auto degrees = [&](std::uint32_t item) { return static_cast<double>(config.signed_value(item)) * 1e-7; };
    const Geodetic centre = Geodetic::degrees(degrees(fence.latitude), degrees(fence.longitude), 0);
    const double from_centre = geodesic_between(centre, fix.position).length.value();
    const double radius = static_cast<double>(config.value(fence.radius)) / 100;
    const double band = static_cast<double>(config.value(key::geofence_confidence)) * fix.horizontal_accuracy.value();
    if (from_centre + band <= radius) return FenceState::inside;
    return from_centre - band > radius ? FenceState::outside : FenceState::unknown;
}

}  // namespace

std::vector<Fence> fences_of(const ConfigStore& config, const NavigationState& state) {
    const Fix& fix = state.epoch.fix;
    const bool placed = fix.has_position() && state.fix_ok;
    std::vector<Fence> fences;
    for (std::uint32_t number = 1; number <= most_fences; ++number) {
        const FenceKeys keys(number);
        if (!config.has(keys.use) || !config.flag(keys.use)) continue;
        fences.push_back(
            {static_cast<std::uint8_t>(number), placed ? state_in(config, keys, fix) : FenceState::unknown});
    }
    return fences;
}

FenceState combined_state(const std::vector<Fence>& fences) {
    const auto is = [](FenceState state) { return [state](const Fence& f) { return f.state == state; }; };
    if (std::any_of(fences.begin(), fences.end(), is(FenceState::inside))) return FenceState::inside;
    const bool outside = !fences.empty() && std::all_of(fences.begin(), fences.end(), is(FenceState::outside));
    return outside ? FenceState::outside : FenceState::unknown;
}

}  // namespace skyloop::firmware
