/// Which USB device a serial line belongs to, and where it is after it has been plugged in again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wire/transport/serial_system.hpp"

namespace skyloop {

/// What the kernel tells of a USB device and of its interface that is a serial line (sysfs; WIRES.md section 2).
struct UsbIdentity {
    std::string vendor, product;  ///< four hexadecimal digits each
    std::string serial;           ///< empty: it has none
    std::string port_path;        ///< bus and ports: "1-1.2"
    std::string interface;        ///< configuration and interface: "1.0"
};

/// The name that the kernel gives a serial line, "ttyUSB0", through any links; that of the file when it knows none.
std::string tty_name(const SerialSystem& system, const std::filesystem::path& device);
/// Nothing for what is not on USB.
std::optional<UsbIdentity> usb_identity(const SerialSystem& system, const std::filesystem::path& device);

/// The port paths of the devices with its ids, interface and serial number that are plugged in elsewhere.
std::vector<std::string> ports_beside(const SerialSystem& system, const UsbIdentity& identity);

/// Where a lost device may be now, the likeliest first.
///
/// What was no USB device comes back under its name. A USB device is one of the same ids and interface: with a serial
/// number, one of that number, at the same port, or the only one elsewhere (cheap adapters share one); without, one at
/// the same port, or the one that a link such as those of /dev/serial/by-id leads to.
/// @param beside ports_beside() at the loss: what was there while the lost one was is not it, wherever links lead
std::vector<std::filesystem::path> places_to_look(const SerialSystem& system, const std::filesystem::path& device,
                                                  const std::optional<UsbIdentity>& identity,
                                                  const std::vector<std::string>& beside);

}  // namespace skyloop
