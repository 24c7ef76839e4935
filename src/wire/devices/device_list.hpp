/// What is plugged into this machine: each device with its profile, its nodes, and what stands in the way of using it.
/// The files under /dev that belong to a device, by the paths of sysfs.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "wire/devices/device_profile.hpp"
#include "wire/usb/usb_watch.hpp"

namespace skyloop::inline wire {

/// Where the system tells of devices; others than these are for tests.
struct SystemFolders {
    std::filesystem::path sysfs = "/sys";
    std::filesystem::path devices = "/dev";
    std::filesystem::path run = "/run";
    std::filesystem::path processes = "/proc";
};

/// What a node is.
enum class NodeKind {
    serial,  ///< a serial line, /dev/ttyACM0
    hidraw,  ///< HID reports, /dev/hidraw0
    usb,     ///< the device itself, for libusb
};
std::string_view node_kind_name(NodeKind kind);

/// One file under /dev by which a device is used.
struct DeviceNode {
    NodeKind kind = NodeKind::serial;
    std::string path;
    std::string interface;    ///< configuration and interface, "1.0"; empty: the whole device, or not on USB
    std::string driver;       ///< of the kernel, "cdc_acm"; empty: not told
    std::string stable_path;  ///< a link that stays when numbers change, in /dev/serial/by-id; empty: none
    std::string port_link;    ///< a link to what is plugged into its port, in /dev/serial/by-path; empty: none
    bool exists = false;
    bool usable = false;     ///< this process may read and write it
    std::string owner;       ///< user; the number where it has no name
    std::string group;       ///< likewise
    std::uint32_t mode = 0;  ///< permission bits
    bool takes_modem_commands =
        false;  ///< it says that it understands a modem's (CDC PSTN 1.2, table 17: protocol 1 to 6)
};

/// One device of the machine.
struct DeviceEntry {
    std::optional<UsbDeviceInfo> usb;  ///< none: a serial line of the machine itself
    std::optional<DeviceMatch> known;  ///< its profile stays the caller's
    std::vector<DeviceNode> nodes;     ///< serial lines by interface, then HID nodes, then the device's own
    bool serial_is_shared = false;     ///< another device that is plugged in has its ids and serial number, too

    [[nodiscard]] bool is_hub() const;
    /// It has a serial number, and no other device that is plugged in has the same.
    [[nodiscard]] bool has_own_serial() const;
    /// Its profile's description, else what it tells of itself.
    [[nodiscard]] std::string title() const;
    /// "autopilot" and so on, "hub", "uart" for a line of the machine itself, or "unknown".
    [[nodiscard]] std::string_view kind_name() const;
    /// What `--port` takes for it, "serial:/dev/ttyUSB0"; empty when nothing does, or its bootloader runs.
    [[nodiscard]] std::string port() const;
};

/// Looks up profile and nodes of a USB device. One that is gone meanwhile has no nodes.
DeviceEntry look_up_device(const UsbDeviceInfo& usb, std::span<const DeviceProfile> profiles,
                           const SystemFolders& folders = {});
/// Says of each device whether its serial number is that of another one in the list, as of many cheap devices.
void mark_shared_serials(std::span<DeviceEntry> devices);
/// Serial lines of the machine itself with a UART behind them: ttyAMA0, ttyS0, by name.
std::vector<DeviceEntry> own_serial_lines(const SystemFolders& folders = {});
/// USB devices by port path, then the machine's own lines. Where the system has no USB the latter alone. Fails with
/// `outside` when USB is there and cannot be listed.
Result<std::vector<DeviceEntry>> list_devices(std::span<const DeviceProfile> profiles,
                                              const SystemFolders& folders = {});

/// What stands in the way of using a known device, a sentence each, with what helps: no permission, no node, its
/// bootloader, no name that tells it from its like, ModemManager, a long latency timer.
std::vector<std::string> device_doubts(const DeviceEntry& device, const SystemFolders& folders = {});

/// A known device that was plugged in or taken out.
struct DeviceNews {
    bool arrived;
    DeviceEntry device;
};

/// Tells of devices that come and go; each with its nodes, which the kernel makes a little later than the device.
class DeviceWatch {
public:
    /// @param profiles stay the caller's
    DeviceWatch(UsbWatch watch, std::span<const DeviceProfile> profiles, SystemFolders folders = {})
        : watch_(std::move(watch)), profiles_(profiles), folders_(std::move(folders)) {}
    /// What has happened since the last call, in order, at the first one all that is there. Waits for something to
    /// happen, about `longest` at most. Fails with `outside`.
    Result<std::vector<DeviceNews>> wait(std::chrono::milliseconds longest);

private:
    struct Settling {
        DeviceEntry device;
        std::chrono::steady_clock::time_point until;
    };
    void take(const UsbChange& change, std::vector<DeviceNews>& news);
    void settle(std::vector<DeviceNews>& news);
    DeviceEntry take_known(const UsbDeviceInfo& usb);

    UsbWatch watch_;
    std::span<const DeviceProfile> profiles_;
    SystemFolders folders_;
    std::vector<Settling> settling_;  // have come, and wait for their nodes
    std::vector<DeviceEntry> there_;  // have been told of
};

/// Where sysfs tells of the device at this port path.
std::filesystem::path sysfs_of_usb(const SystemFolders& folders, const std::string& port_path);
/// Of the device at the port of `usb`, serial lines first.
std::vector<DeviceNode> nodes_of_usb(const UsbDeviceInfo& usb, const SystemFolders& folders);
/// A serial line by its name, "ttyAMA0", without interface and driver.
DeviceNode serial_node(const std::string& name, const SystemFolders& folders);

}  // namespace skyloop::inline wire
