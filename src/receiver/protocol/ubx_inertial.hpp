/// UBX messages of receivers with inertial sensors, as logs of M8L and M8U have them.
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

/// NAV-ATT: attitude (M8 interface description).
struct NavAtt {
    static constexpr UbxMessageId message_id{0x01, 0x05};
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 3> reserved{};
    std::array<std::int32_t, 3> angle{};  ///< 1e-5 deg of roll, pitch, heading
    std::array<std::uint32_t, 3> acc{};   ///< 1e-5 deg
};

/// NAV-PVAT: position, velocity, attitude and time of receivers with dead reckoning (F9 interface description, HPS).
struct NavPvat {
    static constexpr UbxMessageId message_id{0x01, 0x17};
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::uint8_t version = 0;  ///< 0
    std::uint8_t valid = 0;    ///< bits: 0 date, 1 time, 2 fully resolved, 3 magnetic declination
    std::uint16_t year = 0;    ///< UTC
    std::uint8_t month = 0;
    std::uint8_t day = 0;
    std::uint8_t hour = 0;
    std::uint8_t minute = 0;
    std::uint8_t second = 0;
    std::array<std::uint8_t, 3> reserved1{};
    std::uint32_t t_acc = 0;    ///< ns
    std::int32_t nano = 0;      ///< ns, -1e9 to 1e9
    std::uint8_t fix_type = 0;  ///< as NavPvt::fix_type
    std::uint8_t flags = 0;   ///< bits: 0 fix ok, 1 differential, 2-4 roll, pitch, heading valid, 6-7 carrier solution
    std::uint8_t flags2 = 0;  ///< as NavPvt::flags2
    std::uint8_t num_sv = 0;  ///< satellites used
    std::int32_t lon = 0;     ///< 1e-7 deg
    std::int32_t lat = 0;     ///< 1e-7 deg
    std::int32_t height = 0;  ///< mm above the ellipsoid
    std::int32_t h_msl = 0;   ///< mm above mean sea level
    std::uint32_t h_acc = 0;  ///< mm
    std::uint32_t v_acc = 0;  ///< mm
    std::array<std::int32_t, 3> vel_ned{};   ///< mm/s
    std::int32_t g_speed = 0;                ///< mm/s, horizontal
    std::uint32_t s_acc = 0;                 ///< mm/s
    std::array<std::int32_t, 3> angle{};     ///< 1e-5 deg of the vehicle's roll, pitch, heading
    std::int32_t mot_heading = 0;            ///< 1e-5 deg, of the motion
    std::array<std::uint16_t, 3> acc{};      ///< 0.01 deg
    std::int16_t mag_dec = 0;                ///< 0.01 deg
    std::uint16_t mag_acc = 0;               ///< 0.01 deg
    std::uint16_t ellipse_orientation = 0;   ///< 0.01 deg
    std::array<std::uint32_t, 2> ellipse{};  ///< mm, major and minor half axis
    std::array<std::uint8_t, 8> reserved2{};
};

/// One sensor of ESF-STATUS.
struct EsfStatusItem {
    std::uint8_t sens_status1 = 0;  ///< bits: 0-5 type, 6 used, 7 ready
    std::uint8_t sens_status2 = 0;  ///< bits: 0-1 calibration, 2-3 time
    std::uint8_t freq = 0;          ///< Hz
    std::uint8_t faults = 0;
};

/// ESF-STATUS: state of the fusion (M8 interface description).
struct EsfStatus {
    static constexpr UbxMessageId message_id{0x10, 0x10};
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::uint8_t version = 2;  ///< 2
    std::array<std::uint8_t, 7> reserved1{};
    std::uint8_t fusion_mode = 0;  ///< 0 initialising, 1 fusion, 2 suspended, 3 off
    std::array<std::uint8_t, 2> reserved2{};
    std::vector<EsfStatusItem> sensors;

    static void fields(auto& m, auto& v) {
        v(m.i_tow, m.version, m.reserved1, m.fusion_mode, m.reserved2);
        v.count(m.sensors);
        v.items(m.sensors);
    }
};

/// HNR-PVT: position, velocity and time between the epochs (M8 interface description).
struct HnrPvt {
    static constexpr UbxMessageId message_id{0x28, 0x00};
    std::uint32_t i_tow = 0;  ///< ms, GPS time of week of the epoch
    std::uint16_t year = 0;   ///< UTC
    std::uint8_t month = 0;
    std::uint8_t day = 0;
    std::uint8_t hour = 0;
    std::uint8_t minute = 0;
    std::uint8_t second = 0;
    std::uint8_t valid = 0;    ///< bits: 0 date, 1 time, 2 fully resolved
    std::int32_t nano = 0;     ///< ns
    std::uint8_t gps_fix = 0;  ///< as NavPvt::fix_type
    std::uint8_t flags = 0;    ///< bits: 0 fix ok, 1 differential, 2 week set, 3 time of week set, 4 heading valid
    std::array<std::uint8_t, 2> reserved1{};
    std::int32_t lon = 0;        ///< 1e-7 deg
    std::int32_t lat = 0;        ///< 1e-7 deg
    std::int32_t height = 0;     ///< mm above the ellipsoid
    std::int32_t h_msl = 0;      ///< mm above mean sea level
    std::int32_t g_speed = 0;    ///< mm/s
    std::int32_t speed = 0;      ///< mm/s, in three dimensions
    std::int32_t head_mot = 0;   ///< 1e-5 deg
    std::int32_t head_veh = 0;   ///< 1e-5 deg
    std::uint32_t h_acc = 0;     ///< mm
    std::uint32_t v_acc = 0;     ///< mm
    std::uint32_t s_acc = 0;     ///< mm/s
    std::uint32_t head_acc = 0;  ///< 1e-5 deg
    std::array<std::uint8_t, 4> reserved2{};
};

/// HNR-ATT: attitude between the epochs (M8 interface description).
struct HnrAtt {
    static constexpr UbxMessageId message_id{0x28, 0x01};
    std::uint32_t i_tow = 0;   ///< ms, GPS time of week of the epoch
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 3> reserved{};
    std::array<std::int32_t, 3> angle{};  ///< 1e-5 deg of roll, pitch, heading
    std::array<std::uint32_t, 3> acc{};   ///< 1e-5 deg
};

/// HNR-INS: motion between the epochs (M8 interface description).
struct HnrIns {
    static constexpr UbxMessageId message_id{0x28, 0x02};
    std::uint32_t bitfield0 = 0;  ///< bits: 0-7 version, 8-13 validity
    std::array<std::uint8_t, 4> reserved{};
    std::uint32_t i_tow = 0;                 ///< ms, GPS time of week of the epoch
    std::array<std::int32_t, 3> ang_rate{};  ///< 1e-3 deg/s about x, y, z
    std::array<std::int32_t, 3> accel{};     ///< 1e-2 m/s² along x, y, z
};

}  // namespace skyloop::inline receiver
