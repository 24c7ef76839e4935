// CFG-RATE, CFG-NAV5, CFG-NAVX5, CFG-ODO, CFG-DGNSS, CFG-TMODE3 (RECEIVER.md 3.3).
// CFG-GEOFENCE (M8 interface description).

#include <algorithm>

#include "firmware/config/config_keys.hpp"
#include "firmware/config/legacy_keys.hpp"
#include "firmware/config/legacy_support.hpp"
#include "firmware/geofence.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_cfg_navigation.hpp"

namespace skyloop::firmware {
namespace {

CfgNav5 describe_nav5(const LegacyContext& context) {
    CfgNav5 message;
    message.mask = 0xFFFF;
    message.dyn_model = in_force<std::uint8_t>(context, key::navspg_dynmodel);
    message.fix_mode = in_force<std::uint8_t>(context, key::navspg_fixmode);
    message.fixed_alt = in_force<std::int32_t>(context, key::navspg_constr_alt);
    message.fixed_alt_var = in_force<std::uint32_t>(context, key::navspg_constr_altvar);
    message.min_elev = in_force<std::int8_t>(context, key::navspg_min_elev);
    message.dr_limit = in_force<std::uint8_t>(context, legacy_key::dr_limit);
    message.p_dop = in_force<std::uint16_t>(context, key::navspg_pdop);
    message.t_dop = in_force<std::uint16_t>(context, key::navspg_tdop);
    message.p_acc = in_force<std::uint16_t>(context, key::navspg_pacc);
    message.t_acc = in_force<std::uint16_t>(context, key::navspg_tacc);
    message.static_hold_thresh = in_force<std::uint8_t>(context, key::mot_speed_threshold);
    message.dgnss_timeout = in_force<std::uint8_t>(context, key::navspg_dgnss_timeout);
    message.cno_thresh_num_svs = in_force<std::uint8_t>(context, key::navspg_cno_count);
    message.cno_thresh = in_force<std::uint8_t>(context, key::navspg_cno_threshold);
    message.static_hold_max_dist = in_force<std::uint16_t>(context, key::mot_distance_threshold);
    message.utc_standard = in_force<std::uint8_t>(context, key::navspg_utcstandard);
    return message;
}

/// The groups that CFG-NAV5's mask names (M8 interface description 32.11.17).
void put_nav5(LegacyChanges& changes, const CfgNav5& message) {
    const auto masked = [&](unsigned bit) { return (message.mask >> bit & 1) != 0; };
    if (masked(0)) changes.put(key::navspg_dynmodel, message.dyn_model);
    if (masked(1)) changes.put(key::navspg_min_elev, message.min_elev);
    if (masked(2)) {
        changes.put(key::navspg_fixmode, message.fix_mode);
        changes.put(key::navspg_constr_alt, message.fixed_alt);
        changes.put(key::navspg_constr_altvar, message.fixed_alt_var);
    }
    if (masked(3)) changes.put(legacy_key::dr_limit, message.dr_limit);
    if (masked(4)) {
        changes.put(key::navspg_pdop, message.p_dop);
        changes.put(key::navspg_pacc, message.p_acc);
    }
    if (masked(5)) {
        changes.put(key::navspg_tdop, message.t_dop);
        changes.put(key::navspg_tacc, message.t_acc);
    }
    if (masked(6)) {
        changes.put(key::mot_speed_threshold, message.static_hold_thresh);
        changes.put(key::mot_distance_threshold, message.static_hold_max_dist);
    }
    if (masked(7)) changes.put(key::navspg_dgnss_timeout, message.dgnss_timeout);
    if (masked(8)) {
        changes.put(key::navspg_cno_count, message.cno_thresh_num_svs);
        changes.put(key::navspg_cno_threshold, message.cno_thresh);
    }
    if (masked(10)) changes.put(key::navspg_utcstandard, message.utc_standard);
}

/// 2 from protocol version 18 on, 0 before (RECEIVER.md 3.3).
std::uint16_t navx5_version(const BoardProfile& board) {
    const int protocol = protocol_version(board);
    if (protocol == 0) return board.identity.generation >= 8 ? 2 : 0;
    return protocol >= 1800 ? 2 : 0;
}

CfgNavx5 describe_navx5(const LegacyContext& context) {
    CfgNavx5 message;
    message.version = navx5_version(context.board);
    message.mask1 = 0x664C;  // what M8 and F9P answer: every group that there is
    message.mask2 = 0xC0;
    message.min_svs = in_force<std::uint8_t>(context, key::navspg_min_svs);
    message.max_svs = in_force<std::uint8_t>(context, key::navspg_max_svs);
    message.min_cno = in_force<std::uint8_t>(context, key::navspg_min_cno);
    message.ini_fix_3d = in_force<std::uint8_t>(context, legacy_key::inifix3d);
    message.ack_aiding = in_force<std::uint8_t>(context, legacy_key::ack_aiding);
    message.wkn_rollover = in_force<std::uint16_t>(context, key::navspg_wknrollover);
    message.sig_atten_comp_mode = in_force<std::uint8_t>(context, legacy_key::sig_att_comp);
    message.use_ppp = in_force<std::uint8_t>(context, legacy_key::use_ppp);
    message.aop_cfg = in_force<std::uint8_t>(context, legacy_key::use_ana);
    message.aop_orb_max_err = in_force<std::uint16_t>(context, legacy_key::ana_max_error);
    message.use_adr = in_force<std::uint8_t>(context, legacy_key::use_adr);
    return message;
}

void put_navx5(LegacyChanges& changes, const CfgNavx5& message) {
    const auto masked = [&](unsigned bit) { return (message.mask1 >> bit & 1) != 0; };
    if (masked(2)) {
        changes.put(key::navspg_min_svs, message.min_svs);
        changes.put(key::navspg_max_svs, message.max_svs);
    }
    if (masked(3)) changes.put(key::navspg_min_cno, message.min_cno);
    if (masked(6)) changes.put(legacy_key::inifix3d, message.ini_fix_3d != 0);
    if (masked(9)) changes.put(key::navspg_wknrollover, message.wkn_rollover);
    if (masked(10)) changes.put(legacy_key::ack_aiding, message.ack_aiding != 0);
    if (masked(13)) changes.put(legacy_key::use_ppp, message.use_ppp != 0);
    if (masked(14)) {
        changes.put(legacy_key::use_ana, (message.aop_cfg & 1) != 0);
        changes.put(legacy_key::ana_max_error, message.aop_orb_max_err);
    }
    if ((message.mask2 >> 6 & 1) != 0) changes.put(legacy_key::use_adr, message.use_adr != 0);
    if ((message.mask2 >> 7 & 1) != 0) changes.put(legacy_key::sig_att_comp, message.sig_atten_comp_mode);
}

constexpr BitKey odo_flags[] = {{0, legacy_key::odo_use},
                                {1, legacy_key::odo_use_cog},
                                {2, legacy_key::odo_out_lp_vel},
                                {3, legacy_key::odo_out_lp_cog}};
constexpr unsigned geodetic_bit = 8;

CfgTmode3 describe_tmode3(const LegacyContext& context) {
    CfgTmode3 message;
    const bool geodetic = context.store.flag(legacy_key::tmode_pos_type);
    message.flags =
        static_cast<std::uint16_t>(in_force<unsigned>(context, key::tmode_mode) | (geodetic ? 1u : 0u) << geodetic_bit);
    const std::uint32_t first = geodetic ? legacy_key::tmode_geodetic : legacy_key::tmode_ecef;
    const std::uint32_t first_hp = geodetic ? legacy_key::tmode_geodetic_hp : legacy_key::tmode_ecef_hp;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        message.position[axis] = in_force<std::int32_t>(context, first + axis);
        message.position_hp[axis] = in_force<std::int8_t>(context, first_hp + axis);
    }
    message.fixed_pos_acc = in_force<std::uint32_t>(context, legacy_key::tmode_fixed_pos_acc);
    message.svin_min_dur = in_force<std::uint32_t>(context, legacy_key::tmode_svin_min_dur);
    message.svin_acc_limit = in_force<std::uint32_t>(context, legacy_key::tmode_svin_acc_limit);
    return message;
}

/// The high-precision part is less than one unit of the coarse one (F9 interface description, CFG-TMODE-ECEF_X_HP).
bool is_fraction(std::int8_t part) { return part >= -99 && part <= 99; }

}  // namespace

