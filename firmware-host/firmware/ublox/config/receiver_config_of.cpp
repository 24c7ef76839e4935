// The neutral configuration of a receiver, from the configuration items of u-blox.
#include <cmath>

#include "firmware/core/port.hpp"
#include "firmware/ublox/config/config_handler.hpp"
#include "firmware/ublox/config/legacy_keys.hpp"
#include "firmware/ublox/config/signal_keys.hpp"
#include "receiver/protocol/ubx_hardware.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t tp_period = 0x40050002, tp_period_lock = 0x40050003, tp_frequency = 0x40050024,
                        tp_frequency_lock = 0x40050025, tp_pulse_def = 0x20050023, tp_enabled = 0x10050007,
                        tp_use_locked = 0x10050009, tp_time_grid = 0x2005000C;
constexpr std::uint32_t use_ana = 0x10230001, rtcm_station_out = 0x30090001;

double number(const ConfigStore& store, std::uint32_t item) { return static_cast<double>(store.value(item)); }
double signed_number(const ConfigStore& store, std::uint32_t item) {
    return static_cast<double>(store.signed_value(item));
}

FixLimits fix_limits_of(const ConfigStore& store) {
    constexpr std::uint64_t only_2d = 1, only_3d = 2;
    const std::uint64_t mode = store.value(key::navspg_fixmode);
    FixLimits limits;
    limits.mode = mode == only_2d ? FixMode::only_2d : mode == only_3d ? FixMode::only_3d : FixMode::automatic;
    limits.height = Metres(signed_number(store, key::navspg_constr_alt) / 100);
    limits.height_variance_m2 = number(store, key::navspg_constr_altvar) * 1e-4;
    limits.least_used = store.value(key::navspg_min_svs);
    limits.least_strong = store.value(key::navspg_cno_count);
    limits.strong = DbHz(number(store, key::navspg_cno_threshold));
    limits.most_pdop = number(store, key::navspg_pdop) / 10;
    limits.most_accuracy_m = number(store, key::navspg_pacc);
    limits.dynamic_model = static_cast<int>(store.value(key::navspg_dynmodel));
    limits.held_below = MetresPerSecond(number(store, key::mot_speed_threshold) / 100);
    limits.held_within = Metres(number(store, key::mot_distance_threshold));
    return limits;
}

CorrectionLimits correction_limits_of(const ConfigStore& store) {
    CorrectionLimits limits;
    if (store.has(key::navspg_dgnss_timeout)) limits.timeout = Seconds(number(store, key::navspg_dgnss_timeout));
    constexpr std::uint64_t rtk_float = 2;
    limits.float_only = store.has(key::navhpg_dgnssmode) && store.value(key::navhpg_dgnssmode) == rtk_float;
    return limits;
}

// Three items in cm or 1e-7°, each with a hundredth part beyond it in an item of its own.
std::array<double, 3> coordinates(const ConfigStore& store, std::uint32_t first, std::uint32_t first_beyond) {
    std::array<double, 3> values{};
    for (std::uint32_t i = 0; i < 3; ++i)
        values[i] = signed_number(store, first + i) + signed_number(store, first_beyond + i) * 1e-2;
    return values;
}

Position<Ecef> given_position(const ConfigStore& store) {
    if (store.flag(legacy_key::tmode_pos_type)) {
        const auto [latitude, longitude, height] =
            coordinates(store, legacy_key::tmode_geodetic, legacy_key::tmode_geodetic_hp);
        return to_ecef(Geodetic::degrees(latitude * 1e-7, longitude * 1e-7, height * 1e-2));
    }
    const auto [x, y, z] = coordinates(store, legacy_key::tmode_ecef, legacy_key::tmode_ecef_hp);
    return Position<Ecef>(x * 1e-2, y * 1e-2, z * 1e-2);
}

