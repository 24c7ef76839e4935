// CFG-TP5, CFG-ITFM, CFG-PMS, CFG-RXM, CFG-ANT, CFG-LOGFILTER (RECEIVER.md 3.3).
#include <algorithm>
#include <bit>
#include <cmath>

#include "firmware/ublox/config/legacy_keys.hpp"
#include "firmware/ublox/config/legacy_support.hpp"
#include "receiver/protocol/ubx_cfg_device.hpp"

namespace skyloop::firmware {
namespace {

/// The items of one time pulse (F9 interface description, CFG-TP).
struct PulseItems {
    std::uint32_t period, period_lock, frequency, frequency_lock, length, length_lock, duty, duty_lock, delay;
    std::uint32_t time_grid, is_frequency, is_length;
    BitKey flags[5];
};
constexpr PulseItems first_pulse{0x40050002,
                                 0x40050003,
                                 0x40050024,
                                 0x40050025,
                                 0x40050004,
                                 0x40050005,
                                 0x5005002A,
                                 0x5005002B,
                                 0x40050006,
                                 0x2005000C,
                                 legacy_key::tp_pulse_def,
                                 legacy_key::tp_pulse_length_def,
                                 {{0, 0x10050007}, {1, 0x10050008}, {2, 0x10050009}, {5, 0x1005000A}, {6, 0x1005000B}}};
constexpr PulseItems second_pulse{
    0x4005000D,
    0x4005000E,
    0x40050026,
    0x40050027,
    0x4005000F,
    0x40050010,
    0x5005002C,
    0x5005002D,
    0x40050011,
    0x20050017,
    legacy_key::tp_pulse_def,
    legacy_key::tp_pulse_length_def,
    {{0, 0x10050012}, {1, 0x10050013}, {2, 0x10050014}, {5, 0x10050015}, {6, 0x10050016}}};
constexpr unsigned frequency_bit = 3, length_bit = 4, grid_shift = 7, sync_shift = 11;

PulseItems pulse_items(const BoardProfile& board, unsigned index) {
    if (index == 0) return first_pulse;
    PulseItems items = second_pulse;
    if (board.identity.generation <= 8) {
        items.is_frequency = legacy_key::tp2_pulse_def;
        items.is_length = legacy_key::tp2_pulse_length_def;
    }
    return items;
}

/// A duty cycle in per cent, as the item has it, and in 2^-32, as the message has it.
constexpr double ratio_scale = 4294967296.0 / 100.0;
std::uint32_t ratio_of(std::uint64_t item) {
    const double ratio = std::round(std::bit_cast<double>(item) * ratio_scale);
    return static_cast<std::uint32_t>(std::clamp(ratio, 0.0, 4294967295.0));
}
std::uint64_t duty_of(std::uint32_t ratio) { return std::bit_cast<std::uint64_t>(ratio / ratio_scale); }

/// u-blox 6 has a byte without meaning in the place of the version, and sends one that is not 0 (configuration files of
/// u-center).
bool has_pulse_version(const BoardProfile& board) { return board.identity.generation >= 8; }

CfgTp5 describe_pulse(const LegacyContext& context, unsigned index) {
    const PulseItems items = pulse_items(context.board, index);
    const bool is_frequency = context.store.flag(items.is_frequency), is_length = context.store.flag(items.is_length);
    const auto length = [&](std::uint32_t length_key, std::uint32_t duty_key) {
        return is_length ? in_force<std::uint32_t>(context, length_key) : ratio_of(context.store.value(duty_key));
    };
    CfgTp5 message;
    message.tp_idx = static_cast<std::uint8_t>(index);
    const int protocol = protocol_version(context.board);
    message.version = !has_pulse_version(context.board) || (protocol != 0 && protocol < 1800) ? 0 : 1;
    message.ant_cable_delay = in_force<std::int16_t>(context, legacy_key::tp_ant_cable_delay);
    message.rf_group_delay = in_force<std::int16_t>(context, legacy_key::tp_rf_group_delay(index));
    message.freq_period = in_force<std::uint32_t>(context, is_frequency ? items.frequency : items.period);
    message.freq_period_lock =
        in_force<std::uint32_t>(context, is_frequency ? items.frequency_lock : items.period_lock);
    message.pulse_len_ratio = length(items.length, items.duty);
    message.pulse_len_ratio_lock = length(items.length_lock, items.duty_lock);
    message.user_config_delay = in_force<std::int32_t>(context, items.delay);
    message.flags = bits_in_force(context, items.flags) | (is_frequency ? 1u << frequency_bit : 0u) |
                    (is_length ? 1u << length_bit : 0u) |
                    (in_force<std::uint32_t>(context, items.time_grid) & 0xF) << grid_shift |
                    (in_force<std::uint32_t>(context, legacy_key::tp_sync_mode(index)) & 7) << sync_shift;
    return message;
}

void put_pulse(LegacyChanges& changes, const PulseItems& items, const CfgTp5& message) {
    const bool is_frequency = (message.flags >> frequency_bit & 1) != 0;
    const bool is_length = (message.flags >> length_bit & 1) != 0;
    changes.put(items.is_frequency, static_cast<std::uint8_t>(is_frequency));
    changes.put(items.is_length, static_cast<std::uint8_t>(is_length));
    changes.put(is_frequency ? items.frequency : items.period, message.freq_period);
    changes.put(is_frequency ? items.frequency_lock : items.period_lock, message.freq_period_lock);
    if (is_length) {
        changes.put(items.length, message.pulse_len_ratio);
        changes.put(items.length_lock, message.pulse_len_ratio_lock);
    } else {
        changes.put(items.duty, duty_of(message.pulse_len_ratio));
        changes.put(items.duty_lock, duty_of(message.pulse_len_ratio_lock));
    }
    changes.put(items.delay, message.user_config_delay);
    changes.put_bits(items.flags, message.flags);
    changes.put(items.time_grid, static_cast<std::uint8_t>(message.flags >> grid_shift & 0xF));
    changes.put(legacy_key::tp_ant_cable_delay, message.ant_cable_delay);
    changes.put(legacy_key::tp_rf_group_delay(message.tp_idx), message.rf_group_delay);
    changes.put(legacy_key::tp_sync_mode(message.tp_idx), static_cast<std::uint8_t>(message.flags >> sync_shift & 7));
}

bool has_pulse(const LegacyContext& context, unsigned index) {
    return index <= 1 && context.store.has(pulse_items(context.board, index).flags[0].key);
}

/// What the fields of CFG-ITFM hold that cannot be set: the bits of the reset values beside thresholds and switches
/// (RECEIVER.md 2.4).
constexpr std::uint32_t itfm_fixed = 0x2D62'ACF3u & 0x7FFF'FE00u, itfm_fixed_2 = 0x31E;
constexpr unsigned itfm_enable_bit = 31, itfm_antenna_shift = 12, itfm_aux_bit = 14;

// CFG-PMS-powerSetupValue and CFG-PM-OPERATEMODE.
constexpr std::uint8_t setup_interval = 2, setup_last = 5, setup_mixed = 0xFF;
constexpr std::uint8_t mode_full = 0, mode_on_off = 1, mode_cyclic = 2;

/// Balanced saves power without leaving continuous tracking; aggressive tracks in cycles.
std::uint8_t operate_mode_of(std::uint8_t setup) {
    if (setup < setup_interval) return mode_full;
    return setup == setup_interval ? mode_on_off : mode_cyclic;
}

CfgPms describe_power(const LegacyContext& context) {
    CfgPms message;
    const auto mode = in_force<std::uint8_t>(context, key::pm_operate_mode);
    const auto setup = in_force<std::uint8_t>(context, legacy_key::pms_setup);
    // Another message may have changed the mode since the setup was chosen.
    message.power_setup_value = setup;
    if (operate_mode_of(setup) != mode) {
        message.power_setup_value = setup_mixed;
        if (mode == mode_full) message.power_setup_value = 0;
        if (mode == mode_on_off) message.power_setup_value = setup_interval;
    }
    if (message.power_setup_value == setup_interval) {
        message.period = in_force<std::uint16_t>(context, key::pm_update_period);
        message.on_time = in_force<std::uint16_t>(context, key::pm_on_time);
    }
    return message;
}

constexpr BitKey ant_flags[] = {{0, key::ant_voltage_control},
                                {1, key::ant_short_detect},
                                {2, key::ant_open_detect},
                                {3, key::ant_power_down},
                                {4, key::ant_recover}};
constexpr unsigned pin_mask = 0x1F, short_pin_shift = 5, open_pin_shift = 10, reconfigure_bit = 15;

constexpr BitKey log_flags[] = {
    {0, legacy_key::log_record}, {1, legacy_key::log_once_per_wake_up}, {2, legacy_key::log_all_filters}};

constexpr auto link_logfilter = [](auto& m, auto& v) {
    v.link(log_flags, m.flags);
    v.link(legacy_key::log_min_interval, m.min_interval);
    v.link(legacy_key::log_time, m.time_threshold);
    v.link(legacy_key::log_speed, m.speed_threshold);
    v.link(legacy_key::log_position, m.position_threshold);
};

}  // namespace

ConfigOutcome legacy_tp5(const LegacyContext& context, ByteSpan payload) {
    if (payload.size() <= 1) {
        const unsigned index = payload.empty() ? 0 : payload[0];
        return has_pulse(context, index) ? legacy_answered(describe_pulse(context, index)) : legacy_refused();
    }
    const auto set = decode_payload<CfgTp5>(payload);
    if (!set || !has_pulse(context, set->tp_idx)) return legacy_refused();
    if (has_pulse_version(context.board) && set->version > 1) return legacy_refused();
    LegacyChanges changes(context);
    put_pulse(changes, pulse_items(context.board, set->tp_idx), *set);
    return changes.apply();
}

ConfigOutcome legacy_itfm(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) {
        CfgItfm answer{itfm_fixed, itfm_fixed_2};
        answer.config |= in_force<std::uint32_t>(context, legacy_key::itfm_bb_threshold) & 0xF;
        answer.config |= (in_force<std::uint32_t>(context, legacy_key::itfm_cw_threshold) & 0x1F) << 4;
        answer.config |= (context.store.flag(key::itfm_enable) ? 1u : 0u) << itfm_enable_bit;
        answer.config2 |= (in_force<std::uint32_t>(context, legacy_key::itfm_antenna) & 3) << itfm_antenna_shift;
        answer.config2 |= (context.store.flag(legacy_key::itfm_enable_aux) ? 1u : 0u) << itfm_aux_bit;
        return legacy_answered(answer);
    }
    const auto set = decode_payload<CfgItfm>(payload);
    if (!set) return legacy_refused();
    LegacyChanges changes(context);
    changes.put(legacy_key::itfm_bb_threshold, static_cast<std::uint8_t>(set->config & 0xF));
    changes.put(legacy_key::itfm_cw_threshold, static_cast<std::uint8_t>(set->config >> 4 & 0x1F));
    changes.put(key::itfm_enable, (set->config >> itfm_enable_bit & 1) != 0);
    changes.put(legacy_key::itfm_antenna, static_cast<std::uint8_t>(set->config2 >> itfm_antenna_shift & 3));
    changes.put(legacy_key::itfm_enable_aux, (set->config2 >> itfm_aux_bit & 1) != 0);
    return changes.apply();
}

