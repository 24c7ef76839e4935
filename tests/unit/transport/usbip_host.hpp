/// Commands of a USB/IP host, for tests.
#pragma once

#include <initializer_list>

#include "wire/transport/usbip_messages.hpp"

namespace skyloop::test {

/// Big-endian words, as the kernel's documentation shows messages.
inline Bytes words(std::initializer_list<std::uint32_t> values) {
    Bytes bytes;
    for (const std::uint32_t value : values)
        for (int shift = 24; shift >= 0; shift -= 8)
            bytes.push_back(static_cast<std::uint8_t>(value >> shift & 0xFF));
    return bytes;
}

constexpr std::uint32_t usbip_test_device = 0x10002;

/// Asks for up to `length` bytes of an endpoint.
inline Bytes submit_in(std::uint32_t sequence, std::uint32_t endpoint, std::uint32_t length) {
    return words({1, sequence, usbip_test_device, 1, endpoint, 0, length, 0, 0xffffffff, 0, 0, 0});
}
/// Sends bytes to the serial line.
inline Bytes submit_out(std::uint32_t sequence, const Bytes& data) {
    Bytes bytes = words({1, sequence, usbip_test_device, 0, CdcAcmDevice::data_out, 0,
                         static_cast<std::uint32_t>(data.size()), 0, 0xffffffff, 0, 0, 0});
    bytes.insert(bytes.end(), data.begin(), data.end());
    return bytes;
}
/// A control request without data.
inline Bytes control_out(std::uint32_t sequence, std::uint8_t type, std::uint8_t request, std::uint16_t value) {
    Bytes bytes = words({1, sequence, usbip_test_device, 0, 0, 0, 0, 0, 0xffffffff, 0, 0, 0});
    bytes[40] = type;
    bytes[41] = request;
    bytes[42] = static_cast<std::uint8_t>(value & 0xFF);
    bytes[43] = static_cast<std::uint8_t>(value >> 8);
    return bytes;
}
inline Bytes set_configuration(std::uint32_t sequence) { return control_out(sequence, 0x00, 9, 1); }
inline Bytes set_lines(std::uint32_t sequence, std::uint16_t lines) { return control_out(sequence, 0x21, 0x22, lines); }
inline Bytes unlink(std::uint32_t sequence, std::uint32_t target) {
    return words({2, sequence, usbip_test_device, 0, 0, target, 0, 0, 0, 0, 0, 0});
}

}  // namespace skyloop::test
