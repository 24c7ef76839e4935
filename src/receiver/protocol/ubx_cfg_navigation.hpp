/// UBX messages of class CFG about navigation: NAVX5, SBAS, ODO, DGNSS, GEOFENCE, TMODE3.
///
/// Fields are declared as field.hpp says. Layouts: u-blox M8 interface description
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
    U2<"version"> version{};  ///< 0 up to protocol 15, 2 from protocol 18
    U2<"mask1"> mask1{};      ///< bits: 2 minMax, 3 minCno, 6 initial3dfix, 9 wknRoll, 10 ackAid, 13 ppp, 14 aop
    U4<"mask2"> mask2{};      ///< bits: 6 adr, 7 sigAttenComp
    std::array<std::uint8_t, 2> reserved0{};
    U1<"min_satellites"> min_svs{};
    U1<"max_satellites"> max_svs{};
    U1<"min_cno_dbhz"> min_cno{};
    std::uint8_t reserved1 = 0;
    U1<"initial_fix_3d"> ini_fix_3d{};
    std::array<std::uint8_t, 2> reserved2{};
    U1<"ack_aiding"> ack_aiding{};
    U2<"week_rollover"> wkn_rollover{};  ///< GPS week
    U1<"attenuation_compensation"> sig_atten_comp_mode{};
    std::array<std::uint8_t, 5> reserved3{};
    U1<"use_ppp"> use_ppp{};
    U1<"aop_config"> aop_cfg{};  ///< bit 0: AssistNow Autonomous
    std::array<std::uint8_t, 2> reserved4{};
    U2<"aop_max_error_m"> aop_orb_max_err{};
    std::array<std::uint8_t, 7> reserved5{};
    U1<"use_adr"> use_adr{};
};

/// CFG-SBAS: satellite-based augmentation.
struct CfgSbas {
    static constexpr UbxMessageId message_id{0x06, 0x16};
    U1<"mode"> mode{};    ///< bits: 0 enabled, 1 test mode
    U1<"usage"> usage{};  ///< bits: 0 range, 1 corrections, 2 integrity
    U1<"channels_max"> max_sbas{};
    U1<"scan_mode2"> scan_mode2{};  ///< bit i: PRN 152 + i
    U4<"scan_mode1"> scan_mode1{};  ///< bit i: PRN 120 + i; all zero: any
};

/// CFG-ODO: odometer and low-speed course.
struct CfgOdo {
    static constexpr UbxMessageId message_id{0x06, 0x1E};
    U1<"version"> version{};  ///< 0
    std::array<std::uint8_t, 3> reserved0{};
    U1<"flags"> flags{};      ///< bits: 0 odometer, 1 course filter, 2 velocity low-pass, 3 course low-pass
    U1<"profile"> odo_cfg{};  ///< bits 0-2: 0 running, 1 cycling, 2 swimming, 3 car, 4 custom
    std::array<std::uint8_t, 6> reserved1{};
    U1<"course_max_speed_mps*1e-1"> cog_max_speed{};
    U1<"course_max_acc_m"> cog_max_pos_acc{};
    std::array<std::uint8_t, 2> reserved2{};
    U1<"velocity_gain"> vel_lp_gain{};
    U1<"course_gain"> cog_lp_gain{};
    std::array<std::uint8_t, 2> reserved3{};
};

/// CFG-DGNSS: how far a rover resolves ambiguities.
struct CfgDgnss {
    static constexpr UbxMessageId message_id{0x06, 0x70};
    U1<"mode"> dgnss_mode{};  ///< 2 float, 3 fixed
    std::array<std::uint8_t, 3> reserved0{};
};

/// CFG-DAT as it is set: a datum of the user's.
struct CfgDatSet {
    static constexpr UbxMessageId message_id{0x06, 0x06};
    R8<"semi_major_m"> maj_a{};       ///< semi-major axis
    R8<"inverse_flattening"> flat{};  ///< 1 / flattening
    R4<"shift_m", 3> shift{};         ///< X, Y, Z
    R4<"rotation", 3> rotation{};     ///< arc seconds
    R4<"scale_ppm"> scale{};
};

/// CFG-DAT as it is told.
struct CfgDat {
    static constexpr UbxMessageId message_id{0x06, 0x06};
    U2<"datum"> datum_num{};     ///< 0 WGS 84, 0xFFFF of the user
    U1<"name", 6> datum_name{};  ///< "WGS84" or "USER"
    R8<"semi_major_m"> maj_a{};
    R8<"inverse_flattening"> flat{};
    R4<"shift_m", 3> shift{};
    R4<"rotation", 3> rotation{};
    R4<"scale_ppm"> scale{};
};

/// One circle of CFG-GEOFENCE.
struct CfgGeofenceItem {
    I4<"lat_deg*1e-7"> lat{};  ///< of the centre
    I4<"lon_deg*1e-7"> lon{};
    U4<"radius_m*1e-2"> radius{};
};

/// CFG-GEOFENCE: circles whose inside and outside NAV-GEOFENCE tells.
struct CfgGeofence {
    static constexpr UbxMessageId message_id{0x06, 0x69};
    U1<"version"> version{};      ///< 0
    U1<"confidence"> conf_lvl{};  ///< how many standard deviations the position must be off the line
    std::uint8_t reserved0 = 0;
    U1<"pin_on"> pio_enabled{};
    U1<"pin_polarity"> pin_polarity{};  ///< 0: low is inside, 1: low is outside
    U1<"pin"> pin{};
    std::uint8_t reserved1 = 0;
    List<"fences", CfgGeofenceItem> fences;

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
    U1<"version"> version{};  ///< 0
    std::uint8_t reserved0 = 0;
    U2<"flags"> flags{};                 ///< bits 0-7: 0 off, 1 survey-in, 2 fixed; bit 8: geodetic
    I4<"position", 3> position{};        ///< ECEF X, Y, Z in cm; or latitude, longitude in 1e-7 deg, height in cm
    I1<"position_hp", 3> position_hp{};  ///< what is beyond: 0.1 mm, 1e-9 deg
    std::uint8_t reserved1 = 0;
    U4<"position_acc_m*1e-4"> fixed_pos_acc{};
    U4<"survey_duration_s"> svin_min_dur{};
    U4<"survey_acc_m*1e-4"> svin_acc_limit{};
    std::array<std::uint8_t, 8> reserved2{};
};

}  // namespace skyloop::inline receiver
