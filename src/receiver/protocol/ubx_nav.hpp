/// UBX messages of class NAV that carry the solution.
///
/// Fields are declared as field.hpp says. Sections are those of the u-blox M8 interface
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
    I4<"heading_deg*1e-5"> head_veh{};
    I2<"declination_deg*1e-2"> mag_dec{};
    U2<"declination_acc_deg*1e-2"> mag_acc{};
};

/// NAV-PVT: position, velocity and time; 92 bytes, 84 on u-blox 7.
struct NavPvt {
    static constexpr UbxMessageId message_id{0x01, 0x07};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U2<"year"> year{};         ///< UTC
    U1<"month"> month{};       ///< 1 to 12
    U1<"day"> day{};
    U1<"hour"> hour{};
    U1<"minute"> minute{};
    U1<"second"> second{};  ///< 0 to 60
    U1<"valid"> valid{};    ///< bits: 0 date, 1 time, 2 fully resolved, 3 magnetic declination
    U4<"t_acc_ns"> t_acc{};
    I4<"nano_ns"> nano{};       ///< -1e9 to 1e9
    U1<"fix_type"> fix_type{};  ///< 0 none, 1 dead reckoning, 2 2D, 3 3D, 4 combined, 5 time only
    U1<"flags"> flags{};    ///< bits: 0 fix ok, 1 differential, 2-4 power save, 5 heading valid, 6-7 carrier solution
    U1<"flags2"> flags2{};  ///< bits: 5 confirmation available, 6 date confirmed, 7 time confirmed
    U1<"satellites"> num_sv{};  ///< satellites used
    I4<"lon_deg*1e-7"> lon{};
    I4<"lat_deg*1e-7"> lat{};
    I4<"height_m*1e-3"> height{};  ///< above the ellipsoid
    I4<"msl_m*1e-3"> h_msl{};      ///< above mean sea level
    U4<"h_acc_m*1e-3"> h_acc{};
    U4<"v_acc_m*1e-3"> v_acc{};
    I4<"vel_north_mps*1e-3"> vel_n{};
    I4<"vel_east_mps*1e-3"> vel_e{};
    I4<"vel_down_mps*1e-3"> vel_d{};  ///< down positive
    I4<"speed_mps*1e-3"> g_speed{};   ///< horizontal
    I4<"course_deg*1e-5"> head_mot{};
    U4<"speed_acc_mps*1e-3"> s_acc{};
    U4<"course_acc_deg*1e-5"> head_acc{};
    U2<"pdop*1e-2"> p_dop{};
    U2<"flags3"> flags3{};  ///< bits: 0 invalid position, 1-4 age of corrections
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
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    I4<"ecef_m*1e-2", 3> ecef{};
    U4<"p_acc_m*1e-2"> p_acc{};
};

/// NAV-POSLLH: geodetic position.
struct NavPosllh {
    static constexpr UbxMessageId message_id{0x01, 0x02};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    I4<"lon_deg*1e-7"> lon{};
    I4<"lat_deg*1e-7"> lat{};
    I4<"height_m*1e-3"> height{};  ///< above the ellipsoid
    I4<"msl_m*1e-3"> h_msl{};      ///< above mean sea level
    U4<"h_acc_m*1e-3"> h_acc{};
    U4<"v_acc_m*1e-3"> v_acc{};
};

/// NAV-STATUS: state of the navigation.
struct NavStatus {
    static constexpr UbxMessageId message_id{0x01, 0x03};
    U4<"tow_s*1e-3"> i_tow{};         ///< GPS time of week of the epoch
    U1<"fix_type"> gps_fix{};         ///< as NavPvt::fix_type
    U1<"flags"> flags{};              ///< bits: 0 fix ok, 1 differential, 2 week set, 3 time of week set
    U1<"fix_status"> fix_stat{};      ///< bits: 0 corrections, 1 carrier solution valid, 6-7 map matching
    U1<"flags2"> flags2{};            ///< bits: 0-1 power save, 3-4 spoofing, 6-7 carrier solution
    U4<"ttff_s*1e-3"> ttff{};         ///< to the first fix
    U4<"since_start_s*1e-3"> msss{};  ///< since start-up
};

/// NAV-DOP: dilutions of precision, each 0.01.
struct NavDop {
    static constexpr UbxMessageId message_id{0x01, 0x04};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U2<"gdop*1e-2"> g_dop{};
    U2<"pdop*1e-2"> p_dop{};
    U2<"tdop*1e-2"> t_dop{};
    U2<"vdop*1e-2"> v_dop{};
    U2<"hdop*1e-2"> h_dop{};
    U2<"ndop*1e-2"> n_dop{};
    U2<"edop*1e-2"> e_dop{};
};

