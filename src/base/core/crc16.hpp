/// The CRC of CAN's transfers and of Septentrio's blocks.
#pragma once

#include <cstdint>

#include "base/core/bytes.hpp"

namespace skyloop::inline base {

/// CRC-16 with polynomial 0x1021, not reflected. @param before 0xFFFF at first (CRC-16-CCITT of CAN), or 0 (of SBF)
constexpr std::uint16_t crc16_ccitt(ByteSpan bytes, std::uint16_t before) {
    unsigned crc = before;
    for (const std::uint8_t byte : bytes) {
        crc ^= static_cast<unsigned>(byte) << 8;
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc & 0x8000u) != 0 ? (crc << 1 ^ 0x1021u) & 0xFFFFu : crc << 1;
    }
    return static_cast<std::uint16_t>(crc);
}

}  // namespace skyloop::inline base
