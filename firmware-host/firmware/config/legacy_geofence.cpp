// CFG-GEOFENCE (M8 interface description).
#include "firmware/config/config_keys.hpp"
#include "firmware/config/legacy_support.hpp"
#include "firmware/geofence.hpp"
#include "receiver/protocol/ubx_cfg_navigation.hpp"

namespace skyloop::firmware {
namespace {

CfgGeofence describe_fences(const LegacyContext& context) {
    CfgGeofence message;
    message.conf_lvl = in_force<std::uint8_t>(context, key::geofence_confidence);
    message.pio_enabled = in_force<std::uint8_t>(context, key::geofence_use_pio);
    message.pin_polarity = in_force<std::uint8_t>(context, key::geofence_polarity);
    message.pin = in_force<std::uint8_t>(context, key::geofence_pin);
    for (std::uint32_t number = 1; number <= most_fences; ++number) {
        const FenceKeys fence(number);
        if (!context.store.flag(fence.use)) continue;
        message.fences.push_back({in_force<std::int32_t>(context, fence.latitude),
                                  in_force<std::int32_t>(context, fence.longitude),
                                  in_force<std::uint32_t>(context, fence.radius)});
    }
    return message;
}

}  // namespace

// The fences of the message are the first ones; others are off then.
ConfigOutcome legacy_geofence(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return legacy_answered(describe_fences(context));
    const auto set = decode_payload<CfgGeofence>(payload);
    if (!set || set->version != 0 || set->fences.size() > most_fences) return legacy_refused();
    LegacyChanges changes(context);
    changes.put(key::geofence_confidence, set->conf_lvl);
    changes.put(key::geofence_use_pio, static_cast<std::uint8_t>(set->pio_enabled & 1));
    changes.put(key::geofence_polarity, set->pin_polarity);
    changes.put(key::geofence_pin, set->pin);
    for (std::uint32_t number = 1; number <= most_fences; ++number) {
        const FenceKeys fence(number);
        const bool is_on = number <= set->fences.size();
        changes.put(fence.use, is_on);
        if (!is_on) continue;
        const CfgGeofenceItem& circle = set->fences[number - 1];
        changes.put(fence.latitude, circle.lat);
        changes.put(fence.longitude, circle.lon);
        changes.put(fence.radius, circle.radius);
    }
    return changes.apply();
}

}  // namespace skyloop::firmware
