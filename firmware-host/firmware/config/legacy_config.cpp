#include <algorithm>

#include "firmware/config/config_handler.hpp"
#include "firmware/config/legacy_support.hpp"

namespace skyloop::firmware {
namespace {

struct LegacyEntry {
    UbxMessageId message;
    LegacyHandler handler;
};

constexpr LegacyEntry legacy_entries[] = {
    {{0x06, 0x00}, legacy_prt},   {{0x06, 0x01}, legacy_msg},       {{0x06, 0x02}, legacy_inf},
    {{0x06, 0x06}, legacy_dat},   {{0x06, 0x34}, legacy_rinv},      {{0x06, 0x3B}, legacy_pm2},
    {{0x06, 0x08}, legacy_rate},  {{0x06, 0x09}, legacy_cfg},       {{0x06, 0x11}, legacy_rxm},
    {{0x06, 0x13}, legacy_ant},   {{0x06, 0x16}, legacy_sbas},      {{0x06, 0x17}, legacy_nmea},
    {{0x06, 0x1B}, legacy_usb},   {{0x06, 0x1E}, legacy_odo},       {{0x06, 0x23}, legacy_navx5},
    {{0x06, 0x24}, legacy_nav5},  {{0x06, 0x31}, legacy_tp5},       {{0x06, 0x39}, legacy_itfm},
    {{0x06, 0x3E}, legacy_gnss},  {{0x06, 0x47}, legacy_logfilter}, {{0x06, 0x69}, legacy_geofence},
    {{0x06, 0x70}, legacy_dgnss}, {{0x06, 0x71}, legacy_tmode3},    {{0x06, 0x86}, legacy_pms},
};

}  // namespace

ConfigOutcome LegacyConfig::handle(UbxMessageId message, ByteSpan payload, PortId from) {
    const auto known = board_.legacy.find(message);
    if (known == board_.legacy.end() || known->second == LegacyAnswer::refuse) return legacy_refused();
    if (known->second == LegacyAnswer::silence) return {.answers = {}, .verdict = Verdict::silence};
    if (known->second == LegacyAnswer::ignore) return legacy_taken();
    const auto* const entry = std::ranges::find(legacy_entries, message, &LegacyEntry::message);
    if (entry == std::end(legacy_entries)) return legacy_refused();
    return entry->handler({board_, store_, from}, payload);
}

}  // namespace skyloop::firmware
