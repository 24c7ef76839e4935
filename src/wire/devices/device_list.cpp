#include "wire/devices/device_list.hpp"

#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <functional>

#include "base/core/files.hpp"
#include "wire/usb/usb_device.hpp"

namespace skyloop::inline wire {
namespace {

namespace fs = std::filesystem;

std::string user_name(uid_t user) {
    std::array<char, 4096> text{};
    passwd entry{}, *found = nullptr;
    if (::getpwuid_r(user, &entry, text.data(), text.size(), &found) == 0 && found) return found->pw_name;
    return std::to_string(user);
}

std::string group_name(gid_t group) {
    std::array<char, 16384> text{};  // lists its members
    ::group entry{}, *found = nullptr;
    if (::getgrgid_r(group, &entry, text.data(), text.size(), &found) == 0 && found) return found->gr_name;
    return std::to_string(group);
}

DeviceNode node_at(NodeKind kind, const fs::path& path) {
    DeviceNode node;
    node.kind = kind;
    node.path = path;
    struct stat status {};
    if (::stat(node.path.c_str(), &status) != 0) return node;
    node.exists = true;
    node.usable = ::access(node.path.c_str(), R_OK | W_OK) == 0;
    node.owner = user_name(status.st_uid);
    node.group = group_name(status.st_gid);
    node.mode = status.st_mode & 0777u;
    return node;
}

std::string link_to(const fs::path& folder, const std::string& name) {
    for (const std::string& link : names_in(folder)) {
        std::error_code error;
        const fs::path target = fs::read_symlink(folder / link, error);
        if (!error && target.filename() == name) return folder / link;
    }
    return {};
}

std::string driver_of(const fs::path& interface) {
    std::error_code error;
    return fs::read_symlink(interface / "driver", error).filename();
}

// CDC, abstract control model, protocols of V.250 and of mobile telephones.
bool takes_modem_commands(const fs::path& interface) {
    const std::string protocol = first_line_of(interface / "bInterfaceProtocol");
    return first_line_of(interface / "bInterfaceClass") == "02" &&
           first_line_of(interface / "bInterfaceSubClass") == "02" && protocol >= "01" && protocol <= "06";
}

// Serial lines of an interface: 1-2:1.0/tty/ttyACM0, and behind a bridge 1-2:1.0/ttyUSB0/tty/ttyUSB0.
std::vector<std::string> lines_of(const fs::path& interface) {
    std::vector<std::string> lines = names_in(interface / "tty");
    for (const std::string& port : names_in(interface)) {
        if (!port.starts_with("ttyUSB")) continue;
        const std::vector<std::string> inner = names_in(interface / port / "tty");
        lines.insert(lines.end(), inner.begin(), inner.end());
    }
    return lines;
}

// 1-3:1.0/0003:16C0:05DF.0001/hidraw/hidraw0
std::vector<std::string> reports_of(const fs::path& interface) {
    std::vector<std::string> nodes;
    for (const std::string& hid : names_in(interface)) {
        if (std::count(hid.begin(), hid.end(), ':') != 2) continue;  // bus:vendor:product.number
        const std::vector<std::string> inner = names_in(interface / hid / "hidraw");
        nodes.insert(nodes.end(), inner.begin(), inner.end());
    }
    return nodes;
}

void add_nodes_of_interface(const fs::path& interface, const SystemFolders& folders, std::vector<DeviceNode>& nodes) {
    const std::string name = interface.filename();
    const auto finish = [&](DeviceNode node) {
        node.interface = name.substr(name.find(':') + 1);
        node.driver = driver_of(interface);
        nodes.push_back(std::move(node));
    };
    for (const std::string& line : lines_of(interface)) {
        DeviceNode node = serial_node(line, folders);
        node.takes_modem_commands = takes_modem_commands(interface);
        finish(std::move(node));
    }
    for (const std::string& report : reports_of(interface))
        finish(node_at(NodeKind::hidraw, folders.devices / report));
}

}  // namespace

fs::path sysfs_of_usb(const SystemFolders& folders, const std::string& port_path) {
    return folders.sysfs / "bus" / "usb" / "devices" / port_path;
}

DeviceNode serial_node(const std::string& name, const SystemFolders& folders) {
    DeviceNode node = node_at(NodeKind::serial, folders.devices / name);
    node.stable_path = link_to(folders.devices / "serial" / "by-id", name);
    node.port_link = link_to(folders.devices / "serial" / "by-path", name);
    return node;
}

std::vector<DeviceNode> nodes_of_usb(const UsbDeviceInfo& usb, const SystemFolders& folders) {
    const fs::path device = sysfs_of_usb(folders, usb.port_path);
    std::vector<DeviceNode> nodes;
    for (const std::string& name : names_in(device))
        if (name.starts_with(usb.port_path + ":")) add_nodes_of_interface(device / name, folders, nodes);
    std::stable_sort(nodes.begin(), nodes.end(),
                     [](const DeviceNode& a, const DeviceNode& b) { return a.kind < b.kind; });
    // libusb tells the node under /dev.
    const fs::path own = fs::path(usb.node).lexically_relative("/dev");
    if (!usb.node.empty() && !own.empty()) nodes.push_back(node_at(NodeKind::usb, folders.devices / own));
    return nodes;
}

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
    const fs::path terminals = folders.sysfs / "class" / "tty";
    std::vector<DeviceEntry> lines;
    for (const std::string& name : names_in(terminals)) {
        // The kernel's serial core tells the kind of UART; 0 is none, and pseudo-terminals and consoles have no kind.
        const std::string type = first_line_of(terminals / name / "type");
        if (!type.empty() && type != "0") lines.push_back({std::nullopt, std::nullopt, {serial_node(name, folders)}});
    }
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

}  // namespace skyloop::inline wire