ConfigOutcome legacy_pms(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return legacy_answered(describe_power(context));
    const auto set = decode_payload<CfgPms>(payload);
    if (!set || set->version != 0 || set->power_setup_value > setup_last) return legacy_refused();
    LegacyChanges changes(context);
    if (set->power_setup_value == setup_interval) {
        constexpr std::uint16_t least_period = 6;  // more than 5 s (M8 interface description 32.11.22)
        if (set->period < least_period || set->on_time >= set->period) return legacy_refused();
        changes.put(key::pm_update_period, std::uint32_t{set->period});
        changes.put(legacy_key::pm_update_rest, std::uint16_t{0});
        changes.put(key::pm_search_period, std::uint32_t{set->period});
        changes.put(legacy_key::pm_search_rest, std::uint16_t{0});
        changes.put(key::pm_on_time, set->on_time);
    }
    changes.put(legacy_key::pms_setup, set->power_setup_value);
    changes.put(key::pm_operate_mode, operate_mode_of(set->power_setup_value));
    return changes.apply();
}

ConfigOutcome legacy_rxm(const LegacyContext& context, ByteSpan payload) {
    const auto mode = in_force<std::uint8_t>(context, key::pm_operate_mode);
    if (payload.empty()) return legacy_answered(CfgRxm{8, static_cast<std::uint8_t>(mode == mode_full ? 0 : 1)});
    const auto set = decode_payload<CfgRxm>(payload);
    constexpr std::uint8_t continuous = 0, power_save = 1, continuous_too = 4;
    if (!set || (set->lp_mode != continuous && set->lp_mode != power_save && set->lp_mode != continuous_too))
        return legacy_refused();
    LegacyChanges changes(context);
    // Which of the two modes it is, CFG-PM2 says.
    const auto flags = in_force<std::uint32_t>(context, legacy_key::pm_flags);
    const bool cyclic = (flags & legacy_key::power_mode_mask) >> legacy_key::power_mode_shift == 1;
    const std::uint8_t saving = mode != mode_full ? mode : cyclic ? mode_cyclic : mode_on_off;
    changes.put(key::pm_operate_mode, set->lp_mode == power_save ? saving : mode_full);
    return changes.apply();
}

