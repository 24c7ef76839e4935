// CFG-DAT, CFG-PM2 and CFG-RINV, as the M8 has them (M8 interface description). DAT and RINV are stored alone.
// CFG-CFG: clear, save and load (RECEIVER.md 3.3, 4.2, 4.3).

#include <algorithm>
#include <bit>
#include <optional>
#include <string_view>

#include "firmware/ublox/config/legacy_keys.hpp"
#include "firmware/ublox/config/legacy_support.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_cfg_device.hpp"
#include "receiver/protocol/ubx_cfg_navigation.hpp"

namespace skyloop::firmware {
namespace {

constexpr unsigned io_port = 0, msg_conf = 1, inf_msg = 2, nav_conf = 3, rxm_conf = 4, rinv_conf = 9, ant_conf = 10,
                   log_conf = 11;

/// The bit of CFG-CFG's masks that an item belongs to (M8 interface description 32.11.3.1); what no bit names belongs
/// to the navigation.
unsigned section_of(std::uint32_t key) {
    // CFG-I2C, -UART1, -UART2, -SPI, -USB, -TXREADY; CFG-TP, -SIGNAL, -SIGNAL health, -ITFM, -PM, -SEC.
    constexpr struct {
        std::uint32_t group;
        unsigned section;
    } rows[] = {{0x51, io_port},  {0x52, io_port},  {0x53, io_port},  {0x64, io_port},
                {0x65, io_port},  {0xA2, io_port},  {0x91, msg_conf}, {legacy_key::own_rate_group, msg_conf},
                {0x92, inf_msg},  {0x05, rxm_conf}, {0x31, rxm_conf}, {0x32, rxm_conf},
                {0x41, rxm_conf}, {0xD0, rxm_conf}, {0xF6, rxm_conf}, {0xC7, rinv_conf},
                {0xA3, ant_conf}, {0xDE, log_conf}};
    const std::uint32_t group = key >> 16 & 0xFF;
    if (group == legacy_key::own_group) return key >> 8 & 0xF;
    if (group >= 0x71 && group <= 0x7A) return io_port;
    for (const auto& row : rows)
        if (row.group == group) return row.section;
    return nav_conf;
}

/// The items that a mask names. From generation 9 on any bit stands for all of them.
class SectionMask {
public:
    SectionMask(const LegacyContext& context, std::uint32_t mask)
        : mask_(mask != 0 && context.board.identity.generation >= 9 ? 0xFFFF'FFFFu : mask) {}
    [[nodiscard]] bool any() const { return mask_ != 0; }
    [[nodiscard]] bool has(std::uint32_t key) const { return (mask_ >> section_of(key) & 1) != 0; }

private:
    std::uint32_t mask_;
};

/// Memories that a device mask names: bit 0 battery-backed RAM, 1 flash, 2 EEPROM, 4 flash on SPI. Without a mask all.
/// What the board does not have is left out.
ConfigLayers layers_of(const BoardProfile& board, const std::optional<std::uint8_t>& device_mask) {
    const unsigned devices = device_mask.value_or(0x17);
    unsigned layers = 0;
    if ((devices & 0x01) != 0) layers |= in_battery;
    if ((devices & 0x16) != 0 && has_flash(board)) layers |= in_flash;
    return static_cast<ConfigLayers>(layers);
}

void load(const LegacyContext& context, const SectionMask& mask) {
    for (const auto& [key, factory] : ConfigValues(context.store.values(ConfigLayer::factory))) {
        if (!mask.has(key)) continue;
        const auto battery = context.store.stored(ConfigLayer::battery, key);
        const auto flash = context.store.stored(ConfigLayer::flash, key);
        const std::uint64_t value = battery ? *battery : flash.value_or(factory);
        if (context.store.value(key) != value) context.store.set(in_ram, key, value);
    }
}

}  // namespace

ConfigOutcome legacy_cfg(const LegacyContext& context, ByteSpan payload) {
    const auto set = decode_payload<CfgCfg>(payload);
    if (!set || is_locked(context)) return legacy_refused();
    const ConfigLayers layers = layers_of(context.board, set->device_mask);
    const SectionMask cleared(context, set->clear_mask), saved(context, set->save_mask),
        loaded(context, set->load_mask);
    for (const auto& [key, value] : ConfigValues(context.store.values(ConfigLayer::ram))) {
        if (cleared.has(key)) context.store.erase(layers, key);
        if (saved.has(key)) context.store.set(layers, key, value);
    }
    if (loaded.any()) load(context, loaded);
    const bool writes_flash = (layers & in_flash) != 0 && (cleared.any() || saved.any());
    return legacy_taken(writes_flash ? context.board.timing.flash_write : Seconds{0});
}

namespace {

// CFG-NAVSPG-USE_USRDAT, and USRDAT_…; shifts, rotations and scale follow each other.
constexpr std::uint32_t use_user_datum = 0x10110061, datum_axis = 0x50110062, datum_flattening = 0x50110063,
                        datum_shift = 0x40110064, datum_rotation = 0x40110067, datum_scale = 0x4011006A;
constexpr std::uint16_t datum_of_user = 0xFFFF;
constexpr double wgs84_axis_m = 6378137, wgs84_inverse_flattening = 298.257223563;

float float_item(const LegacyContext& context, std::uint32_t item) {
    return std::bit_cast<float>(in_force<std::uint32_t>(context, item));
}

CfgDat describe_datum(const LegacyContext& context) {
    CfgDat message;
    const bool of_user = context.store.flag(use_user_datum);
    const std::string_view name = of_user ? "USER" : "WGS84";
    std::copy(name.begin(), name.end(), message.datum_name.begin());
    message.maj_a = wgs84_axis_m;
    message.flat = wgs84_inverse_flattening;
    if (!of_user) return message;
    message.datum_num = datum_of_user;
    message.maj_a = std::bit_cast<double>(context.store.value(datum_axis));
    message.flat = std::bit_cast<double>(context.store.value(datum_flattening));
    for (std::uint32_t i = 0; i < 3; ++i) {
        message.shift[i] = float_item(context, datum_shift + i);
        message.rotation[i] = float_item(context, datum_rotation + i);
    }
    message.scale = float_item(context, datum_scale);
    return message;
}

// The ranges that the interface description accepts. What is no number is in none.
bool is_datum(const CfgDatSet& set) {
    constexpr float farthest_m = 5000, widest_turn = 20, largest_scale = 50;
    const auto within = [](const auto& values, float most) {
        return std::ranges::all_of(values, [&](float v) { return v >= -most && v <= most; });
    };
    return set.maj_a >= 6.3e6 && set.maj_a <= 6.5e6 && set.flat >= 0 && set.flat <= 500 &&
           within(set.shift, farthest_m) && within(set.rotation, widest_turn) && set.scale >= 0 &&
           set.scale <= largest_scale;
}

constexpr BitKey power_flags[] = {{4, key::pm_extint_select},       {5, key::pm_extint_wake},
                                  {6, key::pm_extint_backup},       {7, key::pm_extint_inactive},
                                  {8, key::pm_limit_peak},          {10, key::pm_wait_for_time},
                                  {12, key::pm_update_ephemerides}, {16, key::pm_never_off}};
using legacy_key::power_mode_mask, legacy_key::power_mode_shift;
constexpr std::uint32_t ms = 1000;

CfgPm2 describe_power_management(const LegacyContext& context) {
    const auto item = [&](std::uint32_t id) { return in_force<std::uint32_t>(context, id); };
    CfgPm2 message;
    message.max_startup_state_dur = in_force<std::uint8_t>(context, key::pm_longest_acquisition);
    message.flags = item(legacy_key::pm_flags) | bits_in_force(context, power_flags);
    if (const std::uint32_t mode = item(key::pm_operate_mode); mode != 0)
        message.flags = (message.flags & ~power_mode_mask) | (mode - 1) << power_mode_shift;
    message.update_period = item(key::pm_update_period) * ms + item(legacy_key::pm_update_rest);
    message.search_period = item(key::pm_search_period) * ms + item(legacy_key::pm_search_rest);
    message.grid_offset = item(key::pm_grid_offset) * ms + item(legacy_key::pm_grid_rest);
    message.on_time = in_force<std::uint16_t>(context, key::pm_on_time);
    message.min_acq_time = in_force<std::uint16_t>(context, key::pm_least_acquisition);
    message.extint_inactivity = item(key::pm_extint_inactivity);
    return message;
}

void put_period(LegacyChanges& changes, std::uint32_t whole, std::uint32_t rest, std::uint32_t period_ms) {
    changes.put(whole, period_ms / ms);
    changes.put(rest, static_cast<std::uint16_t>(period_ms % ms));
}

// CFG-RINV-DUMP, BINARY, DATA_SIZE, and CHUNK0 to 3 of eight bytes each, the first one lowest.
constexpr BitKey inventory_flags[] = {{0, 0x10C70001}, {1, 0x10C70002}};
constexpr std::uint32_t inventory_size = 0x20C70003, inventory_chunk = 0x50C70004;
constexpr std::size_t most_inventory = 30, chunk_bytes = 8;
constexpr UbxMessageId cfg_rinv{0x06, 0x34};

}  // namespace

ConfigOutcome legacy_dat(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return legacy_answered(describe_datum(context));
    LegacyChanges changes(context);
    // A standard datum by its number (u-blox 6 receiver description, CFG-DAT), with which every configuration file of
    // u-center begins. WGS 84 is the only one.
    if (payload.size() == sizeof(std::uint16_t)) {
        changes.put(use_user_datum, false);
        return payload[0] == 0 && payload[1] == 0 ? changes.apply() : legacy_refused();
    }
    const auto set = decode_payload<CfgDatSet>(payload);
    if (!set || !is_datum(*set)) return legacy_refused();
    changes.put(use_user_datum, true);
    changes.put(datum_axis, std::bit_cast<std::uint64_t>(set->maj_a));
    changes.put(datum_flattening, std::bit_cast<std::uint64_t>(set->flat));
    for (std::uint32_t i = 0; i < 3; ++i) {
        changes.put(datum_shift + i, std::bit_cast<std::uint32_t>(set->shift[i]));
        changes.put(datum_rotation + i, std::bit_cast<std::uint32_t>(set->rotation[i]));
    }
    changes.put(datum_scale, std::bit_cast<std::uint32_t>(set->scale));
    return changes.apply();
}

ConfigOutcome legacy_pm2(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return legacy_answered(describe_power_management(context));
    const auto set = decode_payload<CfgPm2>(payload);
    const std::uint32_t mode = set ? (set->flags & power_mode_mask) >> power_mode_shift : 0;
    if (!set || set->version != 2 || mode > 1 || set->min_acq_time > 0xFF) return legacy_refused();
    std::uint32_t without_item = set->flags;
    for (const BitKey& flag : power_flags)
        without_item &= ~(1u << flag.bit);
    LegacyChanges changes(context);
    changes.put_bits(power_flags, set->flags);
    changes.put(legacy_key::pm_flags, without_item);
    changes.put(legacy_key::pms_setup, std::uint8_t{0});  // these periods count, not those of a setup
    if (context.store.value(key::pm_operate_mode) != 0)
        changes.put(key::pm_operate_mode, static_cast<std::uint8_t>(mode + 1));
    put_period(changes, key::pm_update_period, legacy_key::pm_update_rest, set->update_period);
    put_period(changes, key::pm_search_period, legacy_key::pm_search_rest, set->search_period);
    put_period(changes, key::pm_grid_offset, legacy_key::pm_grid_rest, set->grid_offset);
    changes.put(key::pm_on_time, set->on_time);
    changes.put(key::pm_least_acquisition, static_cast<std::uint8_t>(set->min_acq_time));
    changes.put(key::pm_longest_acquisition, set->max_startup_state_dur);
    changes.put(key::pm_extint_inactivity, set->extint_inactivity);
    return changes.apply();
}

ConfigOutcome legacy_rinv(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) {
        Bytes answer{static_cast<std::uint8_t>(bits_in_force(context, inventory_flags))};
        const std::size_t size = std::min(most_inventory, in_force<std::size_t>(context, inventory_size));
        for (std::size_t i = 0; i < size; ++i) {
            const auto chunk = inventory_chunk + static_cast<std::uint32_t>(i / chunk_bytes);
            answer.push_back(static_cast<std::uint8_t>(context.store.value(chunk) >> (8 * (i % chunk_bytes))));
        }
        return {.answers = {encode_frame(cfg_rinv, answer)}, .verdict = Verdict::acknowledge};
    }
    if (payload.size() > 1 + most_inventory) return legacy_refused();
    LegacyChanges changes(context);
    changes.put_bits(inventory_flags, payload[0]);
    changes.put(inventory_size, static_cast<std::uint8_t>(payload.size() - 1));
    for (std::size_t first = 0; first < most_inventory; first += chunk_bytes) {
        std::uint64_t chunk = 0;
        for (std::size_t i = 0; i < chunk_bytes && 1 + first + i < payload.size(); ++i)
            chunk |= std::uint64_t{payload[1 + first + i]} << (8 * i);
        changes.put(inventory_chunk + static_cast<std::uint32_t>(first / chunk_bytes), chunk);
    }
    return changes.apply();
}

}  // namespace skyloop::firmware
