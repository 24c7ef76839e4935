/// UBX messages of class CFG in the form of u-blox 5 to M8; later receivers take many of them too.
///
/// Numbers are as on the wire; a member's comment gives unit and scale. Sections are those of the u-blox M8 interface
/// description (UBX-13003221) and, where named, of the F9 one (HPG 1.32, UBX-22008968).
///
/// UBX messages CFG-VALSET, CFG-VALGET and CFG-VALDEL (F9 interface description, section 3.10).
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

/// CFG-PRT, the question for one port.
struct CfgPrtPoll {
    static constexpr UbxMessageId message_id{0x06, 0x00};
    std::uint8_t port_id = 0;
};

/// One port of CFG-PRT.
struct CfgPrtItem {
    std::uint8_t port_id = 0;  ///< 0 DDC, 1 UART1, 2 UART2, 3 USB, 4 SPI
    std::uint8_t reserved0 = 0;
    std::uint16_t tx_ready = 0;
    std::uint32_t mode = 0;            ///< bits: 6-7 length, 9-11 parity, 12-13 stop bits
    std::uint32_t baud_rate = 0;       ///< bit/s
    std::uint16_t in_proto_mask = 0;   ///< bits: 0 UBX, 1 NMEA, 2 RTCM2, 5 RTCM3
    std::uint16_t out_proto_mask = 0;  ///< bits: 0 UBX, 1 NMEA, 5 RTCM3
    std::uint16_t flags = 0;           ///< bit 1: extended timeout
    std::array<std::uint8_t, 2> reserved1{};
};

/// CFG-PRT: ports, one or more in one message.
struct CfgPrt {
    static constexpr UbxMessageId message_id{0x06, 0x00};
    std::vector<CfgPrtItem> ports;

    static void fields(auto& m, auto& v) { v.rest(m.ports, 1, 255); }
};

/// CFG-MSG, the question for one message.
struct CfgMsgPoll {
    static constexpr UbxMessageId message_id{0x06, 0x01};
    std::uint8_t message_class = 0;
    std::uint8_t id = 0;
};

/// CFG-MSG for the port it arrives on.
struct CfgMsgCurrentPort {
    static constexpr UbxMessageId message_id{0x06, 0x01};
    std::uint8_t message_class = 0;
    std::uint8_t id = 0;
    std::uint8_t rate = 0;  ///< epochs per message, 0 off
};

/// CFG-MSG for all ports.
struct CfgMsg {
    static constexpr UbxMessageId message_id{0x06, 0x01};
    std::uint8_t message_class = 0;
    std::uint8_t id = 0;
    std::array<std::uint8_t, 6> rates{};  ///< epochs per message on DDC, UART1, UART2, USB, SPI; the last is reserved
};

/// CFG-RATE: rates of measurement and navigation.
struct CfgRate {
    static constexpr UbxMessageId message_id{0x06, 0x08};
    std::uint16_t meas_rate = 0;  ///< ms
    std::uint16_t nav_rate = 0;   ///< measurements per solution
    std::uint16_t time_ref = 0;   ///< 0 UTC, 1 GPS, 2 GLONASS, 3 BeiDou, 4 Galileo
};

/// CFG-NAV5: settings of the navigation; only the groups in the mask count.
struct CfgNav5 {
    static constexpr UbxMessageId message_id{0x06, 0x24};
    std::uint16_t mask = 0;
    std::uint8_t dyn_model = 0;
    std::uint8_t fix_mode = 0;            ///< 1 2D, 2 3D, 3 automatic
    std::int32_t fixed_alt = 0;           ///< 0.01 m
    std::uint32_t fixed_alt_var = 0;      ///< 0.0001 m²
    std::int8_t min_elev = 0;             ///< deg
    std::uint8_t dr_limit = 0;            ///< s
    std::uint16_t p_dop = 0;              ///< 0.1
    std::uint16_t t_dop = 0;              ///< 0.1
    std::uint16_t p_acc = 0;              ///< m
    std::uint16_t t_acc = 0;              ///< m
    std::uint8_t static_hold_thresh = 0;  ///< cm/s
    std::uint8_t dgnss_timeout = 0;       ///< s
    std::uint8_t cno_thresh_num_svs = 0;
    std::uint8_t cno_thresh = 0;  ///< dBHz
    std::array<std::uint8_t, 2> reserved0{};
    std::uint16_t static_hold_max_dist = 0;  ///< m
    std::uint8_t utc_standard = 0;
    std::array<std::uint8_t, 5> reserved1{};
};

/// One system of CFG-GNSS.
struct CfgGnssItem {
    std::uint8_t gnss_id = 0;  ///< as in NAV-SAT
    std::uint8_t res_trk_ch = 0;
    std::uint8_t max_trk_ch = 0;
    std::uint8_t reserved = 0;
    std::uint32_t flags = 0;  ///< bits: 0 enabled, 16-23 signals
};

