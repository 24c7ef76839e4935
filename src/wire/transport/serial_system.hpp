/// What a serial line needs of the operating system, small enough to be played by a test.
/// Which USB device a serial line belongs to, and where it is after it has been plugged in again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"

namespace skyloop::inline wire {

/// The system calls of a serial line and the two folders that tell of devices. Results and `errno` are those of the
/// calls; descriptors are real ones. Calls come from the loop and, while a lost device is looked for, from one other
/// thread.
class SerialSystem {
public:
    virtual ~SerialSystem() = default;
    /// open(2) for reading and writing, without waiting and without becoming its controlling process.
    virtual int open(const std::filesystem::path& device);
    /// ioctl(2) with a pointer, or null.
    virtual int control(int descriptor, unsigned long request, void* argument);
    /// ioctl(2) with a number.
    virtual int control(int descriptor, unsigned long request, int argument);
    virtual std::ptrdiff_t read(int descriptor, std::uint8_t* bytes, std::size_t most);
    virtual std::ptrdiff_t write(int descriptor, ByteSpan bytes);
    /// flock(2), exclusive and without waiting.
    virtual int lock(int descriptor);
    /// The device has hung up or is gone, as poll(2) tells.
    virtual bool gone(int descriptor);
    /// Of a clock that never jumps (CLOCK_MONOTONIC), ns.
    virtual std::int64_t now_ns();
    /// Where device nodes are.
    [[nodiscard]] virtual std::filesystem::path devices() const { return "/dev"; }
    /// Where the kernel tells of devices (sysfs).
    [[nodiscard]] virtual std::filesystem::path sysfs() const { return "/sys"; }
};

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

}  // namespace skyloop::inline wire
