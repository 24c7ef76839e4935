#include <algorithm>

#include "wire/devices/device_list.hpp"

namespace skyloop::inline wire {
namespace {

using DeviceClock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds longest_settling{1000};  // a driver that is loaded for it may take that long
constexpr std::chrono::milliseconds settling_step{50};

// Whether the nodes are there that a device of its profile has.
bool has_its_nodes(const DeviceEntry& device) {
    if (!device.known || device.known->bootloader) return true;
    const DeviceTransport transport = device.known->profile->transport;
    if (transport != DeviceTransport::serial && transport != DeviceTransport::hid) return true;
    const NodeKind wanted = transport == DeviceTransport::serial ? NodeKind::serial : NodeKind::hidraw;
    return std::any_of(device.nodes.begin(), device.nodes.end(),
                       [wanted](const DeviceNode& node) { return node.kind == wanted && node.exists; });
}

bool is_same(const DeviceEntry& device, const UsbDeviceInfo& usb) {
    return device.usb->port_path == usb.port_path && device.usb->node == usb.node && device.usb->ids == usb.ids;
}

}  // namespace

void DeviceWatch::settle(std::vector<DeviceNews>& news) {
    const auto now = DeviceClock::now();
    for (auto waiting = settling_.begin(); waiting != settling_.end();) {
        DeviceEntry& device = waiting->device;
        const bool expired = now >= waiting->until;
        device = look_up_device(*device.usb, profiles_, folders_);
        if (!expired && !has_its_nodes(device)) {
            ++waiting;
            continue;
        }
        there_.push_back(std::move(device));
        mark_shared_serials(there_);
        news.push_back({true, there_.back()});
        waiting = settling_.erase(waiting);
    }
}

DeviceEntry DeviceWatch::take_known(const UsbDeviceInfo& usb) {
    const auto known =
        std::find_if(there_.begin(), there_.end(), [&](const DeviceEntry& device) { return is_same(device, usb); });
    if (known == there_.end()) return {usb, match_device(profiles_, usb), {}};
    DeviceEntry device = std::move(*known);
    there_.erase(known);
    return device;
}

void DeviceWatch::take(const UsbChange& change, std::vector<DeviceNews>& news) {
    if (change.arrived) {
        settling_.push_back(
            {{change.device, match_device(profiles_, change.device), {}}, DeviceClock::now() + longest_settling});
        return;
    }
    const auto waiting = std::find_if(settling_.begin(), settling_.end(), [&](const Settling& settling) {
        return is_same(settling.device, change.device);
    });
    if (waiting != settling_.end()) {  // gone before its nodes came
        news.push_back({true, waiting->device});
        settling_.erase(waiting);
    }
    news.push_back({false, take_known(change.device)});
}

Result<std::vector<DeviceNews>> DeviceWatch::wait(std::chrono::milliseconds longest) {
    const auto deadline = DeviceClock::now() + longest;
    std::vector<DeviceNews> news;
    for (;;) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - DeviceClock::now());
        const auto step = settling_.empty() ? left : std::min(left, settling_step);
        const auto changes = watch_.wait(std::max(step, std::chrono::milliseconds(0)));
        if (!changes) return fail(changes.error());
        for (const UsbChange& change : *changes)
            take(change, news);
        settle(news);
        if (!news.empty() || DeviceClock::now() >= deadline) return news;
    }
}

}  // namespace skyloop::inline wire
