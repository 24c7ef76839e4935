/// UBX messages of class CFG about the receiver's hardware: TP5, ITFM, PMS, RXM, ANT, LOGFILTER; and UPD-SOS.
///
/// Fields are declared as field.hpp says. Layouts: u-blox M8 interface description
/// (UBX-13003221), sections 32.11 and 32.20.
///
/// UBX messages of class CFG about what leaves the ports: INF, NMEA, USB.
///
/// Layouts: u-blox M8 interface description (UBX-13003221), section 32.11.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "receiver/protocol/ubx_fields.hpp"

namespace skyloop::inline receiver {

/// CFG-TP5: a time pulse.
struct CfgTp5 {
    static constexpr UbxMessageId message_id{0x06, 0x31};
    U1<"pulse"> tp_idx{};
    U1<"version"> version{};  ///< 1; 0 in the first firmware of M8
    std::array<std::uint8_t, 2> reserved0{};
    I2<"cable_delay_ns"> ant_cable_delay{};
    I2<"rf_group_delay_ns"> rf_group_delay{};
    U4<"period"> freq_period{};                  ///< Hz or µs, while time is not known
    U4<"period_locked"> freq_period_lock{};      ///< Hz or µs, once it is
    U4<"length"> pulse_len_ratio{};              ///< µs or 2^-32
    U4<"length_locked"> pulse_len_ratio_lock{};  ///< µs or 2^-32
    I4<"user_delay_ns"> user_config_delay{};
    U4<"flags"> flags{};  ///< bits: 0 active, 1 lock, 2 other set when locked, 3 isFreq, 4 isLength, 5 align, 6
                          ///< rising, 7-10 time grid, 11-13 sync mode
};

/// CFG-ITFM: the monitor of jamming.
struct CfgItfm {
    static constexpr UbxMessageId message_id{0x06, 0x39};
    U4<"config"> config{};    ///< bits: 0-3 broadband threshold dB, 4-8 tone threshold dB, 9-30 fixed, 31 enabled
    U4<"config2"> config2{};  ///< bits: 0-11 fixed, 12-13 antenna (0 unknown, 1 passive, 2 active), 14 auxiliary bands
};

/// CFG-PMS: power modes for simple needs.
struct CfgPms {
    static constexpr UbxMessageId message_id{0x06, 0x86};
    U1<"version"> version{};  ///< 0
    U1<"power_setup">
        power_setup_value{};    ///< 0 full, 1 balanced, 2 interval, 3 … 5 aggressive at 1, 2, 4 Hz, 255 none
    U2<"period_s"> period{};    ///< of interval
    U2<"on_time_s"> on_time{};  ///< of interval
    std::array<std::uint8_t, 2> reserved0{};
};

/// CFG-RXM: power save on and off.
struct CfgRxm {
    static constexpr UbxMessageId message_id{0x06, 0x11};
    std::uint8_t reserved0 = 8;
    U1<"power_mode"> lp_mode{};  ///< 0 and 4 continuous, 1 power save
};

/// CFG-ANT: the supply of the antenna.
struct CfgAnt {
    static constexpr UbxMessageId message_id{0x06, 0x13};
    U2<"flags"> flags{};  ///< bits: 0 supply, 1 short detection, 2 open detection, 3 off when short, 4 recovers
    U2<"pins"> pins{};    ///< bits: 0-4 switch, 5-9 short, 10-14 open, 15 take the pins
};

/// CFG-LOGFILTER: which positions are logged.
struct CfgLogfilter {
    static constexpr UbxMessageId message_id{0x06, 0x47};
    U1<"version"> version = 1;  ///< 1
    U1<"flags"> flags{};        ///< bits: 0 logging, 1 once per wake-up, 2 all filters must hold
    U2<"interval_s"> min_interval{};
    U2<"time_threshold_s"> time_threshold{};
    U2<"speed_threshold_mps"> speed_threshold{};
    U4<"position_threshold_m"> position_threshold{};
};

/// CFG-PM2: how power is saved (protocol versions 18 to 22).
struct CfgPm2 {
    static constexpr UbxMessageId message_id{0x06, 0x3B};
    U1<"version"> version = 2;  ///< 2
    std::uint8_t reserved0 = 0;
    U1<"startup_s"> max_startup_state_dur{};
    std::uint8_t reserved1 = 0;
    /// Bits: 4 EXTINT1, 5 wake, 6 backup, 7 inactivity, 8 peak current, 10 time fix, 12 ephemerides, 16 never off, 17
    /// cyclic
    U4<"flags"> flags{};
    U4<"update_s*1e-3"> update_period{};
    U4<"search_s*1e-3"> search_period{};
    U4<"grid_offset_s*1e-3"> grid_offset{};
    U2<"on_time_s"> on_time{};
    U2<"acquisition_s"> min_acq_time{};
    std::array<std::uint8_t, 20> reserved2{};
    U4<"inactivity_s*1e-3"> extint_inactivity{};
};

/// CFG-PWR: the state that the receiver is to be in (F9 interface description, HPG 1.10).
struct CfgPwr {
    static constexpr UbxMessageId message_id{0x06, 0x57};
    U1<"version"> version = 1;  ///< 1
    std::array<std::uint8_t, 3> reserved0{};
    U4<"state"> state{};  ///< of PowerStateWord
};

/// The states of CFG-PWR: four letters each.
enum PowerStateWord : std::uint32_t { power_run = 0x52554E20, power_stop = 0x53544F50, power_backup = 0x42434B50 };

/// UPD-SOS, a command: battery-backed memory to flash.
struct UpdSos {
    static constexpr UbxMessageId message_id{0x09, 0x14};
    U1<"command"> cmd{};  ///< 0 create a backup, 1 clear it
    std::array<std::uint8_t, 3> reserved0{};
};

/// UPD-SOS, an answer.
struct UpdSosStatus {
    static constexpr UbxMessageId message_id{0x09, 0x14};
    U1<"command"> cmd{};  ///< 2 a backup was created or not, 3 what was restored at the start
    std::array<std::uint8_t, 3> reserved0{};
    U1<"response"> response{};  ///< of cmd 2: 0 no, 1 yes; of cmd 3: 0 unknown, 1 failed, 2 restored, 3 no backup
    std::array<std::uint8_t, 3> reserved1{};
};

/// One protocol of CFG-INF.
struct CfgInfItem {
    U1<"protocol"> protocol_id{};  ///< 0 UBX, 1 NMEA
    std::array<std::uint8_t, 3> reserved0{};
    U1<"masks", 6> masks{};  ///< DDC, UART1, UART2, USB, SPI, reserved; bits: 0 error, 1 warning, 2 notice
};

/// CFG-INF: which texts go out, one or more protocols in one message.
struct CfgInf {
    static constexpr UbxMessageId message_id{0x06, 0x02};
    List<"protocols", CfgInfItem> protocols;

