/// UBX messages of class CFG in the form of u-blox 5 to M8; later receivers take many of them too.
///
/// Fields are declared as field.hpp says. Sections are those of the u-blox M8 interface
/// description (UBX-13003221) and, where named, of the F9 one (HPG 1.32, UBX-22008968).
///
/// UBX messages CFG-VALSET, CFG-VALGET and CFG-VALDEL (F9 interface description, section 3.10).
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

/// CFG-PRT, the question for one port.
struct CfgPrtPoll {
    static constexpr UbxMessageId message_id{0x06, 0x00};
    U1<"port_id"> port_id{};
};

/// One port of CFG-PRT.
struct CfgPrtItem {
    U1<"port_id"> port_id{};  ///< 0 DDC, 1 UART1, 2 UART2, 3 USB, 4 SPI
    std::uint8_t reserved0 = 0;
    U2<"tx_ready"> tx_ready{};
    U4<"mode"> mode{};                     ///< bits: 6-7 length, 9-11 parity, 12-13 stop bits
    U4<"baud"> baud_rate{};                ///< bit/s
    U2<"in_protocols"> in_proto_mask{};    ///< bits: 0 UBX, 1 NMEA, 2 RTCM2, 5 RTCM3
    U2<"out_protocols"> out_proto_mask{};  ///< bits: 0 UBX, 1 NMEA, 5 RTCM3
    U2<"flags"> flags{};                   ///< bit 1: extended timeout
    std::array<std::uint8_t, 2> reserved1{};
};

/// CFG-PRT: ports, one or more in one message.
struct CfgPrt {
    static constexpr UbxMessageId message_id{0x06, 0x00};
    List<"ports", CfgPrtItem> ports;

    static void fields(auto& m, auto& v) { v.rest(m.ports, 1, 255); }
};

/// CFG-MSG, the question for one message.
struct CfgMsgPoll {
    static constexpr UbxMessageId message_id{0x06, 0x01};
    U1<"class"> message_class{};
    U1<"id"> id{};
};

/// CFG-MSG for the port it arrives on.
struct CfgMsgCurrentPort {
    static constexpr UbxMessageId message_id{0x06, 0x01};
    U1<"class"> message_class{};
    U1<"id"> id{};
    U1<"rate"> rate{};  ///< epochs per message, 0 off
};

/// CFG-MSG for all ports.
struct CfgMsg {
    static constexpr UbxMessageId message_id{0x06, 0x01};
    U1<"class"> message_class{};
    U1<"id"> id{};
    U1<"rates", 6> rates{};  ///< epochs per message on DDC, UART1, UART2, USB, SPI; the last is reserved
};

/// CFG-RATE: rates of measurement and navigation.
struct CfgRate {
    static constexpr UbxMessageId message_id{0x06, 0x08};
    U2<"measurement_period_s*1e-3"> meas_rate{};
    U2<"measurements_per_solution"> nav_rate{};  ///< measurements per solution
    U2<"time_reference"> time_ref{};             ///< 0 UTC, 1 GPS, 2 GLONASS, 3 BeiDou, 4 Galileo
};

/// CFG-NAV5: settings of the navigation; only the groups in the mask count.
struct CfgNav5 {
    static constexpr UbxMessageId message_id{0x06, 0x24};
    U2<"mask"> mask{};
    U1<"dynamic_model"> dyn_model{};
    U1<"fix_mode"> fix_mode{};  ///< 1 2D, 2 3D, 3 automatic
    I4<"fixed_height_m*1e-2"> fixed_alt{};
    U4<"fixed_height_variance_m2*1e-4"> fixed_alt_var{};
    I1<"min_elevation_deg"> min_elev{};
    U1<"dead_reckoning_limit_s"> dr_limit{};
    U2<"pdop_mask*1e-1"> p_dop{};
    U2<"tdop_mask*1e-1"> t_dop{};
    U2<"position_acc_mask_m"> p_acc{};
    U2<"time_acc_mask_m"> t_acc{};
    U1<"static_hold_mps*1e-2"> static_hold_thresh{};
    U1<"dgnss_timeout_s"> dgnss_timeout{};
    U1<"cno_satellites"> cno_thresh_num_svs{};
    U1<"cno_mask_dbhz"> cno_thresh{};
    std::array<std::uint8_t, 2> reserved0{};
    U2<"static_hold_m"> static_hold_max_dist{};
    U1<"utc_standard"> utc_standard{};
    std::array<std::uint8_t, 5> reserved1{};
};

/// One system of CFG-GNSS.
struct CfgGnssItem {
    U1<"gnss_id"> gnss_id{};  ///< as in NAV-SAT
    U1<"channels_reserved"> res_trk_ch{};
    U1<"channels_max"> max_trk_ch{};
    std::uint8_t reserved = 0;
    U4<"flags"> flags{};  ///< bits: 0 enabled, 16-23 signals
};

