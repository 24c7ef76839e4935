/// UBX messages about orbits, corrections, fences and bounds.
///
/// Numbers are as on the wire; a member's comment gives unit and scale. Each message names where its layout stands: a
/// section of RECEIVER.md, or the message of that name in the M8 (UBX-13003221), F9 (HPG 1.32, UBX-22008968) or M10
/// (SPG 5.10) interface description.
///
/// UBX messages of base stations: NAV-RELPOSNED and NAV-SVIN.
///
/// Numbers are as on the wire; a member's comment gives unit and scale. Each message names where its layout stands: a
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
    std::uint8_t gnss_id = 0;  ///< 0 GPS, 1 SBAS, 2 Galileo, 3 BeiDou, 5 QZSS, 6 GLONASS
    std::uint8_t sv_id = 0;
    std::uint8_t sv_flag = 0;    ///< bits: 0-1 health, 2-3 visibility
    std::uint8_t eph = 0;        ///< bits: 0-4 usable for n·15 min, 31 unknown, 5-7 source
    std::uint8_t alm = 0;        ///< bits: 0-4 usable for n days, 31 unknown, 5-7 source
    std::uint8_t other_orb = 0;  ///< bits: 0-4 usable, 5-7 kind
};

/// NAV-ORB: what is known of orbits (RECEIVER.md 3.1).
struct NavOrb {
    static constexpr UbxMessageId message_id{0x01, 0x34};
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::uint8_t version = 1;  ///< 1
    std::array<std::uint8_t, 2> reserved{};
    std::vector<NavOrbItem> satellites;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.version);
        v.count(m.satellites);
        v(m.reserved);
        v.items(m.satellites);
    }
};

/// One satellite of NAV-SBAS.
struct NavSbasItem {
    std::uint8_t sv_id = 0;
    std::uint8_t flags = 0;
    std::uint8_t udre = 0;
    std::uint8_t sv_sys = 0;      ///< as NavSbas::sys
    std::uint8_t sv_service = 0;  ///< as NavSbas::service
    std::uint8_t reserved2 = 0;
    std::int16_t prc = 0;  ///< cm
    std::array<std::uint8_t, 2> reserved3{};
    std::int16_t ic = 0;  ///< cm
};

/// NAV-SBAS: augmentation by satellites (RECEIVER.md 3.1).
struct NavSbas {
    static constexpr UbxMessageId message_id{0x01, 0x32};
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::uint8_t geo = 0;      ///< PRN in use, 0 none
    std::uint8_t mode = 0;     ///< 0 off, 1 integrity, 3 test
    std::int8_t sys = 0;       ///< -1 unknown, 0 WAAS, 1 EGNOS, 2 MSAS, 3 GAGAN, 16 GPS
    std::uint8_t service = 0;  ///< bits: 0 ranging, 1 corrections, 2 integrity, 3 test, 4 bad
    std::uint8_t status_flags = 0;
    std::array<std::uint8_t, 2> reserved1{};
    std::vector<NavSbasItem> satellites;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.geo, m.mode, m.sys, m.service);
        v.count(m.satellites);
        v(m.status_flags, m.reserved1);
        v.items(m.satellites);
    }
};

/// One satellite of NAV-DGPS.
struct NavDgpsItem {
    std::uint8_t sv_id = 0;   ///< one numbering for all systems
    std::uint8_t flags = 0;   ///< bits: 0-3 channel, 4 used
    std::uint16_t age_c = 0;  ///< ms
    float prc = 0;            ///< m
    float prrc = 0;           ///< m/s
};

/// NAV-DGPS: differential corrections (M8 interface description).
struct NavDgps {
    static constexpr UbxMessageId message_id{0x01, 0x31};
    std::uint32_t i_tow = 0;  ///< ms, GPS time of week of the epoch
    std::int32_t age = 0;     ///< ms of the newest correction
    std::int16_t base_id = 0;
    std::int16_t base_health = 0;
    std::uint8_t status = 0;  ///< 0 none, 1 ranges, 2 ranges and rates
    std::array<std::uint8_t, 2> reserved1{};
    std::vector<NavDgpsItem> satellites;

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
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::uint8_t aop_cfg = 0;  ///< bit 0: on
    std::uint8_t status = 0;   ///< 0 idle, 1 running
    std::array<std::uint8_t, 10> reserved{};
};

/// One fence of NAV-GEOFENCE.
struct NavGeofenceItem {
    std::uint8_t state = 0;  ///< 0 unknown, 1 inside, 2 outside
    std::uint8_t id = 0;
};

/// NAV-GEOFENCE: fences (M8 interface description).
struct NavGeofence {
    static constexpr UbxMessageId message_id{0x01, 0x39};
    std::uint32_t i_tow = 0;      ///< ms, GPS time of week of the epoch
    std::uint8_t version = 0;     ///< 0
    std::uint8_t status = 0;      ///< 1: on
    std::uint8_t comb_state = 0;  ///< 0 unknown, 1 inside, 2 outside
    std::vector<NavGeofenceItem> fences;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.version, m.status);
        v.count(m.fences);
        v(m.comb_state);
        v.items(m.fences);
    }
};

/// One satellite of NAV-SLAS.
struct NavSlasItem {
    std::uint8_t gnss_id = 0;
    std::uint8_t sv_id = 0;
    std::uint8_t reserved1 = 0;
    std::array<std::uint8_t, 3> reserved2{};
    std::int16_t prc = 0;  ///< cm
};

