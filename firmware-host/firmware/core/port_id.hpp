/// The ports of a receiver.
/// Classes of messages, and the items by which ports let protocols through.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace skyloop::firmware {

/// The first five as CFG-PRT numbers them (u-blox M8 interface description, 32.11.23); u-blox has no third UART.
enum class PortId : std::uint8_t { i2c = 0, uart1 = 1, uart2 = 2, usb = 3, spi = 4, uart3 = 5 };
inline constexpr std::size_t ublox_port_count = 5, port_count = 6;
/// As board files and port URIs name them, in the order of PortId.
inline constexpr std::array<std::string_view, port_count> port_names{"i2c", "uart1", "uart2", "usb", "spi", "uart3"};

constexpr bool is_uart(PortId port) { return port == PortId::uart1 || port == PortId::uart2 || port == PortId::uart3; }

/// Classes of UBX messages that the receiver treats apart; sentences and RTCM have classes too where CFG-MSG names
/// them (u-blox M8 interface description, 32.8 and 31.1.5).
inline constexpr std::uint8_t class_cfg = 0x06, class_mga = 0x13, class_log = 0x21, class_nmea = 0xF0,
                              class_pubx = 0xF1, class_rtcm = 0xF5;

/// Items of the groups CFG-…INPROT and CFG-…OUTPROT (F9 interface description HPG 1.32, CFG-UART1INPROT).
inline constexpr std::uint32_t protocol_ubx = 1, protocol_nmea = 2, protocol_rtcm3 = 4;

}  // namespace skyloop::firmware
