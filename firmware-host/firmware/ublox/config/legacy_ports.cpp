// CFG-PRT, CFG-MSG, CFG-INF, CFG-USB: what comes in and goes out by which port (RECEIVER.md 3.3).
// CFG-NMEA in its three forms (RECEIVER.md 3.3).

#include <algorithm>
#include <optional>

#include "firmware/core/board_profile.hpp"
#include "firmware/ublox/config/legacy_keys.hpp"
#include "firmware/ublox/config/legacy_support.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_cfg_device.hpp"

namespace skyloop::firmware {
namespace {

/// Bits of CFG-PRT's masks with the items of the protocol groups; RTCM2 has no item of u-blox.
constexpr BitKey in_mask_items[] = {{0, 1}, {1, 2}, {5, 4}, {6, 5}};
constexpr BitKey out_mask_items[] = {{0, 1}, {1, 2}, {5, 4}};
constexpr unsigned rtcm2_bit = 2;

bool knows_rtcm2(const LegacyContext& context) { return context.board.identity.generation <= 8; }

std::uint16_t in_mask(const LegacyContext& context, PortId port) {
    unsigned mask = 0;
    for (const auto& [bit, item] : in_mask_items)
        if (context.store.flag(key::in_protocol(port, item))) mask |= 1u << bit;
    if (knows_rtcm2(context) && context.store.flag(legacy_key::rtcm2_in(port))) mask |= 1u << rtcm2_bit;
    return static_cast<std::uint16_t>(mask);
}

std::uint16_t out_mask(const LegacyContext& context, PortId port) {
    unsigned mask = 0;
    for (const auto& [bit, item] : out_mask_items)
        if (context.store.flag(key::out_protocol(port, item))) mask |= 1u << bit;
    return static_cast<std::uint16_t>(mask);
}

/// Fields of the mode of a UART (M8 interface description 32.11.23.1) in the order of the values of CFG-UART1-STOPBITS
/// (half, one, one and a half, two), -DATABITS (eight, seven) and -PARITY (none, odd, even).
constexpr std::uint32_t mode_of_stop_bits[] = {3, 0, 1, 2};
constexpr std::uint32_t mode_of_data_bits[] = {3, 2};
constexpr std::uint32_t mode_of_parity[] = {4, 1, 0};

template <std::size_t Size>
std::uint32_t to_mode(const std::uint32_t (&fields)[Size], std::uint64_t value) {
    return fields[std::min<std::uint64_t>(value, Size - 1)];
}

template <std::size_t Size>
std::optional<std::uint8_t> from_mode(const std::uint32_t (&fields)[Size], std::uint32_t field) {
    const auto* const found = std::ranges::find(fields, field);
    if (found == std::end(fields)) return std::nullopt;
    return static_cast<std::uint8_t>(found - std::begin(fields));
}

std::uint32_t uart_mode(const LegacyContext& context, PortId port) {
    const ConfigStore& store = context.store;
    return to_mode(mode_of_data_bits, store.value(legacy_key::uart_data_bits(port))) << 6 |
           to_mode(mode_of_parity, store.value(legacy_key::uart_parity(port))) << 9 |
           to_mode(mode_of_stop_bits, store.value(legacy_key::uart_stop_bits(port))) << 12 |
           (store.flag(legacy_key::mode_bit_4(port)) ? 0x10u : 0u);
}

std::uint32_t spi_mode(const LegacyContext& context) {
    const auto flag = [&](std::uint32_t key) { return context.store.flag(key) ? 1u : 0u; };
    return flag(legacy_key::spi_phase) << 1 | flag(legacy_key::spi_polarity) << 2 |
           (in_force<std::uint32_t>(context, legacy_key::spi_max_ff) & 0x3F) << 8;
}

CfgPrtItem describe_port(const LegacyContext& context, PortId port) {
    CfgPrtItem item;
    item.port_id = static_cast<std::uint8_t>(port);
    item.tx_ready = in_force<std::uint16_t>(context, legacy_key::tx_ready(port));
    item.in_proto_mask = in_mask(context, port);
    item.out_proto_mask = out_mask(context, port);
    if (is_uart(port)) {
        item.mode = uart_mode(context, port);
        item.baud_rate = in_force<std::uint32_t>(context, legacy_key::uart_baud(port));
    } else if (port == PortId::i2c) {
        item.mode = in_force<std::uint32_t>(context, legacy_key::i2c_address);
        item.flags = context.store.flag(legacy_key::i2c_extended_timeout) ? 2 : 0;
    } else if (port == PortId::spi) {
        item.mode = spi_mode(context);
        item.flags = context.store.flag(legacy_key::spi_extended_timeout) ? 2 : 0;
    }
    return item;
}

/// False when the receiver cannot do the format.
bool put_uart(LegacyChanges& changes, PortId port, const CfgPrtItem& item) {
    const auto data_bits = from_mode(mode_of_data_bits, item.mode >> 6 & 3);
    const std::uint32_t parity_field = item.mode >> 9 & 7;
    const auto parity = from_mode(mode_of_parity, parity_field == 5 ? 4 : parity_field);  // 10x: none
    const auto stop_bits = from_mode(mode_of_stop_bits, item.mode >> 12 & 3);
    if (!data_bits || !parity || !stop_bits) return false;
    changes.put(legacy_key::uart_data_bits(port), *data_bits);
    changes.put(legacy_key::uart_parity(port), *parity);
    changes.put(legacy_key::uart_stop_bits(port), *stop_bits);
    changes.put(legacy_key::mode_bit_4(port), (item.mode & 0x10) != 0);
    changes.put(legacy_key::uart_baud(port), item.baud_rate);
    return true;
}

bool put_port(const LegacyContext& context, LegacyChanges& changes, const CfgPrtItem& item) {
    if (!has_port(context.board, item.port_id)) return false;
    const auto port = static_cast<PortId>(item.port_id.raw);
    if (is_uart(port)) {
        const auto& bauds = context.board.bauds;
        if (item.baud_rate == 0 || (!bauds.empty() && std::ranges::find(bauds, item.baud_rate.raw) == bauds.end()))
            return false;
        if (!put_uart(changes, port, item)) return false;
    } else if (port == PortId::i2c) {
        changes.put(legacy_key::i2c_address, static_cast<std::uint8_t>(item.mode & 0xFE));
        changes.put(legacy_key::i2c_extended_timeout, (item.flags & 2) != 0);
    } else if (port == PortId::spi) {
        changes.put(legacy_key::spi_phase, (item.mode & 2) != 0);
        changes.put(legacy_key::spi_polarity, (item.mode & 4) != 0);
        changes.put(legacy_key::spi_max_ff, static_cast<std::uint8_t>(item.mode >> 8 & 0x3F));
        changes.put(legacy_key::spi_extended_timeout, (item.flags & 2) != 0);
    }
    changes.put(legacy_key::tx_ready(port), item.tx_ready);
    for (const auto& [bit, protocol] : in_mask_items)
        changes.put(key::in_protocol(port, protocol), (item.in_proto_mask >> bit & 1) != 0);
    for (const auto& [bit, protocol] : out_mask_items)
        changes.put(key::out_protocol(port, protocol), (item.out_proto_mask >> bit & 1) != 0);
    changes.put(legacy_key::rtcm2_in(port), (item.in_proto_mask >> rtcm2_bit & 1) != 0);
    return true;
}

ConfigOutcome poll_rates(const LegacyContext& context, UbxMessageId message) {
    if (!knows(context.board, message)) return legacy_refused();
    CfgMsg answer{message.message_class, message.id, {}};
    if (sends(context.board, message))
        for (std::size_t port = 0; port < ublox_port_count; ++port)
            answer.rates[port] = static_cast<std::uint8_t>(context.store.rate(message, static_cast<PortId>(port)));
    return legacy_answered(answer);
}

std::uint32_t inf_key(std::uint8_t protocol, PortId port) {
    return protocol == 0 ? key::inf_ubx(port) : key::inf_nmea(port);
}

/// UBX and NMEA have texts. What others have is zeros, in the configuration files that u-center wrote of a NEO-6 (3,
/// raw data) and of a ZED-F9P (3, and 12 to 15).
enum class Texts : std::uint8_t { none, empty, told };
Texts texts_of(const BoardProfile& board, std::uint8_t protocol) {
    if (protocol <= 1) return Texts::told;
    const bool high_precision = std::ranges::any_of(
        board.identity.extensions, [](const std::string& text) { return text.starts_with("FWVER=HPG"); });
    const bool old = board.identity.generation <= 6;
    if (protocol == 3) return old || high_precision ? Texts::empty : Texts::none;
    return high_precision && protocol >= 12 && protocol <= 15 ? Texts::empty : Texts::none;
}

/// Texts of CFG-USB lie in four items of eight characters, the first character lowest.
std::array<std::uint8_t, 32> usb_text(const LegacyContext& context, std::uint32_t first_key) {
    std::array<std::uint8_t, 32> text{};
    for (std::size_t i = 0; i < text.size(); ++i)
        text[i] = static_cast<std::uint8_t>(
            context.store.value(first_key + static_cast<std::uint32_t>(i / 8)) >> (8 * (i % 8)) & 0xFF);
    return text;
}

void put_usb_text(LegacyChanges& changes, std::uint32_t first_key, const std::array<std::uint8_t, 32>& text) {
    for (std::uint32_t part = 0; part < 4; ++part) {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < 8; ++i)
            value |= std::uint64_t{text[8 * part + i]} << (8 * i);
        changes.put(first_key + part, value);
    }
}

}  // namespace