    static void fields(auto& m, auto& v) { v.rest(m.protocols, 1, 255); }
};

/// What every form of CFG-NMEA begins with.
struct CfgNmeaCore {
    U1<"filter"> filter{};  ///< bits: 0 posFilt, 1 mskPosFilt, 2 timeFilt, 3 dateFilt, 4 gpsOnly, 5 trackFilt
    U1<"nmea_version"> nmea_version{};  ///< 0x21 2.1, 0x23 2.3, 0x40 4.0, 0x41 4.10, 0x4B 4.11
    U1<"listed_satellites"> num_sv{};   ///< listed satellites at most; 0 all
    U1<"flags"> flags{};                ///< bits: 0 compat, 1 consider, 2 limit82, 3 highPrec
};

/// What came to it with u-blox 7.
struct CfgNmeaExtension {
    U4<"systems_off"> gnss_to_filter{};  ///< bits: 0 GPS, 1 SBAS, 2 Galileo, 4 QZSS, 5 GLONASS, 6 BeiDou
    U1<"numbering"> sv_numbering{};      ///< 0 strict, 1 extended
    U1<"main_talker"> main_talker_id{};  ///< 0 by system, 1 GP, 2 GL, 3 GN, 4 GA, 5 GB, 7 GQ
    U1<"gsv_talker"> gsv_talker_id{};    ///< 0 by system, 1 as the main one
    U1<"version"> version{};             ///< 0 in the form of 12 bytes, 1 in that of 20
};

/// CFG-NMEA of u-blox 5 and 6, 4 bytes.
struct CfgNmeaShort {
    static constexpr UbxMessageId message_id{0x06, 0x17};
    CfgNmeaCore core;
};

/// CFG-NMEA of u-blox 7 (version 0), 12 bytes.
struct CfgNmeaV0 {
    static constexpr UbxMessageId message_id{0x06, 0x17};
    CfgNmeaCore core;
    CfgNmeaExtension extension;
};

/// CFG-NMEA from M8 on (version 1), 20 bytes.
struct CfgNmea {
    static constexpr UbxMessageId message_id{0x06, 0x17};
    CfgNmeaCore core;
    CfgNmeaExtension extension;
    U1<"beidou_talker", 2> bds_talker_id{};  ///< two letters; zeros: as the standard says
    std::array<std::uint8_t, 6> reserved1{};
};

/// CFG-USB: how the receiver shows itself on USB.
struct CfgUsb {
    static constexpr UbxMessageId message_id{0x06, 0x1B};
    U2<"vendor_id"> vendor_id{};
    U2<"product_id"> product_id{};
    std::array<std::uint8_t, 4> reserved0{};
    U2<"power_ma"> power_consumption{};
    U2<"flags"> flags{};  ///< bits: 0 show again (a command), 1 has its own power
    U1<"vendor", 32> vendor_string{};
    U1<"product", 32> product_string{};
    U1<"serial_number", 32> serial_number{};
};

}  // namespace skyloop::inline receiver
