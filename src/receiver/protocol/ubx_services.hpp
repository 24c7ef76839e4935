/// UBX messages about orbits, corrections, fences and bounds.
///
/// Fields are declared as field.hpp says. Each message names where its layout stands: a
/// section of RECEIVER.md, or the message of that name in the M8 (UBX-13003221), F9 (HPG 1.32, UBX-22008968) or M10
/// (SPG 5.10) interface description.
///
/// UBX messages of base stations: NAV-RELPOSNED and NAV-SVIN.
///
/// Fields are declared as field.hpp says. Each message names where its layout stands: a
/// section of RECEIVER.md, or the message of that name in the M8 (UBX-13003221), F9 (HPG 1.32, UBX-22008968) or M10
/// (SPG 5.10) interface description.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "receiver/protocol/ubx_fields.hpp"

namespace skyloop::inline receiver {

/// One satellite of NAV-ORB.
struct NavOrbItem {
    U1<"gnss_id"> gnss_id{};  ///< 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS
    U1<"sv_id"> sv_id{};
    U1<"flags"> sv_flag{};    ///< bits: 0-1 health, 2-3 visibility
    U1<"ephemeris"> eph{};    ///< bits: 0-4 usable for n·15 min, 31 unknown, 5-7 source
    U1<"almanac"> alm{};      ///< bits: 0-4 usable for n days, 31 unknown, 5-7 source
    U1<"other"> other_orb{};  ///< bits: 0-4 usable, 5-7 kind
};

/// NAV-ORB: what is known of orbits (RECEIVER.md 3.1).
struct NavOrb {
    static constexpr UbxMessageId message_id{0x01, 0x34};
    U4<"tow_s*1e-3"> i_tow{};   ///< GPS time of week of the epoch
    U1<"version"> version = 1;  ///< 1
    std::array<std::uint8_t, 2> reserved{};
    List<"satellites", NavOrbItem> satellites;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.version);
        v.count(m.satellites);
        v(m.reserved);
        v.items(m.satellites);
    }
};

/// One satellite of NAV-SBAS.
struct NavSbasItem {
    U1<"sv_id"> sv_id{};
    U1<"flags"> flags{};
    U1<"udre"> udre{};
    U1<"system"> sv_sys{};       ///< as NavSbas::sys
    U1<"service"> sv_service{};  ///< as NavSbas::service
    std::uint8_t reserved2 = 0;
    I2<"correction_m*1e-2"> prc{};
    std::array<std::uint8_t, 2> reserved3{};
    I2<"ionosphere_m*1e-2"> ic{};
};

/// NAV-SBAS: augmentation by satellites (RECEIVER.md 3.1).
struct NavSbas {
    static constexpr UbxMessageId message_id{0x01, 0x32};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U1<"geo"> geo{};           ///< PRN in use, 0 none
    U1<"mode"> mode{};         ///< 0 off, 1 integrity, 3 test
    I1<"system"> sys{};        ///< -1 unknown, 0 WAAS, 1 EGNOS, 2 MSAS, 3 GAGAN, 16 GPS
    U1<"service"> service{};   ///< bits: 0 ranging, 1 corrections, 2 integrity, 3 test, 4 bad
    U1<"status"> status_flags{};
    std::array<std::uint8_t, 2> reserved1{};
    List<"satellites", NavSbasItem> satellites;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.geo, m.mode, m.sys, m.service);
        v.count(m.satellites);
        v(m.status_flags, m.reserved1);
        v.items(m.satellites);
    }
};

/// One satellite of NAV-DGPS.
struct NavDgpsItem {
    U1<"sv_id"> sv_id{};  ///< one numbering for all systems
    U1<"flags"> flags{};  ///< bits: 0-3 channel, 4 used
    U2<"age_s*1e-3"> age_c{};
    R4<"correction_m"> prc{};
    R4<"correction_rate_mps"> prrc{};
};

/// NAV-DGPS: differential corrections (M8 interface description).
struct NavDgps {
    static constexpr UbxMessageId message_id{0x01, 0x31};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    I4<"age_s*1e-3"> age{};    ///< of the newest correction
    I2<"station"> base_id{};
    I2<"health"> base_health{};
    U1<"status"> status{};  ///< 0 none, 1 ranges, 2 ranges and rates
    std::array<std::uint8_t, 2> reserved1{};
    List<"channels", NavDgpsItem> satellites;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.age, m.base_id, m.base_health);
        v.count(m.satellites);
        v(m.status, m.reserved1);
        v.items(m.satellites);
    }
};

/// NAV-AOPSTATUS: orbits that the receiver predicts itself (M8 interface description).
struct NavAopstatus {
    static constexpr UbxMessageId message_id{0x01, 0x60};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U1<"config"> aop_cfg{};    ///< bit 0: on
    U1<"status"> status{};     ///< 0 idle, 1 running
    std::array<std::uint8_t, 10> reserved{};
};

/// One fence of NAV-GEOFENCE.
struct NavGeofenceItem {
    U1<"state"> state{};  ///< 0 unknown, 1 inside, 2 outside
    U1<"id"> id{};
};

/// NAV-GEOFENCE: fences (M8 interface description).
struct NavGeofence {
    static constexpr UbxMessageId message_id{0x01, 0x39};
    U4<"tow_s*1e-3"> i_tow{};     ///< GPS time of week of the epoch
    U1<"version"> version{};      ///< 0
    U1<"status"> status{};        ///< 1: on
    U1<"combined"> comb_state{};  ///< 0 unknown, 1 inside, 2 outside
    List<"fences", NavGeofenceItem> fences;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.version, m.status);
        v.count(m.fences);
        v(m.comb_state);
        v.items(m.fences);
    }
};

