/// From what a user types after --port to a wire.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "wire/transport/can_transport.hpp"
#include "wire/transport/cdc_acm_device.hpp"
#include "wire/transport/serial.hpp"
#include "wire/transport/tcp.hpp"
#include "wire/transport/transport.hpp"
#include "wire/transport/usb_bridge.hpp"

namespace skyloop::inline wire {

/// The wires of this version.
enum class WireKind { pty, serial, usb, hid, usbip, tcp, tcp_connect, rfc2217, can, file, standard_output };

/// A wire as it was asked for, not opened.
struct PortUri {
    WireKind kind = WireKind::pty;
    std::string path;  ///< the link of a pty, or empty; the path of a file
    TcpAddress address{};
    SerialAddress serial{};
    UsbBridgeAddress bridge{};  ///< of usb and hid
    CanAddress can{};
    std::optional<std::uint32_t> baud{};  ///< of tcp and tcp-connect: at which the receiver's UART begins, bit/s
};
/// "pty[:LINK]" and so on: each kind that has a name, as help texts offer it.
std::vector<std::string_view> port_shapes();
/// Fails with `usage` and a sentence that quotes the URI.
Result<PortUri> parse_port_uri(std::string_view uri);

/// Opens `pty`, `pty:LINK`, `serial:DEVICE[@BAUD][,8N1][,rtscts]`, `usb:VID:PID[:SERIAL|@PORT][,BAUD][,8N1]`, `hid:`
/// the same with [,rtscts], `usbip:[HOST:]PORT`, `tcp:[HOST:]PORT[@BAUD]`, `tcp-connect:HOST:PORT[@BAUD]`,
/// `rfc2217:[HOST:]PORT`, `dronecan:BUS` (parse_can_address()), `file:PATH` or `-` (standard output). Fails with
/// `usage` for anything else, with `outside` when the system refuses; the sentence names the URI, the address, the
/// device or the path.
/// @param face of the device that a USB/IP wire shows
/// @param buses of the run, so that several nodes share one; null: a bus of its own
Result<std::unique_ptr<Transport>> open_transport(std::string_view uri, const UsbFace& face = {},
                                                  CanBuses* buses = nullptr);

}  // namespace skyloop::inline wire