ConfigOutcome legacy_prt(const LegacyContext& context, ByteSpan payload) {
    if (payload.size() <= 1) {
        const std::uint8_t port = payload.empty() ? static_cast<std::uint8_t>(context.from) : payload[0];
        if (!has_port(context.board, port)) return legacy_refused();
        return legacy_answered(CfgPrt{{describe_port(context, static_cast<PortId>(port))}});
    }
    const auto set = decode_payload<CfgPrt>(payload);
    if (!set) return legacy_refused();
    LegacyChanges changes(context);
    for (const CfgPrtItem& item : set->ports)
        if (!put_port(context, changes, item)) return legacy_refused();
    return changes.apply();
}

ConfigOutcome legacy_msg(const LegacyContext& context, ByteSpan payload) {
    if (const auto poll = decode_payload<CfgMsgPoll>(payload))
        return poll_rates(context, {poll->message_class, poll->id});
    LegacyChanges changes(context);
    UbxMessageId message;
    const auto put_rate = [&](PortId port, std::uint8_t rate) {
        const auto rate_item = rate_key(message, port);
        if (sends(context.board, message) && rate_item) changes.put(*rate_item, rate);
    };
    if (const auto here = decode_payload<CfgMsgCurrentPort>(payload)) {
        message = {here->message_class, here->id};
        put_rate(context.from, here->rate);
    } else if (const auto every = decode_payload<CfgMsg>(payload)) {
        message = {every->message_class, every->id};
        for (std::size_t port = 0; port < ublox_port_count; ++port)
            put_rate(static_cast<PortId>(port), every->rates[port]);
    }
    return knows(context.board, message) ? changes.apply() : legacy_refused();
}

