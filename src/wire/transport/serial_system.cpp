#include "wire/transport/serial_system.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

#include "base/core/files.hpp"
#include "base/core/threads.hpp"

namespace skyloop::inline wire {

int SerialSystem::open(const std::filesystem::path& device) {
    return ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
}

int SerialSystem::control(int descriptor, unsigned long request, void* argument) {
    return ::ioctl(descriptor, request, argument);
}

int SerialSystem::control(int descriptor, unsigned long request, int argument) {
    return ::ioctl(descriptor, request, argument);
}

std::ptrdiff_t SerialSystem::read(int descriptor, std::uint8_t* bytes, std::size_t most) {
    return ::read(descriptor, bytes, most);
}

std::ptrdiff_t SerialSystem::write(int descriptor, ByteSpan bytes) {
    return ::write(descriptor, bytes.data(), bytes.size());
}

int SerialSystem::lock(int descriptor) { return ::flock(descriptor, LOCK_EX | LOCK_NB); }

bool SerialSystem::gone(int descriptor) {
    pollfd state{descriptor, 0, 0};
    ::poll(&state, 1, 0);
    return (state.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
}

std::int64_t SerialSystem::now_ns() { return steady_clock_ns(); }

namespace {

namespace fs = std::filesystem;

fs::path class_entry(const SerialSystem& system, const std::string& name) {
    return system.sysfs() / "class" / "tty" / name;
}

bool same_kind(const UsbIdentity& a, const UsbIdentity& b) {
    return a.vendor == b.vendor && a.product == b.product && a.interface == b.interface && a.serial == b.serial;
}

std::vector<fs::path> all_lines(const SerialSystem& system) {
    std::vector<fs::path> lines;
    for (const std::string& name : names_in(system.sysfs() / "class" / "tty"))
        lines.push_back(system.devices() / name);
    return lines;
}

bool there(const fs::path& path) {
    std::error_code error;
    return fs::exists(path, error);
}

}  // namespace

std::string tty_name(const SerialSystem& system, const fs::path& device) {
    constexpr int most_links = 40;  // as the kernel follows
    std::error_code error;
    fs::path at = fs::absolute(device, error).lexically_normal();
    for (int i = 0; i < most_links && !there(class_entry(system, at.filename())); ++i) {
        if (!fs::is_symlink(at, error)) break;
        at = (at.parent_path() / fs::read_symlink(at, error)).lexically_normal();
    }
    return at.filename();
}

std::optional<UsbIdentity> usb_identity(const SerialSystem& system, const fs::path& device) {
    std::error_code error;
    fs::path at = fs::canonical(class_entry(system, tty_name(system, device)) / "device", error);
    if (error) return std::nullopt;
    UsbIdentity identity;
    for (; at.has_relative_path(); at = at.parent_path()) {
        const std::string name = at.filename();
        if (const std::size_t colon = name.find(':'); colon != std::string::npos && identity.interface.empty())
            identity.interface = name.substr(colon + 1);
        if (!there(at / "idVendor")) continue;
        identity.vendor = first_line_of(at / "idVendor");
        identity.product = first_line_of(at / "idProduct");
        identity.serial = first_line_of(at / "serial");
        identity.port_path = name;
        return identity;
    }
    return std::nullopt;
}

std::vector<std::string> ports_beside(const SerialSystem& system, const UsbIdentity& identity) {
    std::vector<std::string> ports;
    for (const fs::path& line : all_lines(system))
        if (const auto found = usb_identity(system, line);
            found && same_kind(*found, identity) && found->port_path != identity.port_path)
            ports.push_back(found->port_path);
    return ports;
}

std::vector<fs::path> places_to_look(const SerialSystem& system, const fs::path& device,
                                     const std::optional<UsbIdentity>& identity,
                                     const std::vector<std::string>& beside) {
    if (!identity) return there(device) ? std::vector<fs::path>{device} : std::vector<fs::path>{};
    const auto may_be_it = [&](const std::optional<UsbIdentity>& found) {
        return found && same_kind(*found, *identity) &&
               std::find(beside.begin(), beside.end(), found->port_path) == beside.end();
    };
    std::vector<fs::path> same_port, elsewhere;
    for (const fs::path& line : all_lines(system)) {
        const auto found = usb_identity(system, line);
        if (!may_be_it(found) || !there(line)) continue;
        (found->port_path == identity->port_path ? same_port : elsewhere).push_back(line);
    }
    if (!same_port.empty()) return same_port;
    if (!identity->serial.empty() && elsewhere.size() == 1) return elsewhere;
    // The name is the user's own word for the device, unless it is the kernel's number.
    const bool kernels_name = there(class_entry(system, device.filename()));
    const auto named = kernels_name ? std::nullopt : usb_identity(system, device);
    if (may_be_it(named) && there(device)) return {device};
    return {};
}

}  // namespace skyloop::inline wire
