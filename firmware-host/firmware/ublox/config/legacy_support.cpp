#include "firmware/ublox/config/legacy_support.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "firmware/ublox/config/config_handler.hpp"
#include "firmware/ublox/config/legacy_keys.hpp"

namespace skyloop::firmware {
namespace {

/// A lock leaves up to two groups open (F9 interface description, CFG-SEC-CFG_LOCK).
bool touches_locked_group(const LegacyContext& context,
                          std::span<const std::pair<std::uint32_t, std::uint64_t>> values) {
    if (!is_locked(context)) return false;
    return std::ranges::any_of(values, [&](const auto& one) {
        const std::uint32_t group = one.first >> 16 & 0xFF;
        return group != context.store.value(legacy_key::unlocked_group_1) &&
               group != context.store.value(legacy_key::unlocked_group_2);
    });
}

}  // namespace

bool is_locked(const LegacyContext& context) { return context.store.flag(legacy_key::lock); }

void LegacyChanges::put_raw(std::uint32_t key, std::uint64_t value) {
    if (context_.store.has(key)) values_.emplace_back(key, value);
}

void LegacyChanges::put_bits(std::span<const BitKey> keys, std::uint32_t bits) {
    for (const BitKey& one : keys)
        put(one.key, (bits >> one.bit & 1) != 0);
}

ConfigValues LegacyChanges::result() const {
    ConfigValues ram = context_.store.values(ConfigLayer::ram);
    for (const auto& [key, value] : values_)
        ram.insert_or_assign(key, value);
    return ram;
}

ConfigOutcome LegacyChanges::apply(Seconds work) const {
    for (const auto& [key, value] : values_)
        if (!is_in_range(context_.board, key, value)) return legacy_refused();
    if (touches_locked_group(context_, values_)) return legacy_refused();
    if (!is_consistent(context_.board, result())) return legacy_refused();
    for (const auto& [key, value] : values_)
        if (context_.store.value(key) != value) context_.store.set(in_ram, key, value);
    return legacy_taken(work);
}

std::uint32_t bits_in_force(const LegacyContext& context, std::span<const BitKey> keys) {
    std::uint32_t bits = 0;
    for (const BitKey& one : keys)
        if (context.store.flag(one.key)) bits |= 1u << one.bit;
    return bits;
}

bool has_port(const BoardProfile& board, std::uint8_t port_id) {
    return std::ranges::any_of(board.ports, [&](PortId port) { return static_cast<std::uint8_t>(port) == port_id; });
}

int protocol_version(const BoardProfile& board) {
    constexpr std::string_view word = "PROTVER";  // followed by '=' or, on old receivers, a space (RECEIVER.md 2.1)
    for (const std::string& extension : board.identity.extensions) {
        if (!extension.starts_with(word) || extension.size() <= word.size() + 1) continue;
        int whole = 0, hundredths = 0;
        const char* const end = extension.data() + extension.size();
        const auto read = std::from_chars(extension.data() + word.size() + 1, end, whole);
        if (read.ec != std::errc{}) continue;
        if (read.ptr != end && *read.ptr == '.') std::from_chars(read.ptr + 1, end, hundredths);
        return whole * 100 + hundredths;
    }
    return 0;
}

bool has_flash(const BoardProfile& board) {
    const std::string& software = board.identity.software;
    return board.identity.generation <= 7 ? software.starts_with("EXT") : !software.starts_with("ROM");
}

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
