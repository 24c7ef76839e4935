/// UBX messages of classes ACK, MGA and INF, and those of MON and SEC that tell what the receiver is.
///
/// Fields are declared as field.hpp says. Sections are those of the u-blox M8 interface
/// description (UBX-13003221) and, where named, of the F9 one (HPG 1.32, UBX-22008968).
///
/// UBX messages of the ports: MON-COMMS, MON-TXBUF, MON-RXBUF, MON-IO and MON-MSGPP.
///
/// Fields are declared as field.hpp says. Each message names where its layout stands: a
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
    U1<"class"> message_class{};
    U1<"id"> id{};
};

/// ACK-NAK: a configuration message was refused.
struct AckNak {
    static constexpr UbxMessageId message_id{0x05, 0x00};
    U1<"class"> message_class{};
    U1<"id"> id{};
};

/// MON-VER: who the receiver is; texts filled up with zeros.
struct MonVer {
    static constexpr UbxMessageId message_id{0x0A, 0x04};
    Text<"software", 30> sw_version{};
    Text<"hardware", 10> hw_version{};
    List<"extensions", std::array<char, 30>> extensions;

    static void fields(auto& m, auto& v) {
        v(m.sw_version, m.hw_version);
        v.rest(m.extensions, 0, 2000);
    }
};

/// SEC-UNIQID: the chip; five bytes in version 1, six in version 2 (M10).
struct SecUniqid {
    static constexpr UbxMessageId message_id{0x27, 0x03};
    U1<"version"> version{};
    std::array<std::uint8_t, 3> reserved{};
    List<"unique_id", std::uint8_t> unique_id;

    static void fields(auto& m, auto& v) {
        v(m.version, m.reserved);
        v.rest(m.unique_id, 5, 6);
    }
};

/// INF: a notice to the user, ISO 8859-1, not terminated.
template <std::uint8_t Id>
struct Inf {
    static constexpr UbxMessageId message_id{0x04, Id};
    List<"text", char> text;

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
    U1<"version"> version{};  ///< 0
    U1<"supported"> supported{};
    U1<"default"> default_gnss{};
    U1<"enabled"> enabled{};
    U1<"simultaneous"> simultaneous{};  ///< how many at once
    std::array<std::uint8_t, 3> reserved0{};
};

/// MON-SYS: load and temperature (RECEIVER.md 3.2).
struct MonSys {
    static constexpr UbxMessageId message_id{0x0A, 0x39};
    U1<"version"> msg_ver = 1;    ///< 1
    U1<"boot_type"> boot_type{};  ///< 0 unknown, 1 cold, 2 watchdog, 3 hardware reset, 4-5 backup, 6 software reset
    U1<"cpu_percent"> cpu_load{};
    U1<"cpu_peak_percent"> cpu_load_max{};
    U1<"memory_percent"> mem_usage{};
    U1<"memory_peak_percent"> mem_usage_max{};
    U1<"io_percent"> io_usage{};
    U1<"io_peak_percent"> io_usage_max{};
    U4<"run_time_s"> run_time{};
    U2<"notices"> notice_count{};
    U2<"warnings"> warn_count{};
    U2<"errors"> error_count{};
    I1<"temperature_c"> temp_value{};
    std::array<std::uint8_t, 5> reserved0{};
};

/// One patch of MON-PATCH.
struct MonPatchItem {
    U4<"info"> patch_info{};  ///< bits: 0 activated, 1-2 location
    U4<"comparator"> comparator_number{};
    U4<"address"> patch_address{};
    U4<"data"> patch_data{};
};

/// MON-PATCH: patches of the firmware (M8 interface description).
struct MonPatch {
    static constexpr UbxMessageId message_id{0x0A, 0x27};
    U2<"version"> version = 1;  ///< 1
    U2<"entries"> n_entries{};  ///< patches that follow
    List<"patches", MonPatchItem> patches;

    static void fields(auto& m, auto& v) {
        v(m.version, m.n_entries);
        v.rest(m.patches, 0, 4095);
    }
};

/// MON-RXR: the receiver woke or went to sleep (M8 interface description).
struct MonRxr {
    static constexpr UbxMessageId message_id{0x0A, 0x21};
    U1<"flags"> flags{};  ///< bit 0: awake
};