/// NAV-SOL: solution in the Earth-fixed frame (M8 and older).
struct NavSol {
    static constexpr UbxMessageId message_id{0x01, 0x06};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    I4<"tow_fraction_ns"> f_tow{};
    I2<"week"> week{};         ///< GPS week
    U1<"fix_type"> gps_fix{};  ///< as NavPvt::fix_type
    U1<"flags"> flags{};       ///< as NavStatus::flags
    I4<"ecef_m*1e-2", 3> ecef{};
    U4<"p_acc_m*1e-2"> p_acc{};
    I4<"ecef_v_mps*1e-2", 3> ecef_v{};
    U4<"speed_acc_mps*1e-2"> s_acc{};
    U2<"pdop*1e-2"> p_dop{};
    std::uint8_t reserved1 = 0;
    U1<"satellites"> num_sv{};  ///< satellites used
    std::uint32_t reserved2 = 0;
};

/// NAV-VELNED: velocity in the local frame.
struct NavVelned {
    static constexpr UbxMessageId message_id{0x01, 0x12};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    I4<"vel_north_mps*1e-2"> vel_n{};
    I4<"vel_east_mps*1e-2"> vel_e{};
    I4<"vel_down_mps*1e-2"> vel_d{};  ///< down positive
    U4<"speed_3d_mps*1e-2"> speed{};  ///< in three dimensions
    U4<"speed_mps*1e-2"> g_speed{};   ///< horizontal
    I4<"course_deg*1e-5"> heading{};
    U4<"speed_acc_mps*1e-2"> s_acc{};
    U4<"course_acc_deg*1e-5"> c_acc{};
};

/// NAV-HPPOSLLH: geodetic position with more digits.
struct NavHpposllh {
    static constexpr UbxMessageId message_id{0x01, 0x14};
    U1<"version"> version{};  ///< 0
    std::array<std::uint8_t, 2> reserved{};
    U1<"flags"> flags{};       ///< bit 0: invalid
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    I4<"lon_deg*1e-7"> lon{};
    I4<"lat_deg*1e-7"> lat{};
    I4<"height_m*1e-3"> height{};        ///< above the ellipsoid
    I4<"msl_m*1e-3"> h_msl{};            ///< above mean sea level
    I1<"lon_hp_deg*1e-9"> lon_hp{};      ///< to add
    I1<"lat_hp_deg*1e-9"> lat_hp{};      ///< to add
    I1<"height_hp_m*1e-4"> height_hp{};  ///< to add
    I1<"msl_hp_m*1e-4"> h_msl_hp{};      ///< to add
    U4<"h_acc_m*1e-4"> h_acc{};
    U4<"v_acc_m*1e-4"> v_acc{};
};

/// NAV-COV: covariances in north, east, down, in the order NN, NE, ND, EE, ED, DD.
struct NavCov {
    static constexpr UbxMessageId message_id{0x01, 0x36};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U1<"version"> version{};   ///< 0
    U1<"position_valid"> pos_cov_valid{};
    U1<"velocity_valid"> vel_cov_valid{};
    std::array<std::uint8_t, 9> reserved{};
    R4<"position_m2", 6> pos_cov{};
    R4<"velocity_m2ps2", 6> vel_cov{};
};

/// NAV-EOE: the last NAV message of an epoch.
struct NavEoe {
    static constexpr UbxMessageId message_id{0x01, 0x61};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
};

/// NAV-VELECEF: velocity in the Earth-fixed frame (RECEIVER.md 3.1).
struct NavVelecef {
    static constexpr UbxMessageId message_id{0x01, 0x11};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    I4<"ecef_v_mps*1e-2", 3> ecef_v{};
    U4<"speed_acc_mps*1e-2"> s_acc{};
};

/// NAV-HPPOSECEF: position in the Earth-fixed frame with more digits (RECEIVER.md 3.1).
struct NavHpposecef {
    static constexpr UbxMessageId message_id{0x01, 0x13};
    U1<"version"> version{};  ///< 0
    std::array<std::uint8_t, 3> reserved{};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    I4<"ecef_m*1e-2", 3> ecef{};
    I1<"ecef_hp_m*1e-4", 3> ecef_hp{};  ///< to add
    U1<"flags"> flags{};                ///< bit 0: invalid
    U4<"p_acc_m*1e-4"> p_acc{};
};

/// NAV-ODO: odometer (RECEIVER.md 3.1).
struct NavOdo {
    static constexpr UbxMessageId message_id{0x01, 0x09};
    U1<"version"> version{};  ///< 0
    std::array<std::uint8_t, 3> reserved{};
    U4<"tow_s*1e-3"> i_tow{};     ///< GPS time of week of the epoch
    U4<"distance_m"> distance{};  ///< since NAV-RESETODO
    U4<"total_distance_m"> total_distance{};
    U4<"distance_deviation_m"> distance_std{};  ///< 1 σ
};

/// NAV-EELL: horizontal error ellipse (M8 interface description).
struct NavEell {
    static constexpr UbxMessageId message_id{0x01, 0x3D};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U1<"version"> version{};   ///< 0
    std::uint8_t reserved = 0;
    U2<"orientation_deg*1e-2"> orient{};  ///< of the major axis from true north
    U4<"major_m*1e-3"> major{};
    U4<"minor_m*1e-3"> minor{};
};

}  // namespace skyloop::inline receiver