void put_base_station(const ConfigStore& store, ReceiverConfig& config) {
    constexpr std::uint64_t survey = 1, fixed = 2;
    constexpr double tenths_of_mm = 1e-4;
    const std::uint64_t mode = store.value(key::tmode_mode);
    if (mode == survey)
        config.survey = SurveyLimits{Seconds(number(store, legacy_key::tmode_svin_min_dur)),
                                     Metres(number(store, legacy_key::tmode_svin_acc_limit) * tenths_of_mm)};
    if (mode == fixed)
        config.place =
            BasePlace{given_position(store), Metres(number(store, legacy_key::tmode_fixed_pos_acc) * tenths_of_mm)};
    config.station = static_cast<int>(store.value(rtcm_station_out) & 0xFFF);
}

void put_fences(const ConfigStore& store, ReceiverConfig& config) {
    for (std::uint32_t number_of_fence = 1; number_of_fence <= most_fences; ++number_of_fence) {
        const FenceKeys keys(number_of_fence);
        if (!store.flag(keys.use)) continue;
        config.fences.push_back({static_cast<std::uint8_t>(number_of_fence),
                                 Geodetic::degrees(signed_number(store, keys.latitude) * 1e-7,
                                                   signed_number(store, keys.longitude) * 1e-7, 0),
                                 Metres(number(store, keys.radius) / 100)});
    }
    config.fence_confidence = number(store, key::geofence_confidence);
}

std::uint64_t item_or(const ConfigStore& store, std::uint32_t item, std::uint64_t standard) {
    return store.has(item) ? store.value(item) : standard;
}

PulseConfig pulses_of(const ConfigStore& store) {
    PulseConfig pulses{.locked = {}, .unlocked = {}, .time_grid = store.value(tp_time_grid)};
    if (item_or(store, tp_enabled, 1) == 0) return pulses;
    const auto rate = [&](std::uint32_t period, std::uint32_t frequency) {
        if (item_or(store, tp_pulse_def, 0) == 0)
            return PulseRate{.period = std::chrono::microseconds(item_or(store, period, 1'000'000))};
        return PulseRate{.hertz = static_cast<std::int64_t>(item_or(store, frequency, 1))};
    };
    pulses.unlocked = rate(tp_period, tp_frequency);
    pulses.locked = item_or(store, tp_use_locked, 1) != 0 ? rate(tp_period_lock, tp_frequency_lock) : pulses.unlocked;
    return pulses;
}

