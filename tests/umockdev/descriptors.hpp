/// Descriptors of the devices that the tests plug in.
#pragma once

#include <cstdint>
#include <string>

#include "base/core/bytes.hpp"
#include "wire/usb/usb_device.hpp"

namespace skyloop::mock {

/// A device as the kernel sees it. Times and addresses are the test's own affair.
struct DeviceSpec {
    UsbIds ids;
    std::string manufacturer;
    std::string product;
    std::string serial;             ///< empty: it has none
    Bytes configuration;            ///< of the configuration descriptor, whole (configuration())
    std::string port = "1";         ///< of bus 1; that of a hub, "3.2", needs the hub "3"
    std::uint8_t address = 4;       ///< a plugged-in device gets a new one each time
    std::uint8_t device_class = 0;  ///< 9: a hub
};
/// /dev/bus/usb/001/NNN.
std::string node_of(const DeviceSpec& device);
/// What `descriptors` of sysfs holds: the device's descriptor and its configuration (USB 2.0, section 9.6).
Bytes descriptors(const DeviceSpec& device);

/// `class_code` is of the interface: class, subclass, protocol.
struct InterfaceClass {
    std::uint8_t code = 0, subclass = 0, protocol = 0;
};
Bytes interface(std::uint8_t number, std::uint8_t endpoints, InterfaceClass kind);
/// Attributes: 2 bulk, 3 interrupt (USB 2.0, table 9-13).
Bytes endpoint(std::uint8_t address, std::uint8_t attributes, std::uint16_t packet);
/// `body`: interfaces with all that belongs to them.
Bytes configuration(std::uint8_t interfaces, const Bytes& body);
Bytes joined(std::initializer_list<Bytes> parts);

/// A communications device with an abstract control model, as u-blox 8 has it: notifications at 0x83, data out at 0x01
/// and in at 0x82, 64-byte packets (CDC 1.2, section 5.2.3; PSTN 1.2, section 5.3).
Bytes cdc_acm_configuration();
/// A HID device with interrupt endpoints in (0x81) and out (0x01; none for 0), packets of that size. `report_size` is
/// that of its report descriptor.
struct HidShape {
    std::uint16_t report_size = 0;
    std::uint16_t packet = 64;
    bool has_out = true;
};
Bytes hid_configuration(const HidShape& shape);

}  // namespace skyloop::mock