ConfigOutcome legacy_inf(const LegacyContext& context, ByteSpan payload) {
    if (payload.size() == 1) {
        const Texts texts = texts_of(context.board, payload[0]);
        if (texts == Texts::none) return legacy_refused();
        CfgInfItem item;
        item.protocol_id = payload[0];
        for (std::size_t port = 0; port < ublox_port_count && texts == Texts::told; ++port)
            item.masks[port] = in_force<std::uint8_t>(context, inf_key(payload[0], static_cast<PortId>(port)));
        return legacy_answered(CfgInf{{item}});
    }
    const auto set = decode_payload<CfgInf>(payload);
    if (!set) return legacy_refused();
    LegacyChanges changes(context);
    for (const CfgInfItem& item : set->protocols) {
        const Texts texts = texts_of(context.board, item.protocol_id);
        if (texts == Texts::none) return legacy_refused();
        for (std::size_t port = 0; port < ublox_port_count && texts == Texts::told; ++port)
            changes.put(inf_key(item.protocol_id, static_cast<PortId>(port)), item.masks[port]);
    }
    return changes.apply();
}

ConfigOutcome legacy_usb(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) {
        CfgUsb answer;
        answer.vendor_id = in_force<std::uint16_t>(context, legacy_key::usb_vendor_id);
        answer.product_id = in_force<std::uint16_t>(context, legacy_key::usb_product_id);
        answer.power_consumption = in_force<std::uint16_t>(context, legacy_key::usb_power);
        answer.flags = context.store.flag(legacy_key::usb_self_powered) ? 2 : 0;
        answer.vendor_string = usb_text(context, legacy_key::usb_vendor_string);
        answer.product_string = usb_text(context, legacy_key::usb_product_string);
        answer.serial_number = usb_text(context, legacy_key::usb_serial_number);
        return legacy_answered(answer);
    }
    const auto set = decode_payload<CfgUsb>(payload);
    if (!set) return legacy_refused();
    LegacyChanges changes(context);
    changes.put(legacy_key::usb_vendor_id, set->vendor_id);
    changes.put(legacy_key::usb_product_id, set->product_id);
    changes.put(legacy_key::usb_power, set->power_consumption);
    changes.put(legacy_key::usb_self_powered, (set->flags & 2) != 0);
    put_usb_text(changes, legacy_key::usb_vendor_string, set->vendor_string);
    put_usb_text(changes, legacy_key::usb_product_string, set->product_string);
    put_usb_text(changes, legacy_key::usb_serial_number, set->serial_number);
    return changes.apply();
}

