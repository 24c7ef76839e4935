/// How a USB device is named: by what it is, or by where it is plugged in.
/// libusb, owned: its session, its devices, their handles, and its words for what went wrong.
#pragma once

#include <chrono>
#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"

struct libusb_context;
struct libusb_device;
struct libusb_device_handle;

namespace skyloop::inline wire {

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

/// A session of libusb. Devices and handles keep it alive.
using UsbContext = std::shared_ptr<libusb_context>;
/// A device that was plugged in when it was listed; held by count.
using UsbDevice = std::shared_ptr<libusb_device>;
/// An opened device; closed with the last owner.
using UsbHandle = std::shared_ptr<libusb_device_handle>;

/// Fails with `outside` where the system has no USB to offer.
Result<UsbContext> open_usb();
/// What is plugged in, in the order of libusb. Fails with `outside`.
Result<std::vector<UsbDevice>> list_usb_devices(const UsbContext& context);
/// Ids and port path of a device; the texts as sysfs has them, which needs no permission, or else, where the device may
/// be opened, as it tells them itself.
UsbDeviceInfo describe(const UsbDevice& device);
/// The first device of that address. Fails with `outside`: no such device, and what is there of the same ids.
Result<UsbDevice> find_usb_device(const UsbContext& context, const UsbAddress& address);
/// Fails with `outside`; without permission the sentence names the node and what would give it.
Result<UsbHandle> open_usb_device(const UsbContext& context, const UsbDevice& device);

/// "no such device (it may have been disconnected)" and the like, of a negative result of libusb.
std::string usb_error_text(int result);

}  // namespace skyloop::inline wire
