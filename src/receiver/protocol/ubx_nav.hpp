/// UBX messages of class NAV that carry the solution.
///
/// Numbers are as on the wire; a member's comment gives unit and scale. Sections are those of the u-blox M8 interface
/// description (UBX-13003221) and, where named, of the F9 one (HPG 1.32, UBX-22008968).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "receiver/protocol/ubx_fields.hpp"

namespace skyloop::inline receiver {

/// What NAV-PVT gained after u-blox 7: heading of the vehicle and magnetic declination.
struct NavPvtVehicle {
    std::int32_t head_veh = 0;  ///< 1e-5 deg
    std::int16_t mag_dec = 0;   ///< 0.01 deg
    std::uint16_t mag_acc = 0;  ///< 0.01 deg
};

/// NAV-PVT: position, velocity and time; 92 bytes, 84 on u-blox 7.
struct NavPvt {
    static constexpr UbxMessageId message_id{0x01, 0x07};
    std::uint32_t i_tow = 0;  ///< ms, GPS time of week of the epoch
    std::uint16_t year = 0;   ///< UTC
    std::uint8_t month = 0;   ///< 1 to 12
    std::uint8_t day = 0;
    std::uint8_t hour = 0;
    std::uint8_t minute = 0;
    std::uint8_t second = 0;    ///< 0 to 60
    std::uint8_t valid = 0;     ///< bits: 0 date, 1 time, 2 fully resolved, 3 magnetic declination
    std::uint32_t t_acc = 0;    ///< ns
    std::int32_t nano = 0;      ///< ns, -1e9 to 1e9
    std::uint8_t fix_type = 0;  ///< 0 none, 1 dead reckoning, 2 2D, 3 3D, 4 combined, 5 time only
    std::uint8_t flags = 0;   ///< bits: 0 fix ok, 1 differential, 2-4 power save, 5 heading valid, 6-7 carrier solution
    std::uint8_t flags2 = 0;  ///< bits: 5 confirmation available, 6 date confirmed, 7 time confirmed
    std::uint8_t num_sv = 0;  ///< satellites used
    std::int32_t lon = 0;     ///< 1e-7 deg
    std::int32_t lat = 0;     ///< 1e-7 deg
    std::int32_t height = 0;  ///< mm above the ellipsoid
    std::int32_t h_msl = 0;   ///< mm above mean sea level
    std::uint32_t h_acc = 0;  ///< mm
    std::uint32_t v_acc = 0;  ///< mm
    std::int32_t vel_n = 0;   ///< mm/s
    std::int32_t vel_e = 0;   ///< mm/s
    std::int32_t vel_d = 0;   ///< mm/s, down positive
    std::int32_t g_speed = 0;    ///< mm/s, horizontal
    std::int32_t head_mot = 0;   ///< 1e-5 deg
    std::uint32_t s_acc = 0;     ///< mm/s
    std::uint32_t head_acc = 0;  ///< 1e-5 deg
    std::uint16_t p_dop = 0;     ///< 0.01
    std::uint16_t flags3 = 0;    ///< bits: 0 invalid position, 1-4 age of corrections
    std::uint32_t reserved = 0;
    std::optional<NavPvtVehicle> vehicle;  ///< absent on u-blox 7

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.year, m.month, m.day, m.hour, m.minute, m.second, m.valid, m.t_acc, m.nano, m.fix_type, m.flags,
          m.flags2, m.num_sv, m.lon, m.lat, m.height, m.h_msl, m.h_acc, m.v_acc, m.vel_n, m.vel_e, m.vel_d, m.g_speed,
          m.head_mot, m.s_acc, m.head_acc, m.p_dop, m.flags3, m.reserved);
        v.if_present(m.vehicle);
    }
};

/// NAV-POSECEF: position in the Earth-fixed frame.
struct NavPosecef {
    static constexpr UbxMessageId message_id{0x01, 0x01};
    std::uint32_t i_tow = 0;             ///< ms, GPS time of week of the epoch
    std::array<std::int32_t, 3> ecef{};  ///< cm
    std::uint32_t p_acc = 0;             ///< cm
};