/// CFG-GNSS: systems and their channels.
struct CfgGnss {
    static constexpr UbxMessageId message_id{0x06, 0x3E};
    U1<"version"> version{};  ///< 0
    U1<"channels_hardware"> num_trk_ch_hw{};
    U1<"channels_used"> num_trk_ch_use{};  ///< 255 all
    List<"systems", CfgGnssItem> systems;

    static void fields(auto& m, auto& v) {
        v(m.version, m.num_trk_ch_hw, m.num_trk_ch_use);
        v.count(m.systems);
        v.items(m.systems);
    }
};

/// CFG-CFG: clear, save and load settings.
struct CfgCfg {
    static constexpr UbxMessageId message_id{0x06, 0x09};
    U4<"clear_mask"> clear_mask{};
    U4<"save_mask"> save_mask{};
    U4<"load_mask"> load_mask{};
    std::optional<U1<"device_mask">> device_mask;  ///< bits: 0 battery-backed RAM, 1 flash, 2 EEPROM, 4 SPI flash

    static void fields(auto& m, auto& v) {
        v(m.clear_mask, m.save_mask, m.load_mask);
        v.if_present(m.device_mask);
    }
};

/// CFG-RST: restart.
struct CfgRst {
    static constexpr UbxMessageId message_id{0x06, 0x04};
    U2<"clear_mask"> nav_bbr_mask{};  ///< what is forgotten: 0 hot, 1 warm, 0xFFFF cold
    U1<"reset_mode"> reset_mode{};
    std::uint8_t reserved = 0;
};

/// Bytes of the value that a key names by its bits 28 to 30; 0 when they name none.
constexpr std::size_t config_value_size(std::uint32_t key) {
    constexpr std::array<std::size_t, 8> sizes{0, 1, 1, 2, 4, 8, 0, 0};
    return sizes[key >> 28 & 7u];
}

/// A key and its value, as many bytes of it as the key says. A key without a size fails to decode.
struct ConfigPair {
    U4<"key"> key{};
    U8<"value"> value{};

    static void fields(auto& m, auto& v) {
        v(m.key);
        v.sized(m.value, config_value_size(m.key));
    }
};

/// CFG-VALSET: set values.
struct CfgValset {
    static constexpr UbxMessageId message_id{0x06, 0x8A};
    U1<"version"> version{};          ///< 0 or 1
    U1<"layers"> layers{};            ///< bits: 0 RAM, 1 battery-backed RAM, 2 flash
    U1<"transaction"> transaction{};  ///< 0 none, 1 begin, 2 continue, 3 apply
    std::uint8_t reserved = 0;
    List<"pairs", ConfigPair> pairs;

    static void fields(auto& m, auto& v) {
        v(m.version, m.layers, m.transaction, m.reserved);
        v.rest(m.pairs, 0, 64);
    }
};

/// CFG-VALGET, the question.
struct CfgValgetPoll {
    static constexpr UbxMessageId message_id{0x06, 0x8B};
    static constexpr std::uint8_t layout_version = 0;  ///< tells it from the other layout, which may be as long
    U1<"version"> version{};                           ///< 0
    U1<"layer"> layer{};                               ///< 0 RAM, 1 battery-backed RAM, 2 flash, 7 default
    U2<"position"> position{};                         ///< how many to skip
    List<"keys", std::uint32_t> keys;

    static void fields(auto& m, auto& v) {
        v(m.version, m.layer, m.position);
        v.rest(m.keys, 0, 64);
    }
};

/// CFG-VALGET, the answer.
struct CfgValget {
    static constexpr UbxMessageId message_id{0x06, 0x8B};
    static constexpr std::uint8_t layout_version = 1;  ///< tells it from the other layout, which may be as long
    U1<"version"> version{};                           ///< 1
    U1<"layer"> layer{};                               ///< as asked
    U2<"position"> position{};                         ///< as asked
    List<"pairs", ConfigPair> pairs;

    static void fields(auto& m, auto& v) {
        v(m.version, m.layer, m.position);
        v.rest(m.pairs, 0, 64);
    }
};

/// CFG-VALDEL: back to the layer below.
struct CfgValdel {
    static constexpr UbxMessageId message_id{0x06, 0x8C};
    U1<"version"> version{};          ///< 0 or 1
    U1<"layers"> layers{};            ///< bits: 1 battery-backed RAM, 2 flash
    U1<"transaction"> transaction{};  ///< as CfgValset::transaction
    std::uint8_t reserved = 0;
    List<"keys", std::uint32_t> keys;

    static void fields(auto& m, auto& v) {
        v(m.version, m.layers, m.transaction, m.reserved);
        v.rest(m.keys, 0, 64);
    }
};

}  // namespace skyloop::inline receiver