ConfigOutcome legacy_rate(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty())
        return legacy_answered(CfgRate{in_force<std::uint16_t>(context, key::rate_meas),
                                       in_force<std::uint16_t>(context, key::rate_nav),
                                       in_force<std::uint16_t>(context, key::rate_timeref)});
    const auto set = decode_payload<CfgRate>(payload);
    if (!set) return legacy_refused();
    LegacyChanges changes(context);
    // Too short a period is taken, clamped and read back so (RECEIVER.md 2.6).
    const auto least = static_cast<std::uint16_t>(context.board.least_measurement_period_ms);
    changes.put(key::rate_meas, std::max(set->meas_rate, least));
    changes.put(key::rate_nav, set->nav_rate);
    changes.put(key::rate_timeref, set->time_ref);
    return changes.apply();
}

ConfigOutcome legacy_nav5(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return legacy_answered(describe_nav5(context));
    const auto set = decode_payload<CfgNav5>(payload);
    if (!set) return legacy_refused();
    LegacyChanges changes(context);
    put_nav5(changes, *set);
    return changes.apply();
}

ConfigOutcome legacy_navx5(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return legacy_answered(describe_navx5(context));
    const auto set = decode_payload<CfgNavx5>(payload);
    if (!set || set->version != navx5_version(context.board)) return legacy_refused();
    LegacyChanges changes(context);
    put_navx5(changes, *set);
    return changes.apply();
}