// From generation 9 on cyclic tracking is there at 2 and 1 Hz, and with periods of 2 s to 10 s in whole seconds.
bool is_cyclic_rate(std::uint64_t measurement_ms) {
    return measurement_ms == 500 || (measurement_ms % 1000 == 0 && measurement_ms >= 1000 && measurement_ms <= 10'000);
}

Nanoseconds period_of(const ConfigStore& store, std::uint32_t whole_s, std::uint32_t rest_ms) {
    const Nanoseconds period =
        std::chrono::seconds(store.value(whole_s)) + std::chrono::milliseconds(store.value(rest_ms));
    return std::min<Nanoseconds>(period, std::chrono::seconds(seconds_per_week));
}

// Before generation 9 the update period says it, and the setups of CFG-PMS their own.
Nanoseconds cyclic_period_of(const ConfigStore& store, Nanoseconds update_period) {
    constexpr std::uint64_t aggressive_1_hz = 3, aggressive_2_hz = 4, aggressive_4_hz = 5;
    switch (store.value(legacy_key::pms_setup)) {
        case aggressive_1_hz:
            return 1s;
        case aggressive_2_hz:
            return 500ms;
        case aggressive_4_hz:
            return 250ms;
        default:
            return std::clamp<Nanoseconds>(update_period, 1s, 10s);
    }
}

PowerSaveSettings power_of(const ConfigStore& store, const BoardProfile& board) {
    PowerSaveSettings s;
    const std::uint64_t mode = board.power.save_modes ? store.value(key::pm_operate_mode) : 0;
    if (mode == 1) s.mode = PowerMode::on_off;
    if (mode == 2) s.mode = PowerMode::cyclic;
    const bool by_rate = board.identity.generation >= 9;
    if (s.mode == PowerMode::cyclic && by_rate && !is_cyclic_rate(store.value(key::rate_meas)))
        s.mode = PowerMode::full;
    const auto seconds = [&](std::uint32_t id) { return Seconds(number(store, id)); };
    s.update_period = period_of(store, key::pm_update_period, legacy_key::pm_update_rest);
    s.search_period = period_of(store, key::pm_search_period, legacy_key::pm_search_rest);
    s.grid_offset = period_of(store, key::pm_grid_offset, legacy_key::pm_grid_rest);
    if (!by_rate) s.cyclic_period = cyclic_period_of(store, s.update_period);
    s.on_time = seconds(key::pm_on_time);
    s.least_acquisition = seconds(key::pm_least_acquisition);
    s.longest_acquisition = seconds(key::pm_longest_acquisition);
    // The mask of the time is one of range, m.
    s.time_accuracy = seconds(key::navspg_tacc) / speed_of_light;
    s.wait_for_time = store.flag(key::pm_wait_for_time);
    s.never_off = store.flag(key::pm_never_off);
    s.update_ephemerides = store.flag(key::pm_update_ephemerides);
    // UTC, where several systems are at work.
    constexpr int first_with_several = 8;
    s.in_utc = board.identity.generation >= first_with_several;
    return s;
}

// Two characters of CFG-NMEA-BDSTALKERID, or the board's own.
std::string beidou_talker(const BoardProfile& board, const ConfigStore& store) {
    const std::uint64_t configured = store.value(key::nmea_bds_talker);
    const char first = static_cast<char>(configured & 0x7F), second = static_cast<char>(configured >> 8 & 0x7F);
    const auto letter = [](char c) { return c >= 'A' && c <= 'Z'; };
    return letter(first) && letter(second) ? std::string{first, second} : board.style.beidou_talker;
}

std::string main_talker(const BoardProfile& board, const ConfigStore& store) {
    const std::uint64_t item = store.value(key::nmea_main_talker);
    if (item < numbered_talkers.size() && !numbered_talkers[item].empty()) return std::string(numbered_talkers[item]);
    return board.main_talker;
}

// CFG-NMEA-FILT_… takes a system out of the output. NavIC has no such item.
std::set<Constellation> systems_left_out(const ConfigStore& store) {
    using enum Constellation;
    constexpr std::pair<Constellation, std::uint32_t> items[] = {
        {gps, key::nmea_filt_gps},    {sbas, key::nmea_filt_sbas}, {galileo, key::nmea_filt_gal},
        {beidou, key::nmea_filt_bds}, {qzss, key::nmea_filt_qzss}, {glonass, key::nmea_filt_glo}};
    std::set<Constellation> left_out;
    for (const auto& [system, item] : items)
        if (store.flag(item)) left_out.insert(system);
    return left_out;
}

NmeaConfig nmea_config_of(const ConfigStore& store, const BoardProfile& board) {
    NmeaConfig nmea;
    const auto version =
        std::ranges::find(numbered_nmea_versions, store.value(key::nmea_protver), &NumberedNmeaVersion::item);
    nmea.version = version == numbered_nmea_versions.end() ? board.nmea_version : version->version;
    nmea.numbering = board.satellite_numbering;
    if (store.has(key::nmea_svnumbering))
        nmea.numbering = store.flag(key::nmea_svnumbering) ? NmeaNumbering::extended : NmeaNumbering::strict;
    nmea.talker = main_talker(board, store);
    nmea.beidou_talker = beidou_talker(board, store);
    nmea.main_talker_everywhere = store.value(key::nmea_gsv_talker) == 1;
    nmea.left_out = systems_left_out(store);
    nmea.most_listed = store.value(key::nmea_maxsvs);
    nmea.gps_only = store.flag(key::nmea_out_onlygps);
    nmea.counts_considered = store.flag(key::nmea_consider);
    nmea.limit_82 = store.flag(key::nmea_limit82);
    nmea.compatible = store.flag(key::nmea_compat);
    nmea.high_precision = store.flag(key::nmea_highprec);
    nmea.shows_invalid_fix = store.flag(key::nmea_out_invfix);
    nmea.shows_masked_fix = store.flag(key::nmea_out_mskfix);
    nmea.shows_invalid_time = store.flag(key::nmea_out_invtime);
    nmea.shows_invalid_date = store.flag(key::nmea_out_invdate);
    nmea.shows_frozen_course = store.flag(key::nmea_out_frozencog);
    return nmea;
}

// Commands cannot ask for a speed that no UART has, stored text may: the nearest that one has.
std::uint32_t configured_baud(const ConfigStore& store, PortId port) {
    if (!is_uart(port)) return bus_speed(port);
    const std::uint32_t item = port == PortId::uart1 ? key::uart1_baudrate : key::uart2_baudrate;
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(store.value(item), slowest_baud, fastest_baud));
}

