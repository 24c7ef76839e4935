/// CASIC's binary messages, declared as field.hpp says; a message's bytes are encode_payload() and decode_payload() of
/// field_list.hpp.
///
/// Sections are those of the CASIC Multimode Satellite Navigation Receiver Protocol Specification V4.2.0.3
/// (icofchina.com). Where its tables and captured frames differ (NAV-TIMEUTC), the frames hold: ntpsec/gpsd,
/// drivers/driver_casic.c, and jclark/satpulse (gps/casic/casbin).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "receiver/protocol/casic_frame.hpp"
#include "receiver/protocol/field_list.hpp"

namespace skyloop::inline receiver {

/// posValid and velValid (2.7.1): 0 none, 4 dead reckoning, 6 2D, 7 3D.
inline constexpr std::uint8_t casic_invalid = 0, casic_reckoned = 4, casic_2d = 6, casic_3d = 7;
/// The class by which CFG-MSG names sentences: GGA 0, GLL 1, GSA 2, GSV 3, RMC 4, VTG 5, GST 7, ZDA 8.
inline constexpr std::uint8_t casic_class_nmea = 0x4E;
/// cAcc of a heading that is not known.
inline constexpr float casic_unknown_heading_variance = 1e6F;

/// NAV-DOP (2.7.2).
struct CasicNavDop {
    static constexpr CasicMessageId message_id{0x01, 0x01};
    static constexpr std::string_view message_name = "NAV-DOP";
    U4<"run_time_s*1e-3"> run_time{};  ///< since the start
    R4<"pdop"> p_dop{};
    R4<"hdop"> h_dop{};
    R4<"vdop"> v_dop{};
    R4<"ndop"> n_dop{};
    R4<"edop"> e_dop{};
    R4<"tdop"> t_dop{};
};

/// NAV-SOL (2.7.3): the solution in the Earth-fixed frame.
struct CasicNavSol {
    static constexpr CasicMessageId message_id{0x01, 0x02};
    static constexpr std::string_view message_name = "NAV-SOL";
    U4<"run_time_s*1e-3"> run_time{};
    U1<"pos_valid"> pos_valid{};  ///< as casic_3d
    U1<"vel_valid"> vel_valid{};
    U1<"time_source"> time_source{};  ///< 0 GPS, 1 BeiDou, 2 GLONASS
    U1<"systems"> systems{};          ///< in use; bits: 0 GPS, 1 BeiDou, 2 GLONASS
    U1<"satellites"> num_sv{};        ///< used
    U1<"gps_satellites"> num_gps{};
    U1<"beidou_satellites"> num_bds{};
    U1<"glonass_satellites"> num_glo{};
    std::uint16_t reserved = 0;
    U2<"week"> week{};
    R8<"tow_s"> tow{};
    R8<"ecef_m", 3> ecef{};
    R4<"p_variance_m2"> p_variance{};
    R4<"ecef_vel_mps", 3> velocity{};
    R4<"speed_variance_m2ps2"> s_variance{};
    R4<"pdop"> p_dop{};
};

/// NAV-PV (2.7.4): position and velocity.
struct CasicNavPv {
    static constexpr CasicMessageId message_id{0x01, 0x03};
    static constexpr std::string_view message_name = "NAV-PV";
    U4<"run_time_s*1e-3"> run_time{};
    U1<"pos_valid"> pos_valid{};
    U1<"vel_valid"> vel_valid{};
    U1<"systems"> systems{};  ///< as CasicNavSol::systems
    U1<"satellites"> num_sv{};
    U1<"gps_satellites"> num_gps{};
    U1<"beidou_satellites"> num_bds{};
    U1<"glonass_satellites"> num_glo{};
    std::uint8_t reserved = 0;
    R4<"pdop"> p_dop{};
    R8<"lon_deg"> lon{};
    R8<"lat_deg"> lat{};
    R4<"height_m"> height{};      ///< above the ellipsoid
    R4<"undulation_m"> geoid{};   ///< of the geoid above the ellipsoid
    R4<"h_variance_m2"> h_var{};  ///< variances, not deviations
    R4<"v_variance_m2"> v_var{};
    R4<"vel_north_mps"> vel_n{};
    R4<"vel_east_mps"> vel_e{};
    R4<"vel_up_mps"> vel_u{};
    R4<"speed_3d_mps"> speed_3d{};
    R4<"speed_mps"> speed{};  ///< horizontal
    R4<"course_deg"> course{};
    R4<"speed_variance_m2ps2"> s_var{};
    R4<"course_variance_deg2!1e6"> c_var{};
};

/// NAV-TIMEUTC (2.7.5, with the milliseconds that frames have before the year).
struct CasicNavTimeutc {
    static constexpr CasicMessageId message_id{0x01, 0x10};
    static constexpr std::string_view message_name = "NAV-TIMEUTC";
    U4<"run_time_s*1e-3"> run_time{};
    R4<"t_variance_m2"> t_variance{};  ///< of the time by the speed of light
    R4<"rest_ms"> rest{};              ///< beside the whole milliseconds
    U2<"millisecond"> millisecond{};
    U2<"year"> year{};
    U1<"month"> month{};
    U1<"day"> day{};
    U1<"hour"> hour{};
    U1<"minute"> minute{};
    U1<"second"> second{};
    U1<"valid"> valid{};              ///< bits: 0 time of week, 1 week, 2 leap seconds
    U1<"time_source"> time_source{};  ///< 0 GPS, 1 BeiDou, 2 GLONASS
    U1<"date_valid"> date_valid{};    ///< 0 none, 1 from outside, 2 of one satellite, 3 of several
};

/// A satellite of NAV-GPSINFO and its like.
struct CasicSatellite {
    U1<"channel!255"> channel{};
    U1<"sv"> sv{};
    U1<"flags"> flags{};      ///< bits: 0 used, 6 and 7: 1 by almanac, 3 by ephemeris
    U1<"quality"> quality{};  ///< bits: 0 range, 1 phase, 2 and 3 half cycles, 5 frequency
    U1<"cno_dbhz"> cno{};
    I1<"elevation_deg"> elevation{};
    I2<"azimuth_deg"> azimuth{};
    R4<"residual_m"> residual{};
};

/// NAV-GPSINFO, NAV-BDSINFO and NAV-GLNINFO (2.7.7 to 2.7.9): the satellites of one system.
template <std::uint8_t Id>
struct CasicSatellites {
    static constexpr CasicMessageId message_id{0x01, Id};
    static constexpr std::string_view message_name = Id == 0x20   ? "NAV-GPSINFO"
                                                     : Id == 0x21 ? "NAV-BDSINFO"
                                                                  : "NAV-GLNINFO";
    U4<"run_time_s*1e-3"> run_time{};
    U1<"used"> used{};
    U1<"system"> system{};  ///< 0 GPS, 1 BeiDou, 2 GLONASS
    std::uint8_t reserved = 0;
    List<"satellites", CasicSatellite> satellites{};

