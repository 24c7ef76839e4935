/// How a USB device is named: by what it is, or by where it is plugged in.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/result.hpp"

namespace skyloop {

/// The two numbers of a device descriptor that tell what a device is (USB 2.0, table 9-8: idVendor, idProduct).
struct UsbIds {
    std::uint16_t vendor = 0;
    std::uint16_t product = 0;
    auto operator<=>(const UsbIds&) const = default;
};
/// "1546:01a8", in lower case.
std::string to_string(UsbIds ids);
/// Four hexadecimal digits, a colon, four more. Nothing for anything else.
std::optional<UsbIds> parse_usb_ids(std::string_view text);

/// What was read of one device that is plugged in.
struct UsbDeviceInfo {
    UsbIds ids;
    std::string manufacturer;       ///< empty: it tells none, or may not be opened
    std::string product;            ///< likewise
    std::string serial;             ///< likewise
    std::string port_path;          ///< bus and ports, "1-1.2", as the kernel writes it; a root hub is "usb1"
    std::string node = {};          ///< "/dev/bus/usb/001/004", by which it is opened
    std::uint8_t device_class = 0;  ///< bDeviceClass (USB 2.0, table 9-8): 9 is a hub, 0 is told by its interfaces
};

/// "1-1.2": the bus, and the ports from its root hub outwards.
bool is_usb_port_path(std::string_view text);

/// Which device is meant: one of these ids, with that serial number and at that port where they are given.
struct UsbAddress {
    UsbIds ids;
    std::string serial;     ///< empty: any
    std::string port_path;  ///< empty: anywhere
    [[nodiscard]] bool matches(const UsbDeviceInfo& device) const;
};
/// Reads `VID:PID`, `VID:PID:SERIAL` or `VID:PID@PORT_PATH` ("16c0:05df@1-1.2"). Fails with `usage` and a sentence that
/// quotes the text.
Result<UsbAddress> parse_usb_address(std::string_view text);
/// As parse_usb_address reads it.
std::string to_string(const UsbAddress& address);

}  // namespace skyloop
