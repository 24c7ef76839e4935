/// UBX messages of the ports: MON-COMMS, MON-TXBUF, MON-RXBUF, MON-IO and MON-MSGPP.
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

namespace skyloop {

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

    template <class M, class V>
    static void fields(M& m, V& v) {
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

    template <class M, class V>
    static void fields(M& m, V& v) {
        v.rest(m.ports, 0, 255);
    }
};

/// MON-MSGPP: messages received by port and protocol (M8 interface description).
struct MonMsgpp {
    static constexpr UbxMessageId message_id{0x0A, 0x06};
    std::array<std::uint16_t, 48> msg{};     ///< eight protocols of each port, ports in the order of MON-TXBUF
    std::array<std::uint32_t, 6> skipped{};  ///< bytes
};

}  // namespace skyloop
