/// The ports of a receiver.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace skyloop::firmware {

/// As CFG-PRT numbers them (u-blox M8 interface description, 32.11.23).
enum class PortId : std::uint8_t { i2c = 0, uart1 = 1, uart2 = 2, usb = 3, spi = 4 };
inline constexpr std::size_t port_count = 5;
/// As board files and port URIs name them, in the order of PortId.
inline constexpr std::array<std::string_view, port_count> port_names{"i2c", "uart1", "uart2", "usb", "spi"};

constexpr bool is_uart(PortId port) { return port == PortId::uart1 || port == PortId::uart2; }

}  // namespace skyloop::firmware