ConfigOutcome legacy_odo(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) {
        CfgOdo answer;
        answer.flags = static_cast<std::uint8_t>(bits_in_force(context, odo_flags));
        answer.odo_cfg = in_force<std::uint8_t>(context, legacy_key::odo_profile);
        answer.cog_max_speed = in_force<std::uint8_t>(context, legacy_key::odo_cog_max_speed);
        answer.cog_max_pos_acc = in_force<std::uint8_t>(context, legacy_key::odo_cog_max_pos_acc);
        answer.vel_lp_gain = in_force<std::uint8_t>(context, legacy_key::odo_vel_lp_gain);
        answer.cog_lp_gain = in_force<std::uint8_t>(context, legacy_key::odo_cog_lp_gain);
        return legacy_answered(answer);
    }
    const auto set = decode_payload<CfgOdo>(payload);
    if (!set || set->version != 0) return legacy_refused();
    LegacyChanges changes(context);
    changes.put_bits(odo_flags, set->flags);
    changes.put(legacy_key::odo_profile, static_cast<std::uint8_t>(set->odo_cfg & 7));
    changes.put(legacy_key::odo_cog_max_speed, set->cog_max_speed);
    changes.put(legacy_key::odo_cog_max_pos_acc, set->cog_max_pos_acc);
    changes.put(legacy_key::odo_vel_lp_gain, set->vel_lp_gain);
    changes.put(legacy_key::odo_cog_lp_gain, set->cog_lp_gain);
    return changes.apply();
}

ConfigOutcome legacy_dgnss(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return legacy_answered(CfgDgnss{in_force<std::uint8_t>(context, key::navhpg_dgnssmode), {}});
    const auto set = decode_payload<CfgDgnss>(payload);
    if (!set) return legacy_refused();
    LegacyChanges changes(context);
    changes.put(key::navhpg_dgnssmode, set->dgnss_mode);
    return changes.apply();
}

ConfigOutcome legacy_tmode3(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return legacy_answered(describe_tmode3(context));
    const auto set = decode_payload<CfgTmode3>(payload);
    if (!set || set->version != 0 || !std::ranges::all_of(set->position_hp, is_fraction)) return legacy_refused();
    LegacyChanges changes(context);
    const bool geodetic = (set->flags >> geodetic_bit & 1) != 0;
    changes.put(key::tmode_mode, static_cast<std::uint8_t>(set->flags & 0xFF));
    changes.put(legacy_key::tmode_pos_type, static_cast<std::uint8_t>(geodetic));
    const std::uint32_t first = geodetic ? legacy_key::tmode_geodetic : legacy_key::tmode_ecef;
    const std::uint32_t first_hp = geodetic ? legacy_key::tmode_geodetic_hp : legacy_key::tmode_ecef_hp;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        changes.put(first + axis, set->position[axis]);
        changes.put(first_hp + axis, set->position_hp[axis]);
    }
    changes.put(legacy_key::tmode_fixed_pos_acc, set->fixed_pos_acc);
    changes.put(legacy_key::tmode_svin_min_dur, set->svin_min_dur);
    changes.put(legacy_key::tmode_svin_acc_limit, set->svin_acc_limit);
    return changes.apply();
}

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