/// One satellite of NAV-SLAS.
struct NavSlasItem {
    U1<"gnss_id"> gnss_id{};
    U1<"sv_id"> sv_id{};
    std::uint8_t reserved1 = 0;
    std::array<std::uint8_t, 3> reserved2{};
    I2<"correction_m*1e-2"> prc{};
};

/// NAV-SLAS: corrections of QZSS (F9 interface description).
struct NavSlas {
    static constexpr UbxMessageId message_id{0x01, 0x42};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U1<"version"> version{};   ///< 0
    std::array<std::uint8_t, 3> reserved0{};
    I4<"station_lon_deg*1e-3"> gms_lon{};
    I4<"station_lat_deg*1e-3"> gms_lat{};
    U1<"station"> gms_code{};
    U1<"qzss_sv_id"> qzss_sv_id{};
    U1<"flags"> service_flags{};  ///< bits: 0 station available, 1 satellite available, 2 test
    List<"satellites", NavSlasItem> satellites;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.version, m.reserved0, m.gms_lon, m.gms_lat, m.gms_code, m.qzss_sv_id, m.service_flags);
        v.count(m.satellites);
        v.items(m.satellites);
    }
};

/// NAV-PL: protection levels (F9 interface description HPG 1.30).
struct NavPl {
    static constexpr UbxMessageId message_id{0x01, 0x62};
    U1<"version"> version = 1;            ///< 1
    U1<"risk_coefficient"> tmir_coeff{};  ///< target of the misleading information risk, coefficient
    I1<"risk_exponent"> tmir_exp{};       ///< and exponent
    U1<"position_valid"> pl_pos_valid{};
    U1<"position_frame"> pl_pos_frame{};  ///< 0 invalid, 1 north east down, 2 track, 3 semi-major axis
    U1<"velocity_valid"> pl_vel_valid{};
    U1<"velocity_frame"> pl_vel_frame{};
    U1<"time_valid"> pl_time_valid{};
    U1<"invalidity_reasons", 3> invalidity_reason{};  ///< of position, velocity, time; 0: valid
    std::uint8_t reserved0 = 0;
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U4<"position_level_m*1e-3", 3> pl_pos{};
    U4<"velocity_level_mps*1e-3", 3> pl_vel{};
    U2<"position_orientation_deg*1e-2"> pl_pos_horiz_orient{};
    U2<"velocity_orientation_deg*1e-2"> pl_vel_horiz_orient{};
    U4<"time_level_ns"> pl_time{};
    std::array<std::uint8_t, 4> reserved1{};
};

/// NAV-RELPOSNED version 0: from base to rover, 40 bytes (M8P; RECEIVER.md 3.1).
struct NavRelposned0 {
    static constexpr UbxMessageId message_id{0x01, 0x3C};
    U1<"version"> version{};  ///< 0
    std::uint8_t reserved1 = 0;
    U2<"station"> ref_station_id{};                ///< 0 to 4095
    U4<"tow_s*1e-3"> i_tow{};                      ///< GPS time of week of the epoch
    I4<"relative_ned_m*1e-2", 3> rel_pos{};        ///< north, east, down
    I1<"relative_ned_hp_m*1e-4", 3> rel_pos_hp{};  ///< to add
    std::uint8_t reserved2 = 0;
    U4<"acc_ned_m*1e-4", 3> acc{};  ///< north, east, down
    U4<"flags"> flags{};  ///< bits: 0 fix ok, 1 differential, 2 vector valid, 3-4 carrier solution, 5 moving base, 6-7
                          ///< base missed
};

/// NAV-RELPOSNED version 1: from base to rover, 64 bytes (F9; RECEIVER.md 3.1).
struct NavRelposned {
    static constexpr UbxMessageId message_id{0x01, 0x3C};
    U1<"version"> version = 1;  ///< 1
    std::uint8_t reserved0 = 0;
    U2<"station"> ref_station_id{};          ///< 0 to 4095
    U4<"tow_s*1e-3"> i_tow{};                ///< GPS time of week of the epoch
    I4<"relative_ned_m*1e-2", 3> rel_pos{};  ///< north, east, down
    I4<"length_m*1e-2"> rel_pos_length{};
    I4<"heading_deg*1e-5"> rel_pos_heading{};
    std::array<std::uint8_t, 4> reserved1{};
    I1<"relative_ned_hp_m*1e-4", 3> rel_pos_hp{};  ///< to add
    I1<"length_hp_m*1e-4"> rel_pos_length_hp{};    ///< to add
    U4<"acc_ned_m*1e-4", 3> acc{};                 ///< north, east, down
    U4<"acc_length_m*1e-4"> acc_length{};
    U4<"acc_heading_deg*1e-5"> acc_heading{};
    std::array<std::uint8_t, 4> reserved2{};
    U4<"flags"> flags{};  ///< bits: 0 fix ok, 1 differential, 2 vector valid, 3-4 carrier solution, 5 moving base,
                          ///< 6-7 base missed, 8 heading
};

/// NAV-SVIN: survey of the base's place (RECEIVER.md 3.1).
struct NavSvin {
    static constexpr UbxMessageId message_id{0x01, 0x3B};
    U1<"version"> version{};  ///< 0
    std::array<std::uint8_t, 3> reserved1{};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U4<"duration_s"> dur{};
    I4<"mean_ecef_m*1e-2", 3> mean{};        ///< Earth-fixed
    I1<"mean_ecef_hp_m*1e-4", 3> mean_hp{};  ///< to add
    std::uint8_t reserved2 = 0;
    U4<"mean_acc_m*1e-4"> mean_acc{};
    U4<"observations"> obs{};  ///< positions used
    U1<"valid"> valid{};
    U1<"active"> active{};
    std::array<std::uint8_t, 2> reserved3{};
};

}  // namespace skyloop::inline receiver
