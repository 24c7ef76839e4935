#include "wire/usb/usb_device.hpp"

#include <fmt/format.h>
#include <libusb-1.0/libusb.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "base/core/files.hpp"
#include "base/core/number_text.hpp"

namespace skyloop::inline wire {
namespace {

constexpr std::size_t id_digits = 4;
constexpr std::size_t ids_size = 2 * id_digits + 1;

}  // namespace

bool is_usb_port_path(std::string_view text) {
    const std::size_t dash = text.find('-');
    if (dash == 0 || dash == std::string_view::npos || dash + 1 == text.size()) return false;
    const auto digits = [](std::string_view part) {
        return !part.empty() && std::all_of(part.begin(), part.end(), [](char c) { return c >= '0' && c <= '9'; });
    };
    if (!digits(text.substr(0, dash))) return false;
    for (std::string_view rest = text.substr(dash + 1);;) {
        const std::size_t dot = rest.find('.');
        if (!digits(rest.substr(0, dot))) return false;
        if (dot == std::string_view::npos) return true;
        rest = rest.substr(dot + 1);
    }
}

std::string to_string(UsbIds ids) { return fmt::format("{:04x}:{:04x}", ids.vendor, ids.product); }

std::optional<UsbIds> parse_usb_ids(std::string_view text) {
    if (text.size() != ids_size || text[id_digits] != ':') return std::nullopt;
    const auto vendor = hexadecimal_number_in<std::uint16_t>(text.substr(0, id_digits));
    const auto product = hexadecimal_number_in<std::uint16_t>(text.substr(id_digits + 1));
    if (!vendor || !product) return std::nullopt;
    return UsbIds{*vendor, *product};
}

bool UsbAddress::matches(const UsbDeviceInfo& device) const {
    return device.ids == ids && (serial.empty() || device.serial == serial) &&
           (port_path.empty() || device.port_path == port_path);
}

Result<UsbAddress> parse_usb_address(std::string_view text) {
    const auto ids = parse_usb_ids(text.substr(0, ids_size));
    const std::string_view rest = ids ? text.substr(ids_size) : std::string_view();
    if (ids && rest.empty()) return UsbAddress{*ids, {}, {}};
    if (ids && rest.size() > 1 && rest.front() == ':') return UsbAddress{*ids, std::string(rest.substr(1)), {}};
    if (ids && rest.front() == '@' && is_usb_port_path(rest.substr(1)))
        return UsbAddress{*ids, {}, std::string(rest.substr(1))};
    return fail(ErrorCode::usage,
                fmt::format("'{}' names no USB device; expected VID:PID, VID:PID:SERIAL or VID:PID@PORT, such as "
                            "1546:01a8 or 1546:01a8@1-1.2",
                            text));
}

std::string to_string(const UsbAddress& address) {
    if (!address.serial.empty()) return to_string(address.ids) + ':' + address.serial;
    if (!address.port_path.empty()) return to_string(address.ids) + '@' + address.port_path;
    return to_string(address.ids);
}

namespace {

std::string port_path_of(libusb_device* device) {
    constexpr int deepest = 7;  // tiers of hubs (USB 2.0, section 4.1.1)
    std::array<std::uint8_t, deepest> ports{};
    const int bus = libusb_get_bus_number(device);
    const int count = libusb_get_port_numbers(device, ports.data(), deepest);
    if (count <= 0) return fmt::format("usb{}", bus);
    return fmt::format("{}-{}", bus, fmt::join(ports.begin(), ports.begin() + count, "."));
}

std::string node_of(libusb_device* device) {
    return fmt::format("/dev/bus/usb/{:03}/{:03}", libusb_get_bus_number(device), libusb_get_device_address(device));
}

std::string attribute(const std::string& port_path, const char* name) {
    return first_line_of(std::filesystem::path("/sys/bus/usb/devices") / port_path / name);
}

std::string text_descriptor(libusb_device_handle* handle, std::uint8_t index) {
    constexpr int longest = 256;  // of a string descriptor: its size is one byte
    std::array<unsigned char, longest> text{};
    if (index == 0) return {};
    const int size = libusb_get_string_descriptor_ascii(handle, index, text.data(), longest);
    return size <= 0 ? std::string() : std::string(text.begin(), text.begin() + size);
}

void ask_device(const UsbDevice& device, const libusb_device_descriptor& descriptor, UsbDeviceInfo& info) {
    libusb_device_handle* handle = nullptr;
    if (libusb_open(device.get(), &handle) != LIBUSB_SUCCESS) return;
    info.manufacturer = text_descriptor(handle, descriptor.iManufacturer);
    info.product = text_descriptor(handle, descriptor.iProduct);
    info.serial = text_descriptor(handle, descriptor.iSerialNumber);
    libusb_close(handle);
}

}  // namespace

std::string usb_error_text(int result) {
    switch (result) {
        case LIBUSB_ERROR_ACCESS:
            return "no permission";
        case LIBUSB_ERROR_NO_DEVICE:
            return "the device is gone";
        case LIBUSB_ERROR_BUSY:
            return "somebody else holds it";
        case LIBUSB_ERROR_TIMEOUT:
            return "no answer in time";
        case LIBUSB_ERROR_PIPE:
            return "the device refused (stall)";
        default:
            return libusb_error_name(result);
    }
}

Result<UsbContext> open_usb() {
    libusb_context* context = nullptr;
    const int result = libusb_init(&context);
    if (result != LIBUSB_SUCCESS)
        return fail(ErrorCode::outside, fmt::format("cannot use USB: {}", usb_error_text(result)));
    return UsbContext(context, libusb_exit);
}

Result<std::vector<UsbDevice>> list_usb_devices(const UsbContext& context) {
    libusb_device** list = nullptr;
    const auto count = libusb_get_device_list(context.get(), &list);
    if (count < 0)
        return fail(ErrorCode::outside,
                    fmt::format("cannot list USB devices: {}", usb_error_text(static_cast<int>(count))));
    std::vector<UsbDevice> devices;
    for (std::ptrdiff_t i = 0; i < count; ++i)
        devices.emplace_back(list[i], [context](libusb_device* device) { libusb_unref_device(device); });
    libusb_free_device_list(list, 0);  // each reference has an owner by now
    return devices;
}

UsbDeviceInfo describe(const UsbDevice& device) {
    libusb_device_descriptor descriptor{};
    libusb_get_device_descriptor(device.get(), &descriptor);  // cached by libusb: never fails
    UsbDeviceInfo info{{descriptor.idVendor, descriptor.idProduct},
                       {},
                       {},
                       {},
                       port_path_of(device.get()),
                       node_of(device.get()),
                       descriptor.bDeviceClass};
    info.manufacturer = attribute(info.port_path, "manufacturer");
    info.product = attribute(info.port_path, "product");
    info.serial = attribute(info.port_path, "serial");
    const bool told = !info.manufacturer.empty() || !info.product.empty() || !info.serial.empty();
    const bool has_texts = descriptor.iManufacturer != 0 || descriptor.iProduct != 0 || descriptor.iSerialNumber != 0;
    if (!told && has_texts) ask_device(device, descriptor, info);
    return info;
}

Result<UsbDevice> find_usb_device(const UsbContext& context, const UsbAddress& address) {
    auto devices = list_usb_devices(context);
    if (!devices) return fail(devices.error());
    std::string alike;
    for (UsbDevice& device : *devices) {
        const UsbDeviceInfo info = describe(device);
        if (address.matches(info)) return std::move(device);
        if (info.ids == address.ids)
            alike += fmt::format("{}{} at {}", alike.empty() ? "" : ", ",
                                 info.serial.empty() ? "one without a serial number" : "serial " + info.serial,
                                 info.port_path);
    }
    return fail(ErrorCode::outside, fmt::format("no USB device {}{}", to_string(address),
                                                alike.empty() ? " is plugged in" : "; of these ids there is " + alike));
}

Result<UsbHandle> open_usb_device(const UsbContext& context, const UsbDevice& device) {
    libusb_device_handle* handle = nullptr;
    const int result = libusb_open(device.get(), &handle);
    if (result == LIBUSB_SUCCESS)
        return UsbHandle(handle, [context](libusb_device_handle* opened) { libusb_close(opened); });
    const UsbDeviceInfo info = describe(device);
    return fail(
        ErrorCode::outside,
        fmt::format("cannot open USB device {} at {} ({}): {}{}", to_string(info.ids), info.port_path, info.node,
                    usb_error_text(result),
                    result == LIBUSB_ERROR_ACCESS ? "; a udev rule gives it: skyloop devices shows the line" : ""));
}

}  // namespace skyloop::inline wire
