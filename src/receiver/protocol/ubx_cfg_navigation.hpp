/// UBX messages of class CFG about navigation: NAVX5, SBAS, ODO, DGNSS, GEOFENCE, TMODE3.
///
/// Numbers are as on the wire; a member's comment gives unit and scale. Layouts: u-blox M8 interface description
/// (UBX-13003221), section 32.11; those of high-precision receivers: F9 interface description (HPG 1.32).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "receiver/protocol/ubx_fields.hpp"

namespace skyloop::inline receiver {

/// CFG-NAVX5: expert settings of the navigation; only the groups in the masks count.
struct CfgNavx5 {
    static constexpr UbxMessageId message_id{0x06, 0x23};
    std::uint16_t version = 0;  ///< 0 up to protocol 15, 2 from protocol 18
    std::uint16_t mask1 = 0;    ///< bits: 2 minMax, 3 minCno, 6 initial3dfix, 9 wknRoll, 10 ackAid, 13 ppp, 14 aop
    std::uint32_t mask2 = 0;    ///< bits: 6 adr, 7 sigAttenComp
    std::array<std::uint8_t, 2> reserved0{};
    std::uint8_t min_svs = 0;
    std::uint8_t max_svs = 0;
    std::uint8_t min_cno = 0;  ///< dBHz
    std::uint8_t reserved1 = 0;
    std::uint8_t ini_fix_3d = 0;
    std::array<std::uint8_t, 2> reserved2{};
    std::uint8_t ack_aiding = 0;
    std::uint16_t wkn_rollover = 0;  ///< GPS week
    std::uint8_t sig_atten_comp_mode = 0;
    std::array<std::uint8_t, 5> reserved3{};
    std::uint8_t use_ppp = 0;
    std::uint8_t aop_cfg = 0;  ///< bit 0: AssistNow Autonomous
    std::array<std::uint8_t, 2> reserved4{};
    std::uint16_t aop_orb_max_err = 0;  ///< m
    std::array<std::uint8_t, 7> reserved5{};
    std::uint8_t use_adr = 0;
};

/// CFG-SBAS: satellite-based augmentation.
struct CfgSbas {
    static constexpr UbxMessageId message_id{0x06, 0x16};
    std::uint8_t mode = 0;   ///< bits: 0 enabled, 1 test mode
    std::uint8_t usage = 0;  ///< bits: 0 range, 1 corrections, 2 integrity
    std::uint8_t max_sbas = 0;
    std::uint8_t scan_mode2 = 0;   ///< bit i: PRN 152 + i
    std::uint32_t scan_mode1 = 0;  ///< bit i: PRN 120 + i; all zero: any
};

/// CFG-ODO: odometer and low-speed course.
struct CfgOdo {
    static constexpr UbxMessageId message_id{0x06, 0x1E};
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 3> reserved0{};
    std::uint8_t flags = 0;    ///< bits: 0 odometer, 1 course filter, 2 velocity low-pass, 3 course low-pass
    std::uint8_t odo_cfg = 0;  ///< bits 0-2: 0 running, 1 cycling, 2 swimming, 3 car, 4 custom
    std::array<std::uint8_t, 6> reserved1{};
    std::uint8_t cog_max_speed = 0;    ///< 0.1 m/s
    std::uint8_t cog_max_pos_acc = 0;  ///< m
    std::array<std::uint8_t, 2> reserved2{};
    std::uint8_t vel_lp_gain = 0;
    std::uint8_t cog_lp_gain = 0;
    std::array<std::uint8_t, 2> reserved3{};
};

/// CFG-DGNSS: how far a rover resolves ambiguities.
struct CfgDgnss {
    static constexpr UbxMessageId message_id{0x06, 0x70};
    std::uint8_t dgnss_mode = 0;  ///< 2 float, 3 fixed
    std::array<std::uint8_t, 3> reserved0{};
};

/// CFG-DAT as it is set: a datum of the user's.
struct CfgDatSet {
    static constexpr UbxMessageId message_id{0x06, 0x06};
    double maj_a = 0;                 ///< m, semi-major axis
    double flat = 0;                  ///< 1 / flattening
    std::array<float, 3> shift{};     ///< m, X, Y, Z
    std::array<float, 3> rotation{};  ///< arc seconds
    float scale = 0;                  ///< ppm
};

/// CFG-DAT as it is told.
struct CfgDat {
    static constexpr UbxMessageId message_id{0x06, 0x06};
    std::uint16_t datum_num = 0;               ///< 0 WGS 84, 0xFFFF of the user
    std::array<std::uint8_t, 6> datum_name{};  ///< "WGS84" or "USER"
    double maj_a = 0;
    double flat = 0;
    std::array<float, 3> shift{};
    std::array<float, 3> rotation{};
    float scale = 0;
};

/// One circle of CFG-GEOFENCE.
struct CfgGeofenceItem {
    std::int32_t lat = 0;      ///< 1e-7 deg, of the centre
    std::int32_t lon = 0;      ///< 1e-7 deg
    std::uint32_t radius = 0;  ///< cm
};

/// CFG-GEOFENCE: circles whose inside and outside NAV-GEOFENCE tells.
struct CfgGeofence {
    static constexpr UbxMessageId message_id{0x06, 0x69};
    std::uint8_t version = 0;   ///< 0
    std::uint8_t conf_lvl = 0;  ///< how many standard deviations the position must be off the line
    std::uint8_t reserved0 = 0;
    std::uint8_t pio_enabled = 0;
    std::uint8_t pin_polarity = 0;  ///< 0: low is inside, 1: low is outside
    std::uint8_t pin = 0;
    std::uint8_t reserved1 = 0;
    std::vector<CfgGeofenceItem> fences;

    static void fields(auto& m, auto& v) {
        v(m.version);
        v.count(m.fences);
        v(m.conf_lvl, m.reserved0, m.pio_enabled, m.pin_polarity, m.pin, m.reserved1);
        v.items(m.fences);
    }
};

/// CFG-TMODE3: fixed reference stations.
struct CfgTmode3 {
    static constexpr UbxMessageId message_id{0x06, 0x71};
    std::uint8_t version = 0;  ///< 0
    std::uint8_t reserved0 = 0;
    std::uint16_t flags = 0;                   ///< bits 0-7: 0 off, 1 survey-in, 2 fixed; bit 8: geodetic
    std::array<std::int32_t, 3> position{};    ///< ECEF X, Y, Z in cm; or latitude, longitude in 1e-7 deg, height in cm
    std::array<std::int8_t, 3> position_hp{};  ///< what is beyond: 0.1 mm, 1e-9 deg
    std::uint8_t reserved1 = 0;
    std::uint32_t fixed_pos_acc = 0;   ///< 0.1 mm
    std::uint32_t svin_min_dur = 0;    ///< s
    std::uint32_t svin_acc_limit = 0;  ///< 0.1 mm
    std::array<std::uint8_t, 8> reserved2{};
};

}  // namespace skyloop::inline receiver