PortConfig port_config_of(const ConfigStore& store, PortId port) {
    const auto in = [&](std::uint32_t protocol) { return store.flag(key::in_protocol(port, protocol)); };
    const auto out = [&](std::uint32_t protocol) { return store.flag(key::out_protocol(port, protocol)); };
    return {.on = port_is_on(store, port),
            .baud = configured_baud(store, port),
            .in = {in(protocol_ubx), in(protocol_nmea), in(protocol_rtcm3)},
            .out = {out(protocol_ubx), out(protocol_nmea), out(protocol_rtcm3)},
            .ubx_texts = store.value(key::inf_ubx(port)),
            .nmea_texts = store.value(key::inf_nmea(port))};
}

}  // namespace

ReceiverConfig receiver_config(const ConfigStore& store, const BoardProfile& board, const ReceiverSettings& base) {
    ReceiverConfig config;
    config.settings = settings_of(store, board, base);
    config.systems = enabled_systems(store);
    config.elevation_mask = store.has(key::navspg_min_elev) ? Angle::degrees(signed_number(store, key::navspg_min_elev))
                                                            : board.elevation_mask;
    config.limits = fix_limits_of(store);
    config.corrections = correction_limits_of(store);
    put_base_station(store, config);
    put_fences(store, config);
    config.pulses = pulses_of(store);
    config.power = power_of(store, board);
    config.counts_distance = store.flag(key::odo_use_odo);
    constexpr int first_with_spoofing_detection = 8, first_with_numbered_lists = 10;
    config.reports_spoofing = board.identity.generation >= first_with_spoofing_detection;
    config.reports_jamming_elsewhere = knows(board, SecSig1::message_id);
    config.predicts_orbits = store.flag(use_ana);
    config.trusts_l5 = !store.has(key::health_l5) || store.flag(key::health_l5);
    config.watches_interference =
        store.has(key::itfm_enable) ? store.flag(key::itfm_enable) : board.quirks.default_interference_monitor;
    config.watches_antenna =
        store.has(key::ant_voltage_control) ? store.flag(key::ant_voltage_control) : board.quirks.voltage_control;
    config.short_ends_supply = store.flag(key::ant_power_down);
    config.utc_standard = static_cast<std::uint8_t>(store.value(key::navspg_utcstandard));
    config.first_week = static_cast<std::int64_t>(store.value(key::navspg_wknrollover) & 0xFFFFu);
    config.nmea = nmea_config_of(store, board);
    config.nmea.numbers_empty_lists = board.identity.generation >= first_with_numbered_lists;
    for (std::size_t port = 0; port < ublox_port_count; ++port)
        config.ports[port] = port_config_of(store, static_cast<PortId>(port));
    return config;
}

}  // namespace skyloop::firmware
