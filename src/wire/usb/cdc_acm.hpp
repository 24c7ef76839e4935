/// USB serial devices without the kernel's driver: the host's side of the abstract control model, over libusb.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "wire/usb/serial_bridge.hpp"
#include "wire/usb/usb_device.hpp"

namespace skyloop::inline wire {

/// The two interfaces that a union joins (CDC 1.2, section 5.2.3.2).
struct CdcUnion {
    std::uint8_t control = 0;
    std::uint8_t data = 0;  ///< the first subordinate one
    bool operator==(const CdcUnion&) const = default;
};
/// Looks through the class-specific descriptors of an interface, as they lie behind it. Nothing: there is no union, or
/// the bytes are no descriptors.
std::optional<CdcUnion> read_cdc_union(ByteSpan descriptors);

/// Where a serial device takes its requests and its data.
struct CdcAcmShape {
    std::optional<std::uint8_t> control_interface;  ///< nothing: it has none, only bulk endpoints
    std::uint8_t data_interface = 0;
    std::uint8_t bulk_in = 0;
    std::uint8_t bulk_out = 0;
    std::uint16_t out_packet = 64;  ///< bytes
};
/// The first abstract control model of the device, by its descriptors; without one the first interface with bulk
/// endpoints of both directions that is no mass storage. Fails with `outside`: there is neither.
Result<CdcAcmShape> cdc_acm_shape(const UsbDevice& device);

/// Takes the device from the kernel's driver, sets the line, and asserts DTR and RTS. When it is closed the driver has
/// it back. Fails with `outside`: not there, no permission, held by another program, no serial device.
Result<std::unique_ptr<SerialBridge>> open_cdc_acm(const UsbAddress& address, const BridgeLine& line);

}  // namespace skyloop::inline wire
