#include "descriptors.hpp"

#include <fmt/format.h>

namespace skyloop::mock {
namespace {

std::uint8_t low(std::size_t value) { return static_cast<std::uint8_t>(value & 0xff); }
std::uint8_t high(std::size_t value) { return static_cast<std::uint8_t>(value >> 8 & 0xff); }

}  // namespace

std::string node_of(const DeviceSpec& device) { return fmt::format("/dev/bus/usb/001/{:03}", device.address); }

Bytes descriptors(const DeviceSpec& device) {
    const auto index = [](const std::string& text, std::uint8_t number) -> std::uint8_t {
        return text.empty() ? 0 : number;
    };
    // USB 2.0, table 9-8: full speed, class told by the interfaces, release 1.0, one configuration.
    const Bytes head{18,
                     1,
                     0x00,
                     0x02,
                     device.device_class,
                     0,
                     0,
                     64,
                     low(device.ids.vendor),
                     high(device.ids.vendor),
                     low(device.ids.product),
                     high(device.ids.product),
                     0x00,
                     0x01,
                     index(device.manufacturer, 1),
                     index(device.product, 2),
                     index(device.serial, 3),
                     1};
    return joined({head, device.configuration});
}

Bytes interface(std::uint8_t number, std::uint8_t endpoints, InterfaceClass kind) {
    return {9, 4, number, 0, endpoints, kind.code, kind.subclass, kind.protocol, 0};
}

Bytes endpoint(std::uint8_t address, std::uint8_t attributes, std::uint16_t packet) {
    return {7, 5, address, attributes, low(packet), high(packet), 1};
}

Bytes configuration(std::uint8_t interfaces, const Bytes& body) {
    const std::size_t size = 9 + body.size();
    return joined({{9, 2, low(size), high(size), interfaces, 1, 0, 0x80, 50}, body});
}

Bytes joined(std::initializer_list<Bytes> parts) {
    Bytes all;
    for (const Bytes& part : parts)
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

Bytes cdc_acm_configuration() {
    // Header, call management, abstract control (line coding and break), union of interfaces 0 and 1.
    const Bytes functions{5, 0x24, 0, 0x10, 1, 5, 0x24, 1, 0, 1, 4, 0x24, 2, 6, 5, 0x24, 6, 0, 1};
    return configuration(2, joined({interface(0, 1, {2, 2, 1}), functions, endpoint(0x83, 3, 64),
                                    interface(1, 2, {10, 0, 0}), endpoint(0x01, 2, 64), endpoint(0x82, 2, 64)}));
}

Bytes hid_configuration(const HidShape& shape) {
    // The HID descriptor (HID 1.11, section 6.2.1): one report descriptor.
    const Bytes hid{9, 0x21, 0x11, 1, 0, 1, 0x22, low(shape.report_size), high(shape.report_size)};
    const std::uint8_t endpoints = shape.has_out ? 2 : 1;
    return configuration(1, joined({interface(0, endpoints, {3, 0, 0}), hid, endpoint(0x81, 3, shape.packet),
                                    shape.has_out ? endpoint(0x01, 3, shape.packet) : Bytes{}}));
}

}  // namespace skyloop::mock
