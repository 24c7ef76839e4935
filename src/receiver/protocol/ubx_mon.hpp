/// UBX messages of classes ACK, MGA and INF, and those of MON and SEC that tell what the receiver is.
///
/// Numbers are as on the wire; a member's comment gives unit and scale. Sections are those of the u-blox M8 interface
/// description (UBX-13003221) and, where named, of the F9 one (HPG 1.32, UBX-22008968).
///
/// UBX messages of the ports: MON-COMMS, MON-TXBUF, MON-RXBUF, MON-IO and MON-MSGPP.
///
/// Numbers are as on the wire; a member's comment gives unit and scale. Each message names where its layout stands: a
/// section of RECEIVER.md, or the message of that name in the M8 (UBX-13003221), F9 (HPG 1.32, UBX-22008968) or M10
/// (SPG 5.10) interface description.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "receiver/protocol/ubx_fields.hpp"

namespace skyloop::inline receiver {

/// ACK-ACK: a configuration message was done.
struct AckAck {
    static constexpr UbxMessageId message_id{0x05, 0x01};
    std::uint8_t message_class = 0;
    std::uint8_t id = 0;
};

/// ACK-NAK: a configuration message was refused.
struct AckNak {
    static constexpr UbxMessageId message_id{0x05, 0x00};
    std::uint8_t message_class = 0;
    std::uint8_t id = 0;
};

/// A fixed text field, filled up with zeros.
template <std::size_t N>
struct UbxText {
    std::array<char, N> characters{};
};

/// MON-VER: who the receiver is; texts filled up with zeros.
struct MonVer {
    static constexpr UbxMessageId message_id{0x0A, 0x04};
    std::array<char, 30> sw_version{};
    std::array<char, 10> hw_version{};
    std::vector<UbxText<30>> extensions;

    static void fields(auto& m, auto& v) {
        v(m.sw_version, m.hw_version);
        v.rest(m.extensions, 0, 2000);
    }
};

/// SEC-UNIQID: the chip; five bytes in version 1, six in version 2 (M10).
struct SecUniqid {
    static constexpr UbxMessageId message_id{0x27, 0x03};
    std::uint8_t version = 0;
    std::array<std::uint8_t, 3> reserved{};
    std::vector<std::uint8_t> unique_id;

    static void fields(auto& m, auto& v) {
        v(m.version, m.reserved);
        v.rest(m.unique_id, 5, 6);
    }
};

/// INF: a notice to the user, ISO 8859-1, not terminated.
template <std::uint8_t Id>
struct Inf {
    static constexpr UbxMessageId message_id{0x04, Id};
    std::vector<char> text;

    static void fields(auto& m, auto& v) { v.rest(m.text, 0, 65535); }
};

using InfError = Inf<0x00>;
using InfWarning = Inf<0x01>;
using InfNotice = Inf<0x02>;
using InfTest = Inf<0x03>;
using InfDebug = Inf<0x04>;

/// MON-GNSS: systems; bits: 0 GPS, 1 GLONASS, 2 BeiDou, 3 Galileo (RECEIVER.md 3.2).
struct MonGnss {
    static constexpr UbxMessageId message_id{0x0A, 0x28};
    std::uint8_t version = 0;  ///< 0
    std::uint8_t supported = 0;
    std::uint8_t default_gnss = 0;
    std::uint8_t enabled = 0;
    std::uint8_t simultaneous = 0;  ///< how many at once
    std::array<std::uint8_t, 3> reserved0{};
};

/// MON-SYS: load and temperature (RECEIVER.md 3.2).
struct MonSys {
    static constexpr UbxMessageId message_id{0x0A, 0x39};
    std::uint8_t msg_ver = 1;        ///< 1
    std::uint8_t boot_type = 0;      ///< 0 unknown, 1 cold, 2 watchdog, 3 hardware reset, 4-5 backup, 6 software reset
    std::uint8_t cpu_load = 0;       ///< %
    std::uint8_t cpu_load_max = 0;   ///< %
    std::uint8_t mem_usage = 0;      ///< %
    std::uint8_t mem_usage_max = 0;  ///< %
    std::uint8_t io_usage = 0;       ///< %
    std::uint8_t io_usage_max = 0;   ///< %
    std::uint32_t run_time = 0;      ///< s
    std::uint16_t notice_count = 0;
    std::uint16_t warn_count = 0;
    std::uint16_t error_count = 0;
    std::int8_t temp_value = 0;  ///< °C
    std::array<std::uint8_t, 5> reserved0{};
};

/// One patch of MON-PATCH.
struct MonPatchItem {
    std::uint32_t patch_info = 0;  ///< bits: 0 activated, 1-2 location
    std::uint32_t comparator_number = 0;
    std::uint32_t patch_address = 0;
    std::uint32_t patch_data = 0;
};

/// MON-PATCH: patches of the firmware (M8 interface description).
struct MonPatch {
    static constexpr UbxMessageId message_id{0x0A, 0x27};
    std::uint16_t version = 1;    ///< 1
    std::uint16_t n_entries = 0;  ///< patches that follow
    std::vector<MonPatchItem> patches;

