// Bytes of other programs, laid out by hand: nothing of the project's encoders is in them.
#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <type_traits>

#include "base/core/bytes.hpp"

namespace skyloop {

// Appends numbers one by one.
class HandBytes {
public:
    explicit HandBytes(bool big_endian = false) : big_endian_(big_endian) {}
    HandBytes& f64(double value) { return number(std::bit_cast<std::uint64_t>(value), 8); }
    HandBytes& f32(double value) { return number(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4); }
    HandBytes& f32s(std::initializer_list<double> values) {
        for (const double value : values)
            f32(value);
        return *this;
    }
    HandBytes& f64s(std::initializer_list<double> values) {
        for (const double value : values)
            f64(value);
        return *this;
    }
    HandBytes& i32(std::int64_t value) { return number(static_cast<std::uint64_t>(value), 4); }
    HandBytes& i16(std::int64_t value) { return number(static_cast<std::uint64_t>(value), 2); }
    HandBytes& u64(std::uint64_t value) { return number(value, 8); }
    HandBytes& u8(std::uint64_t value) { return number(value, 1); }
    HandBytes& text(std::string_view characters) {
        bytes_.insert(bytes_.end(), characters.begin(), characters.end());
        return *this;
    }
    HandBytes& zeros_to(std::size_t size) {
        bytes_.resize(size);
        return *this;
    }
    [[nodiscard]] const Bytes& bytes() const { return bytes_; }

private:
    HandBytes& number(std::uint64_t value, int size) {
        for (int i = 0; i < size; ++i)
            bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * (big_endian_ ? size - 1 - i : i)) & 0xFF));
        return *this;
    }
    bool big_endian_;
    Bytes bytes_;
};

// The checksum of MAVLink frames, by a table of nibbles (CRC-16/MCRF4XX).
inline std::uint16_t hand_crc(ByteSpan bytes) {
    constexpr std::uint16_t table[16] = {0x0000, 0x1081, 0x2102, 0x3183, 0x4204, 0x5285, 0x6306, 0x7387,
                                         0x8408, 0x9489, 0xA50A, 0xB58B, 0xC60C, 0xD68D, 0xE70E, 0xF78F};
    unsigned crc = 0xFFFF;
    for (const std::uint8_t byte : bytes) {
        crc = crc >> 4 ^ table[(crc ^ byte) & 0xF];
        crc = crc >> 4 ^ table[(crc ^ byte >> 4) & 0xF];
    }
    return static_cast<std::uint16_t>(crc);
}

// A MAVLink 2 frame with its zeros cut, or a MAVLink 1 frame.
inline Bytes hand_mavlink(std::uint32_t message, std::uint8_t extra, Bytes payload, std::uint8_t system = 1,
                          int version = 2) {
    Bytes frame;
    if (version == 2) {
        while (payload.size() > 1 && payload.back() == 0)
            payload.pop_back();
        frame = {0xFD,
                 static_cast<std::uint8_t>(payload.size()),
                 0,
                 0,
                 7,
                 system,
                 1,
                 static_cast<std::uint8_t>(message),
                 static_cast<std::uint8_t>(message >> 8),
                 0};
    } else {
        frame = {0xFE, static_cast<std::uint8_t>(payload.size()), 7, system, 1, static_cast<std::uint8_t>(message)};
    }
    frame.insert(frame.end(), payload.begin(), payload.end());
    Bytes covered(frame.begin() + 1, frame.end());
    covered.push_back(extra);
    const std::uint16_t crc = hand_crc(covered);
    frame.push_back(static_cast<std::uint8_t>(crc & 0xFF));
    frame.push_back(static_cast<std::uint8_t>(crc >> 8));
    return frame;
}

}  // namespace skyloop