/// CFG-GNSS: systems and their channels.
struct CfgGnss {
    static constexpr UbxMessageId message_id{0x06, 0x3E};
    std::uint8_t version = 0;  ///< 0
    std::uint8_t num_trk_ch_hw = 0;
    std::uint8_t num_trk_ch_use = 0;  ///< 255 all
    std::vector<CfgGnssItem> systems;

    static void fields(auto& m, auto& v) {
        v(m.version, m.num_trk_ch_hw, m.num_trk_ch_use);
        v.count(m.systems);
        v.items(m.systems);
    }
};

/// CFG-CFG: clear, save and load settings.
struct CfgCfg {
    static constexpr UbxMessageId message_id{0x06, 0x09};
    std::uint32_t clear_mask = 0;
    std::uint32_t save_mask = 0;
    std::uint32_t load_mask = 0;
    std::optional<std::uint8_t> device_mask;  ///< bits: 0 battery-backed RAM, 1 flash, 2 EEPROM, 4 SPI flash

    static void fields(auto& m, auto& v) {
        v(m.clear_mask, m.save_mask, m.load_mask);
        v.if_present(m.device_mask);
    }
};

/// CFG-RST: restart.
struct CfgRst {
    static constexpr UbxMessageId message_id{0x06, 0x04};
    std::uint16_t nav_bbr_mask = 0;  ///< what is forgotten: 0 hot, 1 warm, 0xFFFF cold
    std::uint8_t reset_mode = 0;
    std::uint8_t reserved = 0;
};

/// Bytes of the value that a key names by its bits 28 to 30; 0 when they name none.
constexpr std::size_t config_value_size(std::uint32_t key) {
    constexpr std::array<std::size_t, 8> sizes{0, 1, 1, 2, 4, 8, 0, 0};
    return sizes[key >> 28 & 7u];
}

/// A key and its value, as many bytes of it as the key says. A key without a size fails to decode.
struct ConfigPair {
    std::uint32_t key = 0;
    std::uint64_t value = 0;

    static void fields(auto& m, auto& v) {
        v(m.key);
        v.sized(m.value, config_value_size(m.key));
    }
};

/// CFG-VALSET: set values.
struct CfgValset {
    static constexpr UbxMessageId message_id{0x06, 0x8A};
    std::uint8_t version = 0;      ///< 0 or 1
    std::uint8_t layers = 0;       ///< bits: 0 RAM, 1 battery-backed RAM, 2 flash
    std::uint8_t transaction = 0;  ///< 0 none, 1 begin, 2 continue, 3 apply
    std::uint8_t reserved = 0;
    std::vector<ConfigPair> pairs;

    static void fields(auto& m, auto& v) {
        v(m.version, m.layers, m.transaction, m.reserved);
        v.rest(m.pairs, 0, 64);
    }
};

/// CFG-VALGET, the question.
struct CfgValgetPoll {
    static constexpr UbxMessageId message_id{0x06, 0x8B};
    std::uint8_t version = 0;    ///< 0
    std::uint8_t layer = 0;      ///< 0 RAM, 1 battery-backed RAM, 2 flash, 7 default
    std::uint16_t position = 0;  ///< how many to skip
    std::vector<std::uint32_t> keys;

    static void fields(auto& m, auto& v) {
        v(m.version, m.layer, m.position);
        v.rest(m.keys, 0, 64);
    }
};

/// CFG-VALGET, the answer.
struct CfgValget {
    static constexpr UbxMessageId message_id{0x06, 0x8B};
    std::uint8_t version = 0;    ///< 1
    std::uint8_t layer = 0;      ///< as asked
    std::uint16_t position = 0;  ///< as asked
    std::vector<ConfigPair> pairs;

    static void fields(auto& m, auto& v) {
        v(m.version, m.layer, m.position);
        v.rest(m.pairs, 0, 64);
    }
};

/// CFG-VALDEL: back to the layer below.
struct CfgValdel {
    static constexpr UbxMessageId message_id{0x06, 0x8C};
    std::uint8_t version = 0;      ///< 0 or 1
    std::uint8_t layers = 0;       ///< bits: 1 battery-backed RAM, 2 flash
    std::uint8_t transaction = 0;  ///< as CfgValset::transaction
    std::uint8_t reserved = 0;
    std::vector<std::uint32_t> keys;

    static void fields(auto& m, auto& v) {
        v(m.version, m.layers, m.transaction, m.reserved);
        v.rest(m.keys, 0, 64);
    }
};

}  // namespace skyloop::inline receiver