/// NAV-POSLLH: geodetic position.
struct NavPosllh {
    static constexpr UbxMessageId message_id{0x01, 0x02};
    std::uint32_t i_tow = 0;  ///< ms, GPS time of week of the epoch
    std::int32_t lon = 0;     ///< 1e-7 deg
    std::int32_t lat = 0;     ///< 1e-7 deg
    std::int32_t height = 0;  ///< mm above the ellipsoid
    std::int32_t h_msl = 0;   ///< mm above mean sea level
    std::uint32_t h_acc = 0;  ///< mm
    std::uint32_t v_acc = 0;  ///< mm
};

/// NAV-STATUS: state of the navigation.
struct NavStatus {
    static constexpr UbxMessageId message_id{0x01, 0x03};
    std::uint32_t i_tow = 0;    ///< ms, GPS time of week of the epoch
    std::uint8_t gps_fix = 0;   ///< as NavPvt::fix_type
    std::uint8_t flags = 0;     ///< bits: 0 fix ok, 1 differential, 2 week set, 3 time of week set
    std::uint8_t fix_stat = 0;  ///< bits: 0 corrections, 1 carrier solution valid, 6-7 map matching
    std::uint8_t flags2 = 0;    ///< bits: 0-1 power save, 3-4 spoofing, 6-7 carrier solution
    std::uint32_t ttff = 0;     ///< ms to the first fix
    std::uint32_t msss = 0;     ///< ms since start-up
};

/// NAV-DOP: dilutions of precision, each 0.01.
struct NavDop {
    static constexpr UbxMessageId message_id{0x01, 0x04};
    std::uint32_t i_tow = 0;  ///< ms, GPS time of week of the epoch
    std::uint16_t g_dop = 0;
    std::uint16_t p_dop = 0;
    std::uint16_t t_dop = 0;
    std::uint16_t v_dop = 0;
    std::uint16_t h_dop = 0;
    std::uint16_t n_dop = 0;
    std::uint16_t e_dop = 0;
};

/// NAV-SOL: solution in the Earth-fixed frame (M8 and older).
struct NavSol {
    static constexpr UbxMessageId message_id{0x01, 0x06};
    std::uint32_t i_tow = 0;               ///< ms, GPS time of week of the epoch
    std::int32_t f_tow = 0;                ///< ns
    std::int16_t week = 0;                 ///< GPS week
    std::uint8_t gps_fix = 0;              ///< as NavPvt::fix_type
    std::uint8_t flags = 0;                ///< as NavStatus::flags
    std::array<std::int32_t, 3> ecef{};    ///< cm
    std::uint32_t p_acc = 0;               ///< cm
    std::array<std::int32_t, 3> ecef_v{};  ///< cm/s
    std::uint32_t s_acc = 0;               ///< cm/s
    std::uint16_t p_dop = 0;               ///< 0.01
    std::uint8_t reserved1 = 0;
    std::uint8_t num_sv = 0;  ///< satellites used
    std::uint32_t reserved2 = 0;
};

/// NAV-VELNED: velocity in the local frame.
struct NavVelned {
    static constexpr UbxMessageId message_id{0x01, 0x12};
    std::uint32_t i_tow = 0;    ///< ms, GPS time of week of the epoch
    std::int32_t vel_n = 0;     ///< cm/s
    std::int32_t vel_e = 0;     ///< cm/s
    std::int32_t vel_d = 0;     ///< cm/s, down positive
    std::uint32_t speed = 0;    ///< cm/s, in three dimensions
    std::uint32_t g_speed = 0;  ///< cm/s, horizontal
    std::int32_t heading = 0;   ///< 1e-5 deg
    std::uint32_t s_acc = 0;    ///< cm/s
    std::uint32_t c_acc = 0;    ///< 1e-5 deg
};

