/// The CP2110 bridge: a UART behind HID reports (Silicon Labs, AN434).
#pragma once

#include <memory>

#include "base/core/result.hpp"
#include "wire/hid/hid_device.hpp"
#include "wire/usb/serial_bridge.hpp"

namespace skyloop::inline wire {

/// The feature report that sets the UART (AN434, "Get/Set UART Config"): its id, the speed with the most significant
/// byte first, parity (1: odd, 2: even), flow control, data bits less 5, stop bits (1: long).
Bytes cp2110_uart_config(const BridgeLine& line);

/// Opens the bridge by whichever backend of hidapi reaches it, sets its UART, enables it and purges its FIFOs; when it
/// is closed the UART has the settings that it had before. Fails with `outside`.
Result<std::unique_ptr<SerialBridge>> open_cp2110(const UsbAddress& address, const BridgeLine& line);
/// Through a device that is open.
Result<std::unique_ptr<SerialBridge>> open_cp2110(HidDevice device, const BridgeLine& line);

}  // namespace skyloop::inline wire
