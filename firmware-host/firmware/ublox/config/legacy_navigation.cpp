// CFG-RATE, CFG-NAV5, CFG-NAVX5, CFG-ODO, CFG-DGNSS, CFG-TMODE3 (RECEIVER.md 3.3).
// CFG-GEOFENCE (M8 interface description).

#include <algorithm>

#include "firmware/core/geofence.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "firmware/ublox/config/legacy_keys.hpp"
#include "firmware/ublox/config/legacy_support.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_cfg_navigation.hpp"

namespace skyloop::firmware {
namespace {

/// The groups that CFG-NAV5's mask names (M8 interface description 32.11.17); a poll shows them all.
constexpr auto link_nav5 = [](auto& m, auto& v) {
    const auto masked = [&](unsigned bit) { return (m.mask >> bit & 1) != 0; };
    if (masked(0)) v.link(key::navspg_dynmodel, m.dyn_model);
    if (masked(1)) v.link(key::navspg_min_elev, m.min_elev);
    if (masked(2)) {
        v.link(key::navspg_fixmode, m.fix_mode);
        v.link(key::navspg_constr_alt, m.fixed_alt);
        v.link(key::navspg_constr_altvar, m.fixed_alt_var);
    }
    if (masked(3)) v.link(legacy_key::dr_limit, m.dr_limit);
    if (masked(4)) {
        v.link(key::navspg_pdop, m.p_dop);
        v.link(key::navspg_pacc, m.p_acc);
    }
    if (masked(5)) {
        v.link(key::navspg_tdop, m.t_dop);
        v.link(key::navspg_tacc, m.t_acc);
    }
    if (masked(6)) {
        v.link(key::mot_speed_threshold, m.static_hold_thresh);
        v.link(key::mot_distance_threshold, m.static_hold_max_dist);
    }
    if (masked(7)) v.link(key::navspg_dgnss_timeout, m.dgnss_timeout);
    if (masked(8)) {
        v.link(key::navspg_cno_count, m.cno_thresh_num_svs);
        v.link(key::navspg_cno_threshold, m.cno_thresh);
    }
    if (masked(10)) v.link(key::navspg_utcstandard, m.utc_standard);
};

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
constexpr auto link_odo = [](auto& m, auto& v) {
    v.link(odo_flags, m.flags);
    v.link(legacy_key::odo_cog_max_speed, m.cog_max_speed);
    v.link(legacy_key::odo_cog_max_pos_acc, m.cog_max_pos_acc);
    v.link(legacy_key::odo_vel_lp_gain, m.vel_lp_gain);
    v.link(legacy_key::odo_cog_lp_gain, m.cog_lp_gain);
};

constexpr auto link_dgnss = [](auto& m, auto& v) { v.link(key::navhpg_dgnssmode, m.dgnss_mode); };

constexpr unsigned geodetic_bit = 8;

/// What the flags do not hold; they say which of the two kinds of items the position is.
constexpr auto link_tmode3 = [](auto& m, auto& v) {
    const bool geodetic = (m.flags >> geodetic_bit & 1) != 0;
    const std::uint32_t first = geodetic ? legacy_key::tmode_geodetic : legacy_key::tmode_ecef;
    const std::uint32_t first_hp = geodetic ? legacy_key::tmode_geodetic_hp : legacy_key::tmode_ecef_hp;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        v.link(first + axis, m.position[axis]);
        v.link(first_hp + axis, m.position_hp[axis]);
    }
    v.link(legacy_key::tmode_fixed_pos_acc, m.fixed_pos_acc);
    v.link(legacy_key::tmode_svin_min_dur, m.svin_min_dur);
    v.link(legacy_key::tmode_svin_acc_limit, m.svin_acc_limit);
};

std::uint16_t tmode3_flags(const LegacyContext& context) {
    const unsigned geodetic = context.store.flag(legacy_key::tmode_pos_type) ? 1 : 0;
    return static_cast<std::uint16_t>(in_force<unsigned>(context, key::tmode_mode) | geodetic << geodetic_bit);
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
    changes.put(key::rate_meas, std::max(set->meas_rate.raw, least));
    changes.put(key::rate_nav, set->nav_rate);
    changes.put(key::rate_timeref, set->time_ref);
    return changes.apply();
}

ConfigOutcome legacy_nav5(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return legacy_poll(context, CfgNav5{.mask = 0xFFFF}, link_nav5);
    const auto set = decode_payload<CfgNav5>(payload);
    return set ? legacy_set(context, *set, link_nav5) : legacy_refused();
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
    if (payload.empty())
        return legacy_poll(context, CfgOdo{.odo_cfg = in_force<std::uint8_t>(context, legacy_key::odo_profile)},
                           link_odo);
    const auto set = decode_payload<CfgOdo>(payload);
    if (!set || set->version != 0) return legacy_refused();
    LegacyChanges changes(context);
    link_odo(*set, changes);
    changes.put(legacy_key::odo_profile, static_cast<std::uint8_t>(set->odo_cfg & 7));
    return changes.apply();
}

ConfigOutcome legacy_dgnss(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return legacy_poll(context, CfgDgnss{}, link_dgnss);
    const auto set = decode_payload<CfgDgnss>(payload);
    return set ? legacy_set(context, *set, link_dgnss) : legacy_refused();
}

ConfigOutcome legacy_tmode3(const LegacyContext& context, ByteSpan payload) {
    if (payload.empty()) return legacy_poll(context, CfgTmode3{.flags = tmode3_flags(context)}, link_tmode3);
    const auto set = decode_payload<CfgTmode3>(payload);
    if (!set || set->version != 0 || !std::ranges::all_of(set->position_hp, is_fraction)) return legacy_refused();
    LegacyChanges changes(context);
    changes.put(key::tmode_mode, static_cast<std::uint8_t>(set->flags & 0xFF));
    changes.put(legacy_key::tmode_pos_type, static_cast<std::uint8_t>(set->flags >> geodetic_bit & 1));
    link_tmode3(*set, changes);
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