    static void fields(auto& m, auto& v) {
        v(m.version, m.n_entries);
        v.rest(m.patches, 0, 4095);
    }
};

/// MON-RXR: the receiver woke or went to sleep (M8 interface description).
struct MonRxr {
    static constexpr UbxMessageId message_id{0x0A, 0x21};
    std::uint8_t flags = 0;  ///< bit 0: awake
};

/// MGA-ACK-DATA0: what came of an assistance message (M8 interface description).
struct MgaAck {
    static constexpr UbxMessageId message_id{0x13, 0x60};
    std::uint8_t type = 0;     ///< 0 not used, 1 accepted
    std::uint8_t version = 0;  ///< 0
    std::uint8_t info_code =
        0;                    ///< 0 accepted, 1 no time, 2 version, 3 size, 4 not stored, 5 not ready, 6 type unknown
    std::uint8_t msg_id = 0;  ///< of class MGA
    std::array<std::uint8_t, 4> payload_start{};  ///< of that message
};

/// One port of MON-COMMS.
struct MonCommsItem {
    std::uint16_t port_id = 0;     ///< 0x0000 I2C, 0x0100 UART1, 0x0200 or 0x0201 UART2, 0x0300 USB, 0x0400 SPI
    std::uint16_t tx_pending = 0;  ///< bytes
    std::uint32_t tx_bytes = 0;
    std::uint8_t tx_usage = 0;       ///< %
    std::uint8_t tx_peak_usage = 0;  ///< %
    std::uint16_t rx_pending = 0;    ///< bytes
    std::uint32_t rx_bytes = 0;
    std::uint8_t rx_usage = 0;            ///< %
    std::uint8_t rx_peak_usage = 0;       ///< %
    std::uint16_t overrun_errs = 0;       ///< slots of 100 ms
    std::array<std::uint16_t, 4> msgs{};  ///< received, by MonComms::prot_ids
    std::array<std::uint8_t, 8> reserved1{};
    std::uint32_t skipped = 0;  ///< bytes
};

/// MON-COMMS: ports (RECEIVER.md 3.2).
struct MonComms {
    static constexpr UbxMessageId message_id{0x0A, 0x36};
    std::uint8_t version = 0;  ///< 0
    std::uint8_t tx_errors =
        0;  ///< bits: 0 memory, 1 transmit buffer full, 2-4 one more than this message's port on new firmware
    std::uint8_t reserved0 = 0;
    std::array<std::uint8_t, 4> prot_ids{};  ///< 0 UBX, 1 NMEA, 2 RTCM2, 5 RTCM3, 6 SPARTN, 255 none
    std::vector<MonCommsItem> ports;

    static void fields(auto& m, auto& v) {
        v(m.version);
        v.count(m.ports);
        v(m.tx_errors, m.reserved0, m.prot_ids);
        v.items(m.ports);
    }
};

/// MON-TXBUF: transmit buffers by port: DDC, UART1, UART2, USB, SPI, none (RECEIVER.md 3.2).
struct MonTxbuf {
    static constexpr UbxMessageId message_id{0x0A, 0x08};
    std::array<std::uint16_t, 6> pending{};    ///< bytes
    std::array<std::uint8_t, 6> usage{};       ///< %
    std::array<std::uint8_t, 6> peak_usage{};  ///< %
    std::uint8_t t_usage = 0;                  ///< %
    std::uint8_t t_peak_usage = 0;             ///< %
    std::uint8_t errors = 0;                   ///< bits: 0-5 limit of the port, 6 memory, 7 allocation
    std::uint8_t reserved0 = 0;
};

/// MON-RXBUF: receive buffers by port, as MON-TXBUF (RECEIVER.md 3.2).
struct MonRxbuf {
    static constexpr UbxMessageId message_id{0x0A, 0x07};
    std::array<std::uint16_t, 6> pending{};    ///< bytes
    std::array<std::uint8_t, 6> usage{};       ///< %
    std::array<std::uint8_t, 6> peak_usage{};  ///< %
};

/// One port of MON-IO.
struct MonIoItem {
    std::uint32_t rx_bytes = 0;
    std::uint32_t tx_bytes = 0;
    std::uint16_t parity_errs = 0;   ///< slots of 100 ms
    std::uint16_t framing_errs = 0;  ///< slots of 100 ms
    std::uint16_t overrun_errs = 0;  ///< slots of 100 ms
    std::uint16_t break_cond = 0;    ///< slots of 100 ms
    std::array<std::uint8_t, 4> reserved1{};
};

/// MON-IO: ports, in the order of MON-TXBUF (M8 interface description).
struct MonIo {
    static constexpr UbxMessageId message_id{0x0A, 0x02};
    std::vector<MonIoItem> ports;

    static void fields(auto& m, auto& v) { v.rest(m.ports, 0, 255); }
};

/// MON-MSGPP: messages received by port and protocol (M8 interface description).
struct MonMsgpp {
    static constexpr UbxMessageId message_id{0x0A, 0x06};
    std::array<std::uint16_t, 48> msg{};     ///< eight protocols of each port, ports in the order of MON-TXBUF
    std::array<std::uint32_t, 6> skipped{};  ///< bytes
};

}  // namespace skyloop::inline receiver
