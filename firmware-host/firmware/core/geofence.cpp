#include "firmware/core/geofence.hpp"

#include <algorithm>

#include "base/geo/geodetic.hpp"

namespace skyloop::firmware {
namespace {

FenceState state_in(const FenceArea& area, double confidence, const Fix& fix) {
    const double from_centre = geodesic_between(area.centre, fix.position).length.value();
    const double radius = area.radius.value();
    const double band = confidence * fix.horizontal_accuracy.value();
    if (from_centre + band <= radius) return FenceState::inside;
    return from_centre - band > radius ? FenceState::outside : FenceState::unknown;
}

}  // namespace

std::vector<Fence> fences_of(const ReceiverConfig& config, const NavigationState& state) {
    const Fix& fix = state.epoch.fix;
    const bool placed = fix.has_position() && state.fix_ok;
    std::vector<Fence> fences;
    for (const FenceArea& area : config.fences)
        fences.push_back({area.number, placed ? state_in(area, config.fence_confidence, fix) : FenceState::unknown});
    return fences;
}

FenceState combined_state(const std::vector<Fence>& fences) {
    const auto is = [](FenceState state) { return [state](const Fence& f) { return f.state == state; }; };
    if (std::any_of(fences.begin(), fences.end(), is(FenceState::inside))) return FenceState::inside;
    const bool outside = !fences.empty() && std::all_of(fences.begin(), fences.end(), is(FenceState::outside));
    return outside ? FenceState::outside : FenceState::unknown;
}

}  // namespace skyloop::firmware
