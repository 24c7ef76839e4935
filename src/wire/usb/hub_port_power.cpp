#include "wire/usb/hub_port_power.hpp"

#include <fmt/format.h>
#include <libusb-1.0/libusb.h>

#include <array>
#include <utility>

#include "base/core/number_text.hpp"

namespace skyloop::inline wire {
namespace {

constexpr unsigned hub_patience_ms = 1000;
constexpr std::uint8_t hub_descriptor_type = 0x29, superspeed_hub_descriptor_type = 0x2A;
constexpr std::uint16_t port_power_feature = 8;  // USB 2.0, table 11-17
constexpr unsigned port_power_bit = 8, superspeed_port_power_bit = 9;
constexpr std::uint8_t to_port = 0x23, from_port = 0xA3, from_hub = 0xA0;

struct PortPlace {
    std::string hub;  // as UsbDeviceInfo::port_path has it
    int port = 0;
};

// "1-1.4" is port 4 of 1-1; "1-2" is port 2 of usb1.
std::optional<PortPlace> port_place(const std::string& path) {
    if (!is_usb_port_path(path)) return std::nullopt;
    const std::size_t dot = path.rfind('.'), dash = path.find('-');
    const std::size_t last = dot == std::string::npos ? dash : dot;
    PortPlace place;
    place.hub = dot == std::string::npos ? "usb" + path.substr(0, dash) : path.substr(0, dot);
    place.port = number_in<int>(std::string_view(path).substr(last + 1)).value_or(0);
    constexpr int most_ports = 255;  // bNbrPorts is one byte
    if (place.port < 1 || place.port > most_ports) return std::nullopt;
    return place;
}

tl::unexpected<Error> no_hub_port(const std::string& port_path, const std::string& why) {
    return fail(ErrorCode::outside, fmt::format("cannot switch the USB port {}: {}", port_path, why));
}

Result<HubPorts> ask_ports(libusb_device_handle* hub, bool superspeed, const std::string& port_path) {
    std::array<std::uint8_t, 64> answer{};
    const auto type = superspeed ? superspeed_hub_descriptor_type : hub_descriptor_type;
    const int size =
        libusb_control_transfer(hub, from_hub, LIBUSB_REQUEST_GET_DESCRIPTOR, static_cast<std::uint16_t>(type << 8), 0,
                                answer.data(), static_cast<std::uint16_t>(answer.size()), hub_patience_ms);
    if (size < 0)
        return no_hub_port(port_path, "what is there is no hub, or does not describe itself: " + usb_error_text(size));
    const auto ports = hub_ports(ByteSpan(answer).first(static_cast<std::size_t>(size)));
    if (!ports) return no_hub_port(port_path, "the hub does not describe itself as the standard wants");
    return *ports;
}

}  // namespace

std::optional<HubPorts> hub_ports(ByteSpan descriptor) {
    constexpr std::size_t shortest = 7;
    if (descriptor.size() < shortest || descriptor[0] < shortest) return std::nullopt;
    if (descriptor[1] != hub_descriptor_type && descriptor[1] != superspeed_hub_descriptor_type) return std::nullopt;
    constexpr int power_mode = 3, one_by_one = 1;  // the two low bits of wHubCharacteristics
    return HubPorts{descriptor[2], (descriptor[3] & power_mode) == one_by_one};
}

Result<HubPort> HubPort::open(const std::string& port_path) {
    const auto place = port_place(port_path);
    if (!place)
        return fail(ErrorCode::usage,
                    fmt::format("'{}' is no port of a USB hub; expected bus and ports, such as 1-1.4", port_path));
    const auto context = open_usb();
    if (!context) return fail(context.error());
    const auto devices = list_usb_devices(*context);
    if (!devices) return fail(devices.error());
    for (const UsbDevice& device : *devices) {
        UsbDeviceInfo info = describe(device);
        if (info.port_path != place->hub) continue;
        auto handle = open_usb_device(*context, device);
        if (!handle) return fail(handle.error());
        libusb_device_descriptor descriptor{};
        libusb_get_device_descriptor(device.get(), &descriptor);
        const bool superspeed = descriptor.bcdUSB >= 0x0300;
        const auto ports = ask_ports(handle->get(), superspeed, port_path);
        if (!ports) return fail(ports.error());
        if (place->port > ports->count)
            return no_hub_port(port_path, fmt::format("the hub at {} has {} ports", place->hub, ports->count));
        if (!ports->switched_one_by_one)
            return no_hub_port(port_path,
                               fmt::format("the hub {} at {} does not switch the power of its ports one by one",
                                           to_string(info.ids), place->hub));
        return HubPort(std::move(*handle), std::move(info), place->port, superspeed);
    }
    return no_hub_port(port_path, fmt::format("there is no hub at {}", place->hub));
}

Result<void> HubPort::set_power(bool on) {
    const std::uint8_t request = on ? LIBUSB_REQUEST_SET_FEATURE : LIBUSB_REQUEST_CLEAR_FEATURE;
    const int result = libusb_control_transfer(hub_.get(), to_port, request, port_power_feature,
                                               static_cast<std::uint16_t>(port_), nullptr, 0, hub_patience_ms);
    if (result < 0)
        return fail(ErrorCode::outside, fmt::format("{}: its power cannot be switched {}: {}", description(),
                                                    on ? "on" : "off", usb_error_text(result)));
    return {};
}

Result<bool> HubPort::powered() {
    std::array<std::uint8_t, 4> status{};
    const int size =
        libusb_control_transfer(hub_.get(), from_port, LIBUSB_REQUEST_GET_STATUS, 0, static_cast<std::uint16_t>(port_),
                                status.data(), status.size(), hub_patience_ms);
    if (size != static_cast<int>(status.size()))
        return fail(ErrorCode::outside, fmt::format("{}: its status cannot be read: {}", description(),
                                                    size < 0 ? usb_error_text(size) : "the answer is too short"));
    const unsigned word = status[0] | static_cast<unsigned>(status[1]) << 8;
    return (word >> (superspeed_ ? superspeed_port_power_bit : port_power_bit) & 1U) != 0;
}

std::string HubPort::description() const {
    return fmt::format("port {} of the hub {} at {}", port_, to_string(info_.ids), info_.port_path);
}

}  // namespace skyloop::inline wire