    static void fields(auto& m, auto& v) {
        v(m.run_time);
        v.count(m.satellites);
        v(m.used, m.system, m.reserved);
        v.items(m.satellites);
    }
};
using CasicGpsSatellites = CasicSatellites<0x20>;
using CasicBeidouSatellites = CasicSatellites<0x21>;
using CasicGlonassSatellites = CasicSatellites<0x22>;

/// ACK-NACK and ACK-ACK (2.10): of which message.
template <std::uint8_t Id>
struct CasicVerdict {
    static constexpr CasicMessageId message_id{0x05, Id};
    static constexpr std::string_view message_name = Id == 0 ? "ACK-NACK" : "ACK-ACK";
    U1<"class"> message_class{};
    U1<"id"> id{};
    std::uint16_t reserved = 0;
};
using CasicAckNack = CasicVerdict<0x00>;
using CasicAckAck = CasicVerdict<0x01>;

/// CFG-PRT (2.11.1): a UART. A poll is answered once for each port.
struct CasicCfgPrt {
    static constexpr CasicMessageId message_id{0x06, 0x00};
    static constexpr std::string_view message_name = "CFG-PRT";
    U1<"port"> port{};            ///< from 0 on; 255: the one that it comes by
    U1<"protocols"> protocols{};  ///< bits: 0 binary in, 1 text in, 4 binary out, 5 text out
    U2<"mode"> mode{};            ///< 0x08C0: 8N1
    U4<"baud"> baud{};
};

/// CFG-MSG (2.11.2): how often a message is sent.
struct CasicCfgMsg {
    static constexpr CasicMessageId message_id{0x06, 0x01};
    static constexpr std::string_view message_name = "CFG-MSG";
    U1<"class"> message_class{};
    U1<"id"> id{};
    U2<"rate"> rate{};  ///< every how many fixes; 0 never, 65535 once, at once
};

/// CFG-RST (2.11.3): a restart.
struct CasicCfgRst {
    static constexpr CasicMessageId message_id{0x06, 0x02};
    static constexpr std::string_view message_name = "CFG-RST";
    U2<"forget"> forget{};  ///< bits: 0 ephemerides, 1 almanac, 3 ionosphere, 4 position, 7 UTC, 8 clock, 9 settings
    U1<"mode"> mode{};      ///< 0 hardware, 1 software, 2 GPS alone, 4 hardware after a shutdown
    U1<"start"> start{};    ///< 0 hot, 1 warm, 2 cold, 3 factory
};

/// CFG-RATE (2.11.5): the time between two fixes.
struct CasicCfgRate {
    static constexpr CasicMessageId message_id{0x06, 0x04};
    static constexpr std::string_view message_name = "CFG-RATE";
    U2<"interval_s*1e-3"> interval{};
    std::uint16_t reserved = 0;
};

/// CFG-CFG (2.11.6): stored settings.
struct CasicCfgCfg {
    static constexpr CasicMessageId message_id{0x06, 0x05};
    static constexpr std::string_view message_name = "CFG-CFG";
    U2<"sections"> sections{};  ///< bits: 0 ports, 1 messages, 3 rate, 4 pulse
    U1<"mode"> mode{};          ///< 0 clear, 1 save, 2 load
    std::uint8_t reserved = 0;
};

/// CFG-NAVX (2.11.8): the navigation engine. What `apply` does not name stays.
struct CasicCfgNavx {
    static constexpr CasicMessageId message_id{0x06, 0x07};
    static constexpr std::string_view message_name = "CFG-NAVX";
    U4<"apply"> apply{};  ///< bits: 0 motion, 1 fix mode, 2 satellites, 3 C/N0, 6 elevation, 8 systems, 13 static hold
    U1<"dynamic_model"> dynamic_model{};  ///< 0 portable, 1 stationary … 3 automotive, 5 to 7 airborne
    U1<"fix_mode"> fix_mode{};            ///< 1 2D, 2 3D, 3 automatic
    U1<"least_satellites"> least_satellites{};
    U1<"most_satellites"> most_satellites{};
    U1<"least_cno_dbhz"> least_cno{};
    std::uint8_t reserved = 0;
    U1<"first_fix_3d"> first_fix_3d{};
    I1<"least_elevation_deg"> least_elevation{};
    U1<"dr_limit_s"> dr_limit{};
    U1<"systems"> systems{};  ///< bits: 0 GPS, 1 BeiDou, 2 GLONASS
    U2<"first_week"> first_week{};
    R4<"fixed_height_m"> fixed_height{};
    R4<"fixed_height_variance_m2"> fixed_height_variance{};
    R4<"most_pdop"> most_pdop{};
    R4<"most_tdop"> most_tdop{};
    R4<"most_p_variance_m2"> most_p_variance{};
    R4<"most_t_variance_m2"> most_t_variance{};
    R4<"static_hold_mps"> static_hold{};
};

/// MON-VER (2.13.1). Firmware of version 5 does not answer it (jclark/satpulse, gpshwtest/HW).
struct CasicMonVer {
    static constexpr CasicMessageId message_id{0x0A, 0x04};
    static constexpr std::string_view message_name = "MON-VER";
    Text<"software", 32> software{};
    Text<"hardware", 32> hardware{};
};

/// All that are known.
using KnownCasicMessages =
    MessageTypes<CasicNavDop, CasicNavSol, CasicNavPv, CasicNavTimeutc, CasicGpsSatellites, CasicBeidouSatellites,
                 CasicGlonassSatellites, CasicAckNack, CasicAckAck, CasicCfgPrt, CasicCfgMsg, CasicCfgRst, CasicCfgRate,
                 CasicCfgCfg, CasicCfgNavx, CasicMonVer>;

/// "NAV-PV"; empty for a message that is not known.
inline std::string_view casic_message_name(CasicMessageId id) {
    std::string_view name;
    KnownCasicMessages::any([&]<class Message>() {
        if (Message::message_id == id) name = Message::message_name;
        return !name.empty();
    });
    return name;
}

/// The whole frame of a message.
template <class Message>
Bytes encode_casic(const Message& message) {
    return encode_casic_frame(Message::message_id, encode_payload(message));
}

}  // namespace skyloop::inline receiver
