/// UBX messages of class CFG about the receiver's hardware: TP5, ITFM, PMS, RXM, ANT, LOGFILTER; and UPD-SOS.
///
/// Numbers are as on the wire; a member's comment gives unit and scale. Layouts: u-blox M8 interface description
/// (UBX-13003221), sections 32.11 and 32.20.
///
/// UBX messages of class CFG about what leaves the ports: INF, NMEA, USB.
///
/// Numbers are as on the wire. Layouts: u-blox M8 interface description (UBX-13003221), section 32.11.
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
    std::uint8_t tp_idx = 0;
    std::uint8_t version = 0;  ///< 1; 0 in the first firmware of M8
    std::array<std::uint8_t, 2> reserved0{};
    std::int16_t ant_cable_delay = 0;        ///< ns
    std::int16_t rf_group_delay = 0;         ///< ns
    std::uint32_t freq_period = 0;           ///< Hz or µs, while time is not known
    std::uint32_t freq_period_lock = 0;      ///< Hz or µs, once it is
    std::uint32_t pulse_len_ratio = 0;       ///< µs or 2^-32
    std::uint32_t pulse_len_ratio_lock = 0;  ///< µs or 2^-32
    std::int32_t user_config_delay = 0;      ///< ns
    std::uint32_t flags = 0;  ///< bits: 0 active, 1 lock, 2 other set when locked, 3 isFreq, 4 isLength, 5 align, 6
                              ///< rising, 7-10 time grid, 11-13 sync mode
};

/// CFG-ITFM: the monitor of jamming.
struct CfgItfm {
    static constexpr UbxMessageId message_id{0x06, 0x39};
    std::uint32_t config = 0;  ///< bits: 0-3 broadband threshold dB, 4-8 tone threshold dB, 9-30 fixed, 31 enabled
    std::uint32_t config2 =
        0;  ///< bits: 0-11 fixed, 12-13 antenna (0 unknown, 1 passive, 2 active), 14 auxiliary bands
};

/// CFG-PMS: power modes for simple needs.
struct CfgPms {
    static constexpr UbxMessageId message_id{0x06, 0x86};
    std::uint8_t version = 0;            ///< 0
    std::uint8_t power_setup_value = 0;  ///< 0 full, 1 balanced, 2 interval, 3 … 5 aggressive at 1, 2, 4 Hz, 255 none
    std::uint16_t period = 0;            ///< s, of interval
    std::uint16_t on_time = 0;           ///< s, of interval
    std::array<std::uint8_t, 2> reserved0{};
};

/// CFG-RXM: power save on and off.
struct CfgRxm {
    static constexpr UbxMessageId message_id{0x06, 0x11};
    std::uint8_t reserved0 = 8;
    std::uint8_t lp_mode = 0;  ///< 0 and 4 continuous, 1 power save
};

/// CFG-ANT: the supply of the antenna.
struct CfgAnt {
    static constexpr UbxMessageId message_id{0x06, 0x13};
    std::uint16_t flags = 0;  ///< bits: 0 supply, 1 short detection, 2 open detection, 3 off when short, 4 recovers
    std::uint16_t pins = 0;   ///< bits: 0-4 switch, 5-9 short, 10-14 open, 15 take the pins
};

/// CFG-LOGFILTER: which positions are logged.
struct CfgLogfilter {
    static constexpr UbxMessageId message_id{0x06, 0x47};
    std::uint8_t version = 1;              ///< 1
    std::uint8_t flags = 0;                ///< bits: 0 logging, 1 once per wake-up, 2 all filters must hold
    std::uint16_t min_interval = 0;        ///< s
    std::uint16_t time_threshold = 0;      ///< s
    std::uint16_t speed_threshold = 0;     ///< m/s
    std::uint32_t position_threshold = 0;  ///< m
};

/// CFG-PM2: how power is saved (protocol versions 18 to 22).
struct CfgPm2 {
    static constexpr UbxMessageId message_id{0x06, 0x3B};
    std::uint8_t version = 2;  ///< 2
    std::uint8_t reserved0 = 0;
    std::uint8_t max_startup_state_dur = 0;  ///< s
    std::uint8_t reserved1 = 0;
    /// Bits: 4 EXTINT1, 5 wake, 6 backup, 7 inactivity, 8 peak current, 10 time fix, 12 ephemerides, 16 never off, 17
    /// cyclic
    std::uint32_t flags = 0;
    std::uint32_t update_period = 0;  ///< ms
    std::uint32_t search_period = 0;  ///< ms
    std::uint32_t grid_offset = 0;    ///< ms
    std::uint16_t on_time = 0;        ///< s
    std::uint16_t min_acq_time = 0;   ///< s
    std::array<std::uint8_t, 20> reserved2{};
    std::uint32_t extint_inactivity = 0;  ///< ms
};

