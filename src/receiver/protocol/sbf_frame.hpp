/// Septentrio Binary Format: blocks, satellite numbers and the values that mean "nothing".
///
/// Sections are those of the Septentrio PolaRx5TR reference guide (firmware 5.5), chapter 4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "base/core/bytes.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop::inline receiver {

inline constexpr std::uint8_t sbf_sync_1 = '$', sbf_sync_2 = '@';
/// Sync, CRC, id and length (4.1.1).
inline constexpr std::size_t sbf_head_size = 8;

/// What stands in a field that has nothing to say (4.1.6): all bits of integers, and this for numbers with a point.
inline constexpr double sbf_nothing = -2e10;

/// One checked block; the body, padding included, lives as long as the bytes that were parsed.
struct SbfBlockView {
    std::uint16_t number = 0;   ///< 0 … 8191
    std::uint8_t revision = 0;  ///< 0 … 7
    ByteSpan body;
};

/// CRC-16 with polynomial 0x1021 and start 0, over id, length and body (4.1.1).
std::uint16_t sbf_crc(ByteSpan bytes);

/// The whole block, filled with zeros to a multiple of four bytes. Empty when number, revision or length do not fit.
Bytes encode_sbf_block(std::uint16_t number, std::uint8_t revision, ByteSpan body);

/// Bytes of the block that begins here, by its length field: nothing when none does, when the head is not whole or when
/// the length is no multiple of four.
std::optional<std::size_t> sbf_block_size(ByteSpan bytes);
/// Reads exactly one block; nothing when sync, length or CRC do not hold.
std::optional<SbfBlockView> parse_sbf(ByteSpan bytes);

/// SVID: one number for the satellites of all systems (4.1.9). Nothing for a satellite that has none.
std::optional<std::uint8_t> sbf_svid(SatelliteId satellite);
/// The satellite of a number; nothing for GLONASS without a known slot, L-band and free numbers.
std::optional<SatelliteId> satellite_from_sbf(std::uint8_t svid);

}  // namespace skyloop::inline receiver