namespace {

constexpr BitKey nmea_filter[] = {{0, key::nmea_out_invfix},  {1, key::nmea_out_mskfix},  {2, key::nmea_out_invtime},
                                  {3, key::nmea_out_invdate}, {4, key::nmea_out_onlygps}, {5, key::nmea_out_frozencog}};
constexpr BitKey nmea_flags[] = {
    {0, key::nmea_compat}, {1, key::nmea_consider}, {2, key::nmea_limit82}, {3, key::nmea_highprec}};
constexpr BitKey nmea_gnss_filter[] = {{0, key::nmea_filt_gps},  {1, key::nmea_filt_sbas}, {2, key::nmea_filt_gal},
                                       {4, key::nmea_filt_qzss}, {5, key::nmea_filt_glo},  {6, key::nmea_filt_bds}};

CfgNmeaCore describe_core(const LegacyContext& context) {
    CfgNmeaCore core;
    core.filter = static_cast<std::uint8_t>(bits_in_force(context, nmea_filter));
    const auto* const version =
        std::ranges::find(numbered_nmea_versions, context.store.value(key::nmea_protver), &NumberedNmeaVersion::item);
    if (version != std::end(numbered_nmea_versions)) core.nmea_version = version->wire;
    core.num_sv = in_force<std::uint8_t>(context, key::nmea_maxsvs);
    core.flags = static_cast<std::uint8_t>(bits_in_force(context, nmea_flags));
    return core;
}

constexpr auto link_extension = [](auto& m, auto& v) {
    v.link(nmea_gnss_filter, m.gnss_to_filter);
    v.link(key::nmea_svnumbering, m.sv_numbering);
    v.link(key::nmea_main_talker, m.main_talker_id);
    v.link(key::nmea_gsv_talker, m.gsv_talker_id);
};

CfgNmeaExtension describe_extension(const LegacyContext& context, std::uint8_t version) {
    CfgNmeaExtension extension{.version = version};
    LegacyFields fields(context);
    link_extension(extension, fields);
    return extension;
}

/// Each generation answers in the longest form that it knows.
ConfigOutcome poll_nmea(const LegacyContext& context) {
    const int generation = context.board.identity.generation;
    const CfgNmeaCore core = describe_core(context);
    if (generation <= 6) return legacy_answered(CfgNmeaShort{core});
    if (generation == 7) return legacy_answered(CfgNmeaV0{core, describe_extension(context, 0)});
    CfgNmea answer{core, describe_extension(context, 1), {}, {}};
    const auto talker = in_force<std::uint16_t>(context, key::nmea_bds_talker);
    answer.bds_talker_id = {static_cast<std::uint8_t>(talker & 0xFF), static_cast<std::uint8_t>(talker >> 8)};
    return legacy_answered(answer);
}

/// False for a version of NMEA that no receiver has.
bool put_core(LegacyChanges& changes, const CfgNmeaCore& core) {
    const auto* const version =
        std::ranges::find(numbered_nmea_versions, core.nmea_version.raw, &NumberedNmeaVersion::wire);
    if (version == std::end(numbered_nmea_versions)) return false;
    changes.put_bits(nmea_filter, core.filter);
    changes.put(key::nmea_protver, version->item);
    changes.put(key::nmea_maxsvs, core.num_sv);
    changes.put_bits(nmea_flags, core.flags);
    return true;
}

}  // namespace

ConfigOutcome legacy_nmea(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return poll_nmea(context);
    const int generation = context.board.identity.generation;
    LegacyChanges changes(context);
    if (const auto shortest = decode_payload<CfgNmeaShort>(payload)) {
        return put_core(changes, shortest->core) ? changes.apply() : legacy_refused();
    }
    if (const auto v0 = decode_payload<CfgNmeaV0>(payload); v0 && generation >= 7 && v0->extension.version == 0) {
        if (!put_core(changes, v0->core)) return legacy_refused();
        link_extension(v0->extension, changes);
        return changes.apply();
    }
    const auto v1 = decode_payload<CfgNmea>(payload);
    if (!v1 || generation < 8 || v1->extension.version != 1 || !put_core(changes, v1->core)) return legacy_refused();
    link_extension(v1->extension, changes);
    changes.put(key::nmea_bds_talker, static_cast<std::uint16_t>(v1->bds_talker_id[0] | v1->bds_talker_id[1] << 8));
    return changes.apply();
}

}  // namespace skyloop::firmware
