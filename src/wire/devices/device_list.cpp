#include "wire/devices/device_list.hpp"

#include <algorithm>
#include <array>

#include "base/core/text_file.hpp"
#include "detail/device_nodes.hpp"
#include "wire/usb/usb_context.hpp"

namespace skyloop {
namespace {

constexpr std::array<std::string_view, 3> node_kind_names{"serial", "hidraw", "usb"};

// Numbers by their value: 1-2 before 1-10.
bool earlier_port(const std::string& a, const std::string& b) {
    const auto numbers = [](const std::string& path) {
        std::vector<unsigned> found;
        bool inside = false;
        for (const char c : path) {
            const bool digit = c >= '0' && c <= '9';
            if (digit && !inside) found.push_back(0);
            if (digit) found.back() = found.back() * 10 + static_cast<unsigned>(c - '0');
            inside = digit;
        }
        return found;
    };
    return numbers(a) < numbers(b);
}

const DeviceNode* first_node(const DeviceEntry& device, NodeKind kind) {
    const auto found = std::find_if(device.nodes.begin(), device.nodes.end(),
                                    [kind](const DeviceNode& node) { return node.kind == kind; });
    return found == device.nodes.end() ? nullptr : &*found;
}

std::string serial_port(const DeviceEntry& device) {
    const DeviceNode* line = first_node(device, NodeKind::serial);
    if (!line) return {};
    // Devices alike have one link by their serial number between them, which leads to either.
    const std::string& link = device.usb && !device.has_own_serial() ? line->port_link : line->stable_path;
    const std::string port = "serial:" + (link.empty() ? line->path : link);
    const std::uint32_t baud = device.known ? device.known->profile->baud : 0;
    return baud == 0 ? port : port + '@' + std::to_string(baud);
}

}  // namespace

std::string_view node_kind_name(NodeKind kind) { return node_kind_names[static_cast<std::size_t>(kind)]; }

bool DeviceEntry::is_hub() const {
    constexpr std::uint8_t hub_class = 9;
    return usb && usb->device_class == hub_class;
}

bool DeviceEntry::has_own_serial() const { return usb && !usb->serial.empty() && !serial_is_shared; }

std::string DeviceEntry::title() const {
    if (known && known->bootloader && known->profile->kind != DeviceKind::bootloader)
        return known->profile->description + ", its bootloader runs";
    if (known) return known->profile->description;
    if (!usb) return "serial line of this machine";
    if (!usb->manufacturer.empty() && !usb->product.empty()) return usb->manufacturer + ' ' + usb->product;
    if (!usb->product.empty() || !usb->manufacturer.empty()) return usb->product + usb->manufacturer;
    return is_hub() ? "hub" : "it tells nothing of itself";
}

std::string_view DeviceEntry::kind_name() const {
    if (known) return known->bootloader ? "bootloader" : device_kind_name(known->profile->kind);
    if (is_hub()) return "hub";
    return usb ? "unknown" : "uart";
}

std::string DeviceEntry::port() const {
    if (!usb) return serial_port(*this);
    if (!known || known->bootloader) return {};
    const DeviceProfile& profile = *known->profile;
    if (profile.transport == DeviceTransport::serial) return serial_port(*this);
    const bool carries_bytes = profile.kind == DeviceKind::bridge || profile.kind == DeviceKind::receiver ||
                               profile.kind == DeviceKind::autopilot;
    if (!carries_bytes || profile.transport == DeviceTransport::none) return {};
    // A comma would end the serial number in the URI.
    const bool serial_names_it = has_own_serial() && usb->serial.find(',') == std::string::npos;
    const UsbAddress address =
        serial_names_it ? UsbAddress{usb->ids, usb->serial, {}} : UsbAddress{usb->ids, {}, usb->port_path};
    return std::string(device_transport_name(profile.transport)) + ':' + to_string(address);
}

DeviceEntry look_up_device(const UsbDeviceInfo& usb, std::span<const DeviceProfile> profiles,
                           const SystemFolders& folders) {
    return {usb, match_device(profiles, usb), nodes_of_usb(usb, folders)};
}

void mark_shared_serials(std::span<DeviceEntry> devices) {
    for (DeviceEntry& device : devices)
        device.serial_is_shared = std::any_of(devices.begin(), devices.end(), [&](const DeviceEntry& other) {
            return &other != &device && device.usb && other.usb && other.usb->ids == device.usb->ids &&
                   other.usb->serial == device.usb->serial;
        });
}

std::vector<DeviceEntry> own_serial_lines(const SystemFolders& folders) {
    namespace fs = std::filesystem;
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator entry(folders.sysfs / "class" / "tty", error), end; !error && entry != end;
         entry.increment(error)) {
        // The kernel's serial core tells the kind of UART; 0 is none, and pseudo-terminals and consoles have no kind.
        const std::string type = first_line_of(entry->path() / "type");
        if (!type.empty() && type != "0") names.push_back(entry->path().filename());
    }
    std::sort(names.begin(), names.end());
    std::vector<DeviceEntry> lines;
    for (const std::string& name : names)
        lines.push_back({std::nullopt, std::nullopt, {serial_node(name, folders)}});
    return lines;
}

Result<std::vector<DeviceEntry>> list_devices(std::span<const DeviceProfile> profiles, const SystemFolders& folders) {
    std::vector<DeviceEntry> all;
    std::error_code error;
    const auto context = open_usb();
    if (context) {
        const auto devices = list_usb_devices(*context);
        if (!devices) return fail(devices.error());
        for (const UsbDevice& device : *devices)
            all.push_back(look_up_device(describe(device), profiles, folders));
    } else if (std::filesystem::exists(folders.sysfs / "bus" / "usb", error)) {
        return fail(context.error());
    }
    std::stable_sort(all.begin(), all.end(), [](const DeviceEntry& a, const DeviceEntry& b) {
        return earlier_port(a.usb->port_path, b.usb->port_path);
    });
    mark_shared_serials(all);
    for (DeviceEntry& line : own_serial_lines(folders))
        all.push_back(std::move(line));
    return all;
}

}  // namespace skyloop
