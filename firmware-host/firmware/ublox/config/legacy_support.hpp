/// What the legacy configuration messages have in common (RECEIVER.md 3.3, 4.1): a handler for each, and settings that
/// are taken as a whole or not at all.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "firmware/ublox/config/config_handler.hpp"
#include "receiver/protocol/ubx_fields.hpp"

namespace skyloop::firmware {

/// Who answers, with what, and by which port the message came in.
struct LegacyContext {
    const BoardProfile& board;
    ConfigStore& store;
    PortId from = PortId::uart1;
};

/// One bit of a message's field, and the logical item behind it.
struct BitKey {
    unsigned bit = 0;
    std::uint32_t key = 0;
};

/// What a setting writes: nothing until apply(), then all of it. Items that the board does not have are left out.
/// State: the values gathered so far.
class LegacyChanges {
public:
    explicit LegacyChanges(const LegacyContext& context) : context_(context) {}

    /// Negative values become their two's complement in the size of `T`.
    template <std::integral T>
    void put(std::uint32_t key, T value) {
        if constexpr (std::same_as<T, bool>)
            put_raw(key, value ? 1 : 0);
        else
            put_raw(key, static_cast<std::make_unsigned_t<T>>(value));
    }
    template <class Raw>
    void put(std::uint32_t key, const RawNumber<Raw>& field) {
        put(key, field.raw);
    }
    void put_bits(std::span<const BitKey> keys, std::uint32_t bits);
    /// These two under the names that LegacyFields has as well.
    template <class Field>
    void link(std::uint32_t key, const Field& field) {
        put(key, field);
    }
    void link(std::span<const BitKey> keys, std::uint32_t bits) { put_bits(keys, bits); }
    /// RAM as it would be.
    [[nodiscard]] ConfigValues result() const;
    /// Refuses, and changes nothing, when a value is out of range or the whole would not be consistent.
    /// @param work that taking them needs
    ConfigOutcome apply(Seconds work = Seconds{0}) const;

private:
    void put_raw(std::uint32_t key, std::uint64_t value);

    LegacyContext context_;
    std::vector<std::pair<std::uint32_t, std::uint64_t>> values_;
};

inline ConfigOutcome legacy_refused() { return {.answers = {}, .verdict = Verdict::refuse}; }
inline ConfigOutcome legacy_taken(Seconds work = Seconds{0}) {
    return {.answers = {}, .verdict = Verdict::acknowledge, .work = work};
}
/// What a poll gets: the message, then ACK-ACK.
template <class Message>
ConfigOutcome legacy_answered(const Message& message) {
    return {.answers = {encode_frame(message)}, .verdict = Verdict::acknowledge};
}

/// What is in force, cut to the type of a message's field.
template <std::integral T>
T in_force(const LegacyContext& context, std::uint32_t key) {
    return static_cast<T>(context.store.value(key));
}
std::uint32_t bits_in_force(const LegacyContext& context, std::span<const BitKey> keys);
/// What a poll shows: link() brings what is in force into a field. A link_… function says with it, and with
/// LegacyChanges for a setting, which field of a message is which item.
class LegacyFields {
public:
    explicit LegacyFields(const LegacyContext& context) : context_(context) {}
    template <std::integral T>
    void link(std::uint32_t key, T& field) {
        field = in_force<T>(context_, key);
    }
    template <class Raw>
    void link(std::uint32_t key, RawNumber<Raw>& field) {
        link(key, field.raw);
    }
    template <class Raw>
    void link(std::span<const BitKey> keys, RawNumber<Raw>& field) {
        field.raw = static_cast<Raw>(bits_in_force(context_, keys));
    }

private:
    const LegacyContext& context_;
};
/// The answer to a poll. @param message what its fields hold that are no items @param link of its other fields
template <class Message, class Link>
ConfigOutcome legacy_poll(const LegacyContext& context, Message message, Link link) {
    LegacyFields fields(context);
    link(message, fields);
    return legacy_answered(message);
}
/// Takes a setting all of whose fields are linked.
template <class Message, class Link>
ConfigOutcome legacy_set(const LegacyContext& context, const Message& message, Link link) {
    LegacyChanges changes(context);
    link(message, changes);
    return changes.apply();
}

/// Whether the configuration is locked (CFG-SEC-CFG_LOCK).
bool is_locked(const LegacyContext& context);
/// Whether the board has the port.
bool has_port(const BoardProfile& board, std::uint8_t port_id);
/// The protocol version that a board names in its MON-VER extensions, in hundredths (18.00 is 1800); 0 when it does
/// not say.
int protocol_version(const BoardProfile& board);
/// Whether the board keeps configuration in flash: swVersion says from M8 on that firmware runs from ROM, before that
/// it does not.
bool has_flash(const BoardProfile& board);

using LegacyHandler = ConfigOutcome (*)(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_prt(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_msg(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_inf(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_usb(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_rate(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_nav5(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_navx5(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_odo(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_dgnss(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_tmode3(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_gnss(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_sbas(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_nmea(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_cfg(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_tp5(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_itfm(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_pms(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_rxm(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_ant(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_dat(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_pm2(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_rinv(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_geofence(const LegacyContext& context, ByteSpan payload);
ConfigOutcome legacy_logfilter(const LegacyContext& context, ByteSpan payload);

}  // namespace skyloop::firmware
