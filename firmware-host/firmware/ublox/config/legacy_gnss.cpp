// CFG-GNSS and CFG-SBAS: which systems and signals are tracked (RECEIVER.md 3.3, 4.2).
#include <algorithm>
#include <span>

#include "firmware/ublox/config/legacy_keys.hpp"
#include "firmware/ublox/config/legacy_support.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_cfg_navigation.hpp"

namespace skyloop::firmware {
namespace {

/// Bits of sigCfMask (RECEIVER.md 2.4) and the items of their signals.
constexpr BitKey gps_signals[] = {{0, 0x10310001}, {4, 0x10310003}, {5, 0x10310004}};
constexpr BitKey sbas_signals[] = {{0, 0x10310005}};
constexpr BitKey galileo_signals[] = {{0, 0x10310007}, {4, 0x10310009}, {5, 0x1031000A}};
constexpr BitKey beidou_signals[] = {{0, 0x1031000D}, {4, 0x1031000E}, {7, 0x10310028}};
constexpr BitKey imes_signals[] = {{0, legacy_key::imes_l1}};
constexpr BitKey qzss_signals[] = {{0, 0x10310012}, {2, 0x10310014}, {4, 0x10310015}, {5, 0x10310017}};
constexpr BitKey glonass_signals[] = {{0, 0x10310018}, {4, 0x1031001A}};

/// One system of CFG-GNSS.
struct LegacySystem {
    std::uint8_t gnss_id;
    std::uint32_t enabled;
    std::span<const BitKey> signals;
    bool is_major;  ///< needs four channels, and can give a position by itself
};
constexpr LegacySystem legacy_systems[] = {
    {0, 0x1031001F, gps_signals, true},
    {1, legacy_key::sbas_enabled, sbas_signals, false},
    {2, 0x10310021, galileo_signals, true},
    {3, 0x10310022, beidou_signals, true},
    {4, legacy_key::imes_enabled, imes_signals, false},
    {5, 0x10310024, qzss_signals, false},
    {6, 0x10310025, glonass_signals, true},
};
constexpr unsigned signal_shift = 16;
constexpr std::uint32_t channels_were_set = 0x8000'0000;
constexpr std::uint8_t all_channels = 0xFF;
constexpr std::uint8_t least_major_channels = 4;

const LegacySystem* find_system(std::uint8_t gnss_id) {
    const auto* const found = std::ranges::find(legacy_systems, gnss_id, &LegacySystem::gnss_id);
    return found == std::end(legacy_systems) ? nullptr : found;
}

std::uint8_t channels_used(const LegacyContext& context) {
    const auto set = in_force<std::uint8_t>(context, legacy_key::gnss_channels_used);
    return set == 0 ? context.board.gnss_channels_used : set;
}

CfgGnssItem describe_system(const LegacyContext& context, const GnssBlock& block) {
    CfgGnssItem item{block.gnss_id, block.reserved_channels, block.max_channels, 0, block.flags};
    const auto channels = in_force<std::uint32_t>(context, legacy_key::gnss_channels(block.gnss_id));
    if ((channels & channels_were_set) != 0) {
        item.res_trk_ch = static_cast<std::uint8_t>(channels & 0xFF);
        item.max_trk_ch = static_cast<std::uint8_t>(channels >> 8 & 0xFF);
    }
    const LegacySystem* const system = find_system(block.gnss_id);
    if (system == nullptr) return item;
    const auto replace = [&](unsigned bit, std::uint32_t key) {
        if (!context.store.has(key)) return;
        item.flags &= ~(1u << bit);
        if (context.store.flag(key)) item.flags |= 1u << bit;
    };
    replace(0, system->enabled);
    // Of a system that is off, captured receivers show the signals that it would have.
    if (context.store.has(system->enabled) && !context.store.flag(system->enabled)) return item;
    for (const BitKey& signal : system->signals)
        replace(signal_shift + signal.bit, signal.key);
    return item;
}

CfgGnss describe_gnss(const LegacyContext& context) {
    CfgGnss message;
    message.num_trk_ch_hw = context.board.gnss_channels_hardware;
    message.num_trk_ch_use = channels_used(context);
    for (const GnssBlock& block : context.board.gnss_blocks)
        message.systems.push_back(describe_system(context, block));
    return message;
}

/// Lays the blocks of a setting over those in force. False when one is of a system that the board does not have.
bool merge_systems(CfgGnss& now, const std::vector<CfgGnssItem>& set) {
    for (const CfgGnssItem& item : set) {
        const auto block = std::ranges::find(now.systems, item.gnss_id, &CfgGnssItem::gnss_id);
        if (block == now.systems.end()) return false;
        *block = item;
    }
    return true;
}

/// Channels can be shared out up to protocol 23. Later ones have them read only (u-blox ZED-F9P interface description,
/// UBX-18010854, CFG-GNSS): whatever a client writes there is left unread.
bool shares_channels(const BoardProfile& board) {
    constexpr int last_generation = 8;
    return board.identity.generation <= last_generation;
}

void keep_channels(const CfgGnss& now, CfgGnss& set) {
    set.num_trk_ch_use = now.num_trk_ch_use;
    for (CfgGnssItem& item : set.systems) {
        const auto own = std::ranges::find(now.systems, item.gnss_id, &CfgGnssItem::gnss_id);
        if (own == now.systems.end()) continue;
        item.res_trk_ch = own->res_trk_ch;
        item.max_trk_ch = own->max_trk_ch;
    }
}

bool is_major(const CfgGnssItem& item) {
    const LegacySystem* const system = find_system(item.gnss_id);
    return system != nullptr && system->is_major;
}

bool leaves_major(const CfgGnss& message) {
    return std::ranges::any_of(message.systems,
                               [](const auto& item) { return (item.flags & 1) != 0 && is_major(item); });
}

/// Whether the channels suffice (RECEIVER.md 3.3). A system that is off reserves nothing.
bool channels_suffice(const CfgGnss& message) {
    unsigned reserved = 0;
    for (const CfgGnssItem& item : message.systems) {
        if (item.res_trk_ch > item.max_trk_ch) return false;
        if ((item.flags & 1) == 0) continue;
        reserved += item.res_trk_ch;
        if (is_major(item) && item.max_trk_ch < least_major_channels) return false;
    }
    return reserved <= message.num_trk_ch_use;
}

/// An empty mask leaves the signals as they are: clients from before sigCfMask send none. False when the board has none
/// of those asked for, or a major system is to do without its first.
bool put_signals(const LegacyContext& context, LegacyChanges& changes, const CfgGnssItem& item) {
    const std::uint32_t asked = item.flags >> signal_shift & 0xFF;
    if (asked == 0) return true;
    const LegacySystem* const system = find_system(item.gnss_id);
    const bool has_one = std::ranges::any_of(system->signals, [&](const BitKey& signal) {
        return (asked >> signal.bit & 1) != 0 && context.store.has(signal.key);
    });
    const bool lacks_first = system->is_major && (asked >> system->signals.front().bit & 1) == 0;
    if (!has_one || lacks_first) return (item.flags & 1) == 0;
    changes.put_bits(system->signals, asked);
    return true;
}

bool put_systems(const LegacyContext& context, LegacyChanges& changes, const std::vector<CfgGnssItem>& set) {
    for (const CfgGnssItem& item : set) {
        const LegacySystem* const system = find_system(item.gnss_id);
        if (system == nullptr || !put_signals(context, changes, item)) return false;
        changes.put(system->enabled, (item.flags & 1) != 0);
        if (!shares_channels(context.board)) continue;
        changes.put(legacy_key::gnss_channels(item.gnss_id),
                    channels_were_set | std::uint32_t{item.max_trk_ch} << 8 | item.res_trk_ch);
    }
    return true;
}

/// Before the ACK to a change of the tracked signals: 20 … 100 ms (RECEIVER.md 4.2), a tenth of the restart.
Seconds signal_work(const BoardProfile& board) {
    constexpr double share = 0.1, least = 0.020, most = 0.100;
    return Seconds(std::clamp(share * board.timing.signal_restart.value(), least, most));
}

constexpr BitKey sbas_usage[] = {
    {0, legacy_key::sbas_ranging}, {1, legacy_key::sbas_corrections}, {2, legacy_key::sbas_integrity}};
constexpr BitKey sbas_mode[] = {{0, legacy_key::sbas_enabled}, {1, legacy_key::sbas_test_mode}};
constexpr std::uint64_t scan_mask_2 = 0x7F;  // PRN 152 … 158
constexpr unsigned scan_shift = 32;

constexpr auto link_sbas = [](auto& m, auto& v) {
    v.link(sbas_mode, m.mode);
    v.link(sbas_usage, m.usage);
    v.link(legacy_key::max_sbas, m.max_sbas);
};

}  // namespace

ConfigOutcome legacy_gnss(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty() && !context.board.gnss_blocks.empty()) return legacy_answered(describe_gnss(context));
    auto set = decode_payload<CfgGnss>(payload);
    if (!set || set->version != 0) return legacy_refused();
    CfgGnss wanted = describe_gnss(context);
    const bool shares = shares_channels(context.board);
    if (!shares) keep_channels(wanted, *set);
    if (!merge_systems(wanted, set->systems)) return legacy_refused();
    // 255 stands for all, and more than there are cannot be used.
    const std::uint8_t available = context.board.gnss_channels_used;
    wanted.num_trk_ch_use =
        set->num_trk_ch_use == all_channels ? available : std::min(set->num_trk_ch_use.raw, available);
    if (!leaves_major(wanted) || (shares && !channels_suffice(wanted))) return legacy_refused();
    LegacyChanges changes(context);
    if (!put_systems(context, changes, set->systems)) return legacy_refused();
    if (shares) changes.put(legacy_key::gnss_channels_used, wanted.num_trk_ch_use);
    return changes.apply(signal_work(context.board));
}

ConfigOutcome legacy_sbas(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) {
        const std::uint64_t scan = context.store.value(legacy_key::sbas_scan_mask);
        return legacy_poll(context,
                           CfgSbas{.scan_mode2 = static_cast<std::uint8_t>(scan >> scan_shift & scan_mask_2),
                                   .scan_mode1 = static_cast<std::uint32_t>(scan & 0xFFFF'FFFF)},
                           link_sbas);
    }
    const auto set = decode_payload<CfgSbas>(payload);
    if (!set) return legacy_refused();
    LegacyChanges changes(context);
    link_sbas(*set, changes);
    changes.put(legacy_key::sbas_scan_mask,
                std::uint64_t{set->scan_mode2 & scan_mask_2} << scan_shift | set->scan_mode1);
    const bool restarts = context.store.flag(legacy_key::sbas_enabled) != ((set->mode & 1) != 0);
    return changes.apply(restarts ? signal_work(context.board) : Seconds{0});
}

}  // namespace skyloop::firmware
