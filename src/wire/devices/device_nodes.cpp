#include "detail/device_nodes.hpp"
#include "base/core/text_file.hpp"

#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <functional>

namespace skyloop {
namespace {

namespace fs = std::filesystem;

// The names in a folder, sorted; none when it is not there, or goes while it is read.
std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        names.push_back(entry->path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

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

}  // namespace skyloop