/// CFG-PWR: the state that the receiver is to be in (F9 interface description, HPG 1.10).
struct CfgPwr {
    static constexpr UbxMessageId message_id{0x06, 0x57};
    std::uint8_t version = 1;  ///< 1
    std::array<std::uint8_t, 3> reserved0{};
    std::uint32_t state = 0;  ///< of PowerStateWord
};

/// The states of CFG-PWR: four letters each.
enum PowerStateWord : std::uint32_t { power_run = 0x52554E20, power_stop = 0x53544F50, power_backup = 0x42434B50 };

/// UPD-SOS, a command: battery-backed memory to flash.
struct UpdSos {
    static constexpr UbxMessageId message_id{0x09, 0x14};
    std::uint8_t cmd = 0;  ///< 0 create a backup, 1 clear it
    std::array<std::uint8_t, 3> reserved0{};
};

/// UPD-SOS, an answer.
struct UpdSosStatus {
    static constexpr UbxMessageId message_id{0x09, 0x14};
    std::uint8_t cmd = 0;  ///< 2 a backup was created or not, 3 what was restored at the start
    std::array<std::uint8_t, 3> reserved0{};
    std::uint8_t response = 0;  ///< of cmd 2: 0 no, 1 yes; of cmd 3: 0 unknown, 1 failed, 2 restored, 3 no backup
    std::array<std::uint8_t, 3> reserved1{};
};

/// One protocol of CFG-INF.
struct CfgInfItem {
    std::uint8_t protocol_id = 0;  ///< 0 UBX, 1 NMEA
    std::array<std::uint8_t, 3> reserved0{};
    std::array<std::uint8_t, 6> masks{};  ///< DDC, UART1, UART2, USB, SPI, reserved; bits: 0 error, 1 warning, 2 notice
};

/// CFG-INF: which texts go out, one or more protocols in one message.
struct CfgInf {
    static constexpr UbxMessageId message_id{0x06, 0x02};
    std::vector<CfgInfItem> protocols;

    static void fields(auto& m, auto& v) { v.rest(m.protocols, 1, 255); }
};

/// What every form of CFG-NMEA begins with.
struct CfgNmeaCore {
    std::uint8_t filter = 0;        ///< bits: 0 posFilt, 1 mskPosFilt, 2 timeFilt, 3 dateFilt, 4 gpsOnly, 5 trackFilt
    std::uint8_t nmea_version = 0;  ///< 0x21 2.1, 0x23 2.3, 0x40 4.0, 0x41 4.10, 0x4B 4.11
    std::uint8_t num_sv = 0;        ///< listed satellites at most; 0 all
    std::uint8_t flags = 0;         ///< bits: 0 compat, 1 consider, 2 limit82, 3 highPrec
};

/// What came to it with u-blox 7.
struct CfgNmeaExtension {
    std::uint32_t gnss_to_filter = 0;  ///< bits: 0 GPS, 1 SBAS, 2 Galileo, 4 QZSS, 5 GLONASS, 6 BeiDou
    std::uint8_t sv_numbering = 0;     ///< 0 strict, 1 extended
    std::uint8_t main_talker_id = 0;   ///< 0 by system, 1 GP, 2 GL, 3 GN, 4 GA, 5 GB, 7 GQ
    std::uint8_t gsv_talker_id = 0;    ///< 0 by system, 1 as the main one
    std::uint8_t version = 0;          ///< 0 in the form of 12 bytes, 1 in that of 20
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
    std::array<std::uint8_t, 2> bds_talker_id{};  ///< two letters; zeros: as the standard says
    std::array<std::uint8_t, 6> reserved1{};
};

/// CFG-USB: how the receiver shows itself on USB.
struct CfgUsb {
    static constexpr UbxMessageId message_id{0x06, 0x1B};
    std::uint16_t vendor_id = 0;
    std::uint16_t product_id = 0;
    std::array<std::uint8_t, 4> reserved0{};
    std::uint16_t power_consumption = 0;  ///< mA
    std::uint16_t flags = 0;              ///< bits: 0 show again (a command), 1 has its own power
    std::array<std::uint8_t, 32> vendor_string{};
    std::array<std::uint8_t, 32> product_string{};
    std::array<std::uint8_t, 32> serial_number{};
};

}  // namespace skyloop::inline receiver
