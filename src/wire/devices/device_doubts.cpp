// What stands in the way of using a device, and what helps.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "base/core/files.hpp"
#include "base/core/number_text.hpp"
#include "wire/devices/device_list.hpp"

namespace skyloop::inline wire {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view install_rules =
    "'skyloop devices --udev-rules' prints a file for /etc/udev/rules.d, with how to install it";

// The nodes by which this device is used: permission for the others is nobody's concern.
std::vector<const DeviceNode*> nodes_in_use(const DeviceEntry& device) {
    const auto of_kind = [&](NodeKind kind) {
        std::vector<const DeviceNode*> found;
        for (const DeviceNode& node : device.nodes)
            if (node.kind == kind) found.push_back(&node);
        return found;
    };
    if (!device.usb) return of_kind(NodeKind::serial);
    if (device.known->profile->transport == DeviceTransport::serial) return of_kind(NodeKind::serial);
    // Where a HID device has no node of its own it is reached past the kernel.
    if (device.known->profile->transport == DeviceTransport::hid)
        if (auto reports = of_kind(NodeKind::hidraw); !reports.empty()) return reports;
    return of_kind(NodeKind::usb);
}

std::string permission_doubt(const DeviceNode& node, const DeviceEntry& device) {
    constexpr std::uint32_t group_may_use = 0060;
    const std::string what =
        fmt::format("no permission for {} ({}:{}, mode {:o})", node.path, node.owner, node.group, node.mode);
    if ((node.mode & group_may_use) == group_may_use && node.group != "root")
        return fmt::format("{}: 'sudo usermod -aG {} $USER', then log in again", what, node.group);
    if (!device.usb) return fmt::format("{}: 'sudo chmod a+rw {}' until the next start", what, node.path);
    return fmt::format("{}: a udev rule for {} gives it: {}", what, to_string(device.usb->ids), install_rules);
}

void add_name_doubt(const DeviceEntry& device, const std::vector<const DeviceNode*>& nodes,
                    std::vector<std::string>& doubts) {
    if (!device.serial_is_shared || nodes.empty() || nodes.front()->kind != NodeKind::serial) return;
    if (const DeviceNode& line = *nodes.front(); line.port_link.empty())
        doubts.push_back(
            fmt::format("a device like it is plugged in and no link in /dev/serial/by-path tells the two "
                        "apart: {} may be the other one when they are plugged in again",
                        line.path));
}

bool modem_manager_runs(const SystemFolders& folders) {
    std::error_code error;
    for (fs::directory_iterator entry(folders.processes, error), end; !error && entry != end; entry.increment(error)) {
        const std::string name = entry->path().filename();
        if (!name.empty() && name.front() >= '0' && name.front() <= '9' &&
            first_line_of(entry->path() / "comm") == "ModemManager")
            return true;
    }
    return false;
}

// What udevd keeps of a device with a number stands in run/udev/data/c189:3.
bool modem_manager_ignores(const UsbDeviceInfo& usb, const SystemFolders& folders) {
    const std::string number = first_line_of(sysfs_of_usb(folders, usb.port_path) / "dev");
    if (number.empty()) return false;
    std::ifstream properties(folders.run / "udev" / "data" / ("c" + number));
    for (std::string line; std::getline(properties, line);)
        if (line == "E:ID_MM_DEVICE_IGNORE=1") return true;
    return false;
}

void add_modem_doubt(const DeviceEntry& device, const SystemFolders& folders, std::vector<std::string>& doubts) {
    const auto probed = std::find_if(device.nodes.begin(), device.nodes.end(),
                                     [](const DeviceNode& node) { return node.takes_modem_commands; });
    if (probed == device.nodes.end() || !modem_manager_runs(folders) || modem_manager_ignores(*device.usb, folders))
        return;
    doubts.push_back(
        fmt::format("ModemManager runs and speaks to {} when it is plugged in, which looks like a modem: a udev rule "
                    "keeps it away: {}",
                    probed->path, install_rules));
}

void add_latency_doubt(const DeviceEntry& device, const SystemFolders& folders, std::vector<std::string>& doubts) {
    const std::uint32_t wanted = device.known->profile->latency_timer_ms;
    if (wanted == 0) return;
    for (const DeviceNode& node : device.nodes) {
        const std::string text = first_line_of(folders.sysfs / "class" / "tty" / fs::path(node.path).filename() /
                                               "device" / "latency_timer");
        const auto value = number_in<std::uint32_t>(text).value_or(0);
        if (node.kind == NodeKind::serial && value > wanted)
            doubts.push_back(
                fmt::format("{} hands bytes on after up to {} ms: skyloop sets its latency_timer to {} ms on "
                            "a line that it opens; a udev rule does it for every program: {}",
                            node.path, value, wanted, install_rules));
    }
}

}  // namespace

std::vector<std::string> device_doubts(const DeviceEntry& device, const SystemFolders& folders) {
    std::vector<std::string> doubts;
    if (device.usb && !device.known) return doubts;
    if (device.known && device.known->bootloader) {
        doubts.emplace_back("its bootloader runs: its serial line takes firmware, not data");
        return doubts;
    }
    const std::vector<const DeviceNode*> nodes = nodes_in_use(device);
    if (device.known && nodes.empty() && device.known->profile->transport == DeviceTransport::serial)
        doubts.emplace_back(
            "the kernel has made no serial line of it: its driver is not there or another program holds it");
    for (const DeviceNode* node : nodes) {
        if (!node->exists)
            doubts.push_back(fmt::format("{} is not there: udevd does not run, or this is a container", node->path));
        else if (!node->usable)
            doubts.push_back(permission_doubt(*node, device));
    }
    if (!device.known) return doubts;
    add_name_doubt(device, nodes, doubts);
    add_modem_doubt(device, folders, doubts);
    add_latency_doubt(device, folders, doubts);
    return doubts;
}

}  // namespace skyloop::inline wire