/// NAV-SLAS: corrections of QZSS (F9 interface description).
struct NavSlas {
    static constexpr UbxMessageId message_id{0x01, 0x42};
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 3> reserved0{};
    std::int32_t gms_lon = 0;  ///< 1e-3 deg
    std::int32_t gms_lat = 0;  ///< 1e-3 deg
    std::uint8_t gms_code = 0;
    std::uint8_t qzss_sv_id = 0;
    std::uint8_t service_flags = 0;  ///< bits: 0 station available, 1 satellite available, 2 test
    std::vector<NavSlasItem> satellites;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.version, m.reserved0, m.gms_lon, m.gms_lat, m.gms_code, m.qzss_sv_id, m.service_flags);
        v.count(m.satellites);
        v.items(m.satellites);
    }
};

/// NAV-PL: protection levels (F9 interface description HPG 1.30).
struct NavPl {
    static constexpr UbxMessageId message_id{0x01, 0x62};
    std::uint8_t version = 1;     ///< 1
    std::uint8_t tmir_coeff = 0;  ///< target of the misleading information risk, coefficient
    std::int8_t tmir_exp = 0;     ///< and exponent
    std::uint8_t pl_pos_valid = 0;
    std::uint8_t pl_pos_frame = 0;  ///< 0 invalid, 1 north east down, 2 track, 3 semi-major axis
    std::uint8_t pl_vel_valid = 0;
    std::uint8_t pl_vel_frame = 0;
    std::uint8_t pl_time_valid = 0;
    std::array<std::uint8_t, 3> invalidity_reason{};  ///< of position, velocity, time; 0: valid
    std::uint8_t reserved0 = 0;
    std::uint32_t i_tow = 0;                ///< ms, GPS time of week of the epoch
    std::array<std::uint32_t, 3> pl_pos{};  ///< mm
    std::array<std::uint32_t, 3> pl_vel{};  ///< mm/s
    std::uint16_t pl_pos_horiz_orient = 0;  ///< 0.01 deg
    std::uint16_t pl_vel_horiz_orient = 0;  ///< 0.01 deg
    std::uint32_t pl_time = 0;              ///< ns
    std::array<std::uint8_t, 4> reserved1{};
};

/// NAV-RELPOSNED version 0: from base to rover, 40 bytes (M8P; RECEIVER.md 3.1).
struct NavRelposned0 {
    static constexpr UbxMessageId message_id{0x01, 0x3C};
    std::uint8_t version = 0;  ///< 0
    std::uint8_t reserved1 = 0;
    std::uint16_t ref_station_id = 0;         ///< 0 to 4095
    std::uint32_t i_tow = 0;                  ///< ms, GPS time of week of the epoch
    std::array<std::int32_t, 3> rel_pos{};    ///< cm north, east, down
    std::array<std::int8_t, 3> rel_pos_hp{};  ///< 0.1 mm, to add
    std::uint8_t reserved2 = 0;
    std::array<std::uint32_t, 3> acc{};  ///< 0.1 mm north, east, down
    std::uint32_t flags =
        0;  ///< bits: 0 fix ok, 1 differential, 2 vector valid, 3-4 carrier solution, 5 moving base, 6-7 base missed
};

/// NAV-RELPOSNED version 1: from base to rover, 64 bytes (F9; RECEIVER.md 3.1).
struct NavRelposned {
    static constexpr UbxMessageId message_id{0x01, 0x3C};
    std::uint8_t version = 1;  ///< 1
    std::uint8_t reserved0 = 0;
    std::uint16_t ref_station_id = 0;       ///< 0 to 4095
    std::uint32_t i_tow = 0;                ///< ms, GPS time of week of the epoch
    std::array<std::int32_t, 3> rel_pos{};  ///< cm north, east, down
    std::int32_t rel_pos_length = 0;        ///< cm
    std::int32_t rel_pos_heading = 0;       ///< 1e-5 deg
    std::array<std::uint8_t, 4> reserved1{};
    std::array<std::int8_t, 3> rel_pos_hp{};  ///< 0.1 mm, to add
    std::int8_t rel_pos_length_hp = 0;        ///< 0.1 mm, to add
    std::array<std::uint32_t, 3> acc{};       ///< 0.1 mm north, east, down
    std::uint32_t acc_length = 0;             ///< 0.1 mm
    std::uint32_t acc_heading = 0;            ///< 1e-5 deg
    std::array<std::uint8_t, 4> reserved2{};
    std::uint32_t flags = 0;  ///< bits: 0 fix ok, 1 differential, 2 vector valid, 3-4 carrier solution, 5 moving base,
                              ///< 6-7 base missed, 8 heading
};

/// NAV-SVIN: survey of the base's place (RECEIVER.md 3.1).
struct NavSvin {
    static constexpr UbxMessageId message_id{0x01, 0x3B};
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 3> reserved1{};
    std::uint32_t i_tow = 0;               ///< ms, GPS time of week of the epoch
    std::uint32_t dur = 0;                 ///< s
    std::array<std::int32_t, 3> mean{};    ///< cm, Earth-fixed
    std::array<std::int8_t, 3> mean_hp{};  ///< 0.1 mm, to add
    std::uint8_t reserved2 = 0;
    std::uint32_t mean_acc = 0;  ///< 0.1 mm
    std::uint32_t obs = 0;       ///< positions used
    std::uint8_t valid = 0;
    std::uint8_t active = 0;
    std::array<std::uint8_t, 2> reserved3{};
};

}  // namespace skyloop::inline receiver