/// MGA-ACK-DATA0: what came of an assistance message (M8 interface description).
struct MgaAck {
    static constexpr UbxMessageId message_id{0x13, 0x60};
    U1<"type"> type{};        ///< 0 not used, 1 accepted
    U1<"version"> version{};  ///< 0
    U1<"info_code">
        info_code{};    ///< 0 accepted, 1 no time, 2 version, 3 size, 4 not stored, 5 not ready, 6 type unknown
    U1<"id"> msg_id{};  ///< of class MGA
    U1<"payload_start", 4> payload_start{};  ///< of that message
};

/// One port of MON-COMMS.
struct MonCommsItem {
    U2<"port_id"> port_id{};        ///< 0x0000 I2C, 0x0100 UART1, 0x0200 or 0x0201 UART2, 0x0300 USB, 0x0400 SPI
    U2<"tx_pending"> tx_pending{};  ///< bytes
    U4<"tx_bytes"> tx_bytes{};
    U1<"tx_usage_percent"> tx_usage{};
    U1<"tx_peak_usage_percent"> tx_peak_usage{};
    U2<"rx_pending"> rx_pending{};  ///< bytes
    U4<"rx_bytes"> rx_bytes{};
    U1<"rx_usage_percent"> rx_usage{};
    U1<"rx_peak_usage_percent"> rx_peak_usage{};
    U2<"overruns"> overrun_errs{};  ///< slots of 100 ms
    U2<"messages", 4> msgs{};       ///< received, by MonComms::prot_ids
    std::array<std::uint8_t, 8> reserved1{};
    U4<"skipped_bytes"> skipped{};  ///< bytes
};

/// MON-COMMS: ports (RECEIVER.md 3.2).
struct MonComms {
    static constexpr UbxMessageId message_id{0x0A, 0x36};
    U1<"version"> version{};  ///< 0
    U1<"tx_errors">
        tx_errors{};  ///< bits: 0 memory, 1 transmit buffer full, 2-4 one more than this message's port on new firmware
    std::uint8_t reserved0 = 0;
    U1<"protocols", 4> prot_ids{};  ///< 0 UBX, 1 NMEA, 2 RTCM2, 5 RTCM3, 6 SPARTN, 255 none
    List<"ports", MonCommsItem> ports;

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
    U2<"pending", 6> pending{};  ///< bytes
    U1<"usage_percent", 6> usage{};
    U1<"peak_usage_percent", 6> peak_usage{};
    U1<"total_usage_percent"> t_usage{};
    U1<"total_peak_usage_percent"> t_peak_usage{};
    U1<"errors"> errors{};  ///< bits: 0-5 limit of the port, 6 memory, 7 allocation
    std::uint8_t reserved0 = 0;
};

/// MON-RXBUF: receive buffers by port, as MON-TXBUF (RECEIVER.md 3.2).
struct MonRxbuf {
    static constexpr UbxMessageId message_id{0x0A, 0x07};
    U2<"pending", 6> pending{};  ///< bytes
    U1<"usage_percent", 6> usage{};
    U1<"peak_usage_percent", 6> peak_usage{};
};

/// One port of MON-IO.
struct MonIoItem {
    U4<"rx_bytes"> rx_bytes{};
    U4<"tx_bytes"> tx_bytes{};
    U2<"parity_errors"> parity_errs{};    ///< slots of 100 ms
    U2<"framing_errors"> framing_errs{};  ///< slots of 100 ms
    U2<"overruns"> overrun_errs{};        ///< slots of 100 ms
    U2<"breaks"> break_cond{};            ///< slots of 100 ms
    std::array<std::uint8_t, 4> reserved1{};
};

/// MON-IO: ports, in the order of MON-TXBUF (M8 interface description).
struct MonIo {
    static constexpr UbxMessageId message_id{0x0A, 0x02};
    List<"ports", MonIoItem> ports;

    static void fields(auto& m, auto& v) { v.rest(m.ports, 0, 255); }
};

/// MON-MSGPP: messages received by port and protocol (M8 interface description).
struct MonMsgpp {
    static constexpr UbxMessageId message_id{0x0A, 0x06};
    U2<"messages", 48> msg{};          ///< eight protocols of each port, ports in the order of MON-TXBUF
    U4<"skipped_bytes", 6> skipped{};  ///< bytes
};

}  // namespace skyloop::inline receiver