/// NAV-HPPOSLLH: geodetic position with more digits.
struct NavHpposllh {
    static constexpr UbxMessageId message_id{0x01, 0x14};
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 2> reserved{};
    std::uint8_t flags = 0;     ///< bit 0: invalid
    std::uint32_t i_tow = 0;    ///< ms, GPS time of week of the epoch
    std::int32_t lon = 0;       ///< 1e-7 deg
    std::int32_t lat = 0;       ///< 1e-7 deg
    std::int32_t height = 0;    ///< mm above the ellipsoid
    std::int32_t h_msl = 0;     ///< mm above mean sea level
    std::int8_t lon_hp = 0;     ///< 1e-9 deg, to add
    std::int8_t lat_hp = 0;     ///< 1e-9 deg, to add
    std::int8_t height_hp = 0;  ///< 0.1 mm, to add
    std::int8_t h_msl_hp = 0;   ///< 0.1 mm, to add
    std::uint32_t h_acc = 0;    ///< 0.1 mm
    std::uint32_t v_acc = 0;    ///< 0.1 mm
};

/// NAV-COV: covariances in north, east, down, in the order NN, NE, ND, EE, ED, DD.
struct NavCov {
    static constexpr UbxMessageId message_id{0x01, 0x36};
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::uint8_t version = 0;  ///< 0
    std::uint8_t pos_cov_valid = 0;
    std::uint8_t vel_cov_valid = 0;
    std::array<std::uint8_t, 9> reserved{};
    std::array<float, 6> pos_cov{};  ///< m²
    std::array<float, 6> vel_cov{};  ///< m²/s²
};

/// NAV-EOE: the last NAV message of an epoch.
struct NavEoe {
    static constexpr UbxMessageId message_id{0x01, 0x61};
    std::uint32_t i_tow = 0;  ///< ms, GPS time of week of the epoch
};

/// NAV-VELECEF: velocity in the Earth-fixed frame (RECEIVER.md 3.1).
struct NavVelecef {
    static constexpr UbxMessageId message_id{0x01, 0x11};
    std::uint32_t i_tow = 0;               ///< ms, GPS time of week of the epoch
    std::array<std::int32_t, 3> ecef_v{};  ///< cm/s
    std::uint32_t s_acc = 0;               ///< cm/s
};

/// NAV-HPPOSECEF: position in the Earth-fixed frame with more digits (RECEIVER.md 3.1).
struct NavHpposecef {
    static constexpr UbxMessageId message_id{0x01, 0x13};
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 3> reserved{};
    std::uint32_t i_tow = 0;               ///< ms, GPS time of week of the epoch
    std::array<std::int32_t, 3> ecef{};    ///< cm
    std::array<std::int8_t, 3> ecef_hp{};  ///< 0.1 mm, to add
    std::uint8_t flags = 0;                ///< bit 0: invalid
    std::uint32_t p_acc = 0;               ///< 0.1 mm
};

/// NAV-ODO: odometer (RECEIVER.md 3.1).
struct NavOdo {
    static constexpr UbxMessageId message_id{0x01, 0x09};
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 3> reserved{};
    std::uint32_t i_tow = 0;           ///< ms, GPS time of week of the epoch
    std::uint32_t distance = 0;        ///< m since NAV-RESETODO
    std::uint32_t total_distance = 0;  ///< m
    std::uint32_t distance_std = 0;    ///< m, 1 σ
};

/// NAV-EELL: horizontal error ellipse (M8 interface description).
struct NavEell {
    static constexpr UbxMessageId message_id{0x01, 0x3D};
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::uint8_t version = 0;  ///< 0
    std::uint8_t reserved = 0;
    std::uint16_t orient = 0;  ///< 0.01 deg of the major axis from true north
    std::uint32_t major = 0;   ///< mm
    std::uint32_t minor = 0;   ///< mm
};

}  // namespace skyloop::inline receiver