ConfigOutcome legacy_ant(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) {
        // With the bit that makes the pins count, so that what was read can be written back.
        const unsigned pins = in_force<unsigned>(context, legacy_key::ant_switch_pin) |
                              in_force<unsigned>(context, legacy_key::ant_short_pin) << short_pin_shift |
                              in_force<unsigned>(context, legacy_key::ant_open_pin) << open_pin_shift |
                              1u << reconfigure_bit;
        return legacy_answered(CfgAnt{static_cast<std::uint16_t>(bits_in_force(context, ant_flags)),
                                      static_cast<std::uint16_t>(pins & 0xFFFF)});
    }
    const auto set = decode_payload<CfgAnt>(payload);
    if (!set) return legacy_refused();
    LegacyChanges changes(context);
    changes.put_bits(ant_flags, set->flags);
    if ((set->pins >> reconfigure_bit & 1) != 0) {
        changes.put(legacy_key::ant_switch_pin, static_cast<std::uint8_t>(set->pins & pin_mask));
        changes.put(legacy_key::ant_short_pin, static_cast<std::uint8_t>(set->pins >> short_pin_shift & pin_mask));
        changes.put(legacy_key::ant_open_pin, static_cast<std::uint8_t>(set->pins >> open_pin_shift & pin_mask));
    }
    return changes.apply();
}

ConfigOutcome legacy_logfilter(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return legacy_poll(context, CfgLogfilter{}, link_logfilter);
    const auto set = decode_payload<CfgLogfilter>(payload);
    return set && set->version == 1 ? legacy_set(context, *set, link_logfilter) : legacy_refused();
}

}  // namespace skyloop::firmware
