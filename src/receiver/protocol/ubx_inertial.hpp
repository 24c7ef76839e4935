/// UBX messages of receivers with inertial sensors, as logs of M8L and M8U have them.
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

/// NAV-ATT: attitude (M8 interface description).
struct NavAtt {
    static constexpr UbxMessageId message_id{0x01, 0x05};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U1<"version"> version{};   ///< 0
    std::array<std::uint8_t, 3> reserved{};
    I4<"roll_pitch_heading_deg*1e-5", 3> angle{};  ///< of roll, pitch, heading
    U4<"roll_pitch_heading_acc_deg*1e-5", 3> acc{};
};

/// NAV-PVAT: position, velocity, attitude and time of receivers with dead reckoning (F9 interface description, HPS).
struct NavPvat {
    static constexpr UbxMessageId message_id{0x01, 0x17};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U1<"version"> version{};   ///< 0
    U1<"valid"> valid{};       ///< bits: 0 date, 1 time, 2 fully resolved, 3 magnetic declination
    U2<"year"> year{};         ///< UTC
    U1<"month"> month{};
    U1<"day"> day{};
    U1<"hour"> hour{};
    U1<"minute"> minute{};
    U1<"second"> second{};
    std::array<std::uint8_t, 3> reserved1{};
    U4<"t_acc_ns"> t_acc{};
    I4<"nano_ns"> nano{};       ///< -1e9 to 1e9
    U1<"fix_type"> fix_type{};  ///< as NavPvt::fix_type
    U1<"flags"> flags{};    ///< bits: 0 fix ok, 1 differential, 2-4 roll, pitch, heading valid, 6-7 carrier solution
    U1<"flags2"> flags2{};  ///< as NavPvt::flags2
    U1<"satellites"> num_sv{};  ///< satellites used
    I4<"lon_deg*1e-7"> lon{};
    I4<"lat_deg*1e-7"> lat{};
    I4<"height_m*1e-3"> height{};  ///< above the ellipsoid
    I4<"msl_m*1e-3"> h_msl{};      ///< above mean sea level
    U4<"h_acc_m*1e-3"> h_acc{};
    U4<"v_acc_m*1e-3"> v_acc{};
    I4<"vel_ned_mps*1e-3", 3> vel_ned{};
    I4<"speed_mps*1e-3"> g_speed{};  ///< horizontal
    U4<"speed_acc_mps*1e-3"> s_acc{};
    I4<"roll_pitch_heading_deg*1e-5", 3> angle{};  ///< of the vehicle's roll, pitch, heading
    I4<"course_deg*1e-5"> mot_heading{};           ///< of the motion
    U2<"roll_pitch_heading_acc_deg*1e-2", 3> acc{};
    I2<"declination_deg*1e-2"> mag_dec{};
    U2<"declination_acc_deg*1e-2"> mag_acc{};
    U2<"orientation_deg*1e-2"> ellipse_orientation{};
    U4<"major_minor_m*1e-3", 2> ellipse{};  ///< major and minor half axis
    std::array<std::uint8_t, 8> reserved2{};
};

/// One sensor of ESF-STATUS.
struct EsfStatusItem {
    U1<"status1"> sens_status1{};  ///< bits: 0-5 type, 6 used, 7 ready
    U1<"status2"> sens_status2{};  ///< bits: 0-1 calibration, 2-3 time
    U1<"rate_hz"> freq{};
    U1<"faults"> faults{};
};

/// ESF-STATUS: state of the fusion (M8 interface description).
struct EsfStatus {
    static constexpr UbxMessageId message_id{0x10, 0x10};
    U4<"tow_s*1e-3"> i_tow{};   ///< GPS time of week of the epoch
    U1<"version"> version = 2;  ///< 2
    std::array<std::uint8_t, 7> reserved1{};
    U1<"fusion_mode"> fusion_mode{};  ///< 0 initialising, 1 fusion, 2 suspended, 3 off
    std::array<std::uint8_t, 2> reserved2{};
    List<"sensors", EsfStatusItem> sensors;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.version, m.reserved1, m.fusion_mode, m.reserved2);
        v.count(m.sensors);
        v.items(m.sensors);
    }
};

/// HNR-PVT: position, velocity and time between the epochs (M8 interface description).
struct HnrPvt {
    static constexpr UbxMessageId message_id{0x28, 0x00};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U2<"year"> year{};         ///< UTC
    U1<"month"> month{};
    U1<"day"> day{};
    U1<"hour"> hour{};
    U1<"minute"> minute{};
    U1<"second"> second{};
    U1<"valid"> valid{};  ///< bits: 0 date, 1 time, 2 fully resolved
    I4<"nano_ns"> nano{};
    U1<"fix_type"> gps_fix{};  ///< as NavPvt::fix_type
    U1<"flags"> flags{};       ///< bits: 0 fix ok, 1 differential, 2 week set, 3 time of week set, 4 heading valid
    std::array<std::uint8_t, 2> reserved1{};
    I4<"lon_deg*1e-7"> lon{};
    I4<"lat_deg*1e-7"> lat{};
    I4<"height_m*1e-3"> height{};  ///< above the ellipsoid
    I4<"msl_m*1e-3"> h_msl{};      ///< above mean sea level
    I4<"speed_mps*1e-3"> g_speed{};
    I4<"speed_3d_mps*1e-3"> speed{};  ///< in three dimensions
    I4<"course_deg*1e-5"> head_mot{};
    I4<"heading_deg*1e-5"> head_veh{};
    U4<"h_acc_m*1e-3"> h_acc{};
    U4<"v_acc_m*1e-3"> v_acc{};
    U4<"speed_acc_mps*1e-3"> s_acc{};
    U4<"course_acc_deg*1e-5"> head_acc{};
    std::array<std::uint8_t, 4> reserved2{};
};

/// HNR-ATT: attitude between the epochs (M8 interface description).
struct HnrAtt {
    static constexpr UbxMessageId message_id{0x28, 0x01};
    U4<"tow_s*1e-3"> i_tow{};  ///< GPS time of week of the epoch
    U1<"version"> version{};   ///< 0
    std::array<std::uint8_t, 3> reserved{};
    I4<"roll_pitch_heading_deg*1e-5", 3> angle{};  ///< of roll, pitch, heading
    U4<"roll_pitch_heading_acc_deg*1e-5", 3> acc{};
};

/// HNR-INS: motion between the epochs (M8 interface description).
struct HnrIns {
    static constexpr UbxMessageId message_id{0x28, 0x02};
    U4<"validity"> bitfield0{};  ///< bits: 0-7 version, 8-13 validity
    std::array<std::uint8_t, 4> reserved{};
    U4<"tow_s*1e-3"> i_tow{};                     ///< GPS time of week of the epoch
    I4<"angular_rate_degps*1e-3", 3> ang_rate{};  ///< about x, y, z
    I4<"acceleration_mps2*1e-2", 3> accel{};      ///< along x, y, z
};

}  // namespace skyloop::inline receiver
