#include "firmware/config/legacy_support.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "firmware/config/legacy_keys.hpp"

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

}  // namespace skyloop::firmware
