#include "receiver/protocol/sbf_frame.hpp"

#include <array>

#include "base/core/crc16.hpp"

namespace skyloop::inline receiver {
namespace {

// Numbers first … last of a system are SVIDs from `svid` on.
struct SvidRange {
    Constellation constellation;
    int first, last;
    int svid;
};
constexpr std::array<SvidRange, 11> svid_ranges{{{Constellation::gps, 1, 37, 1},
                                                 {Constellation::glonass, 1, 24, 38},
                                                 {Constellation::glonass, 25, 30, 63},
                                                 {Constellation::galileo, 1, 36, 71},
                                                 {Constellation::sbas, 20, 40, 120},
                                                 {Constellation::beidou, 1, 40, 141},
                                                 {Constellation::qzss, 1, 10, 181},
                                                 {Constellation::navic, 1, 7, 191},
                                                 {Constellation::sbas, 41, 58, 198},
                                                 {Constellation::navic, 8, 14, 216},
                                                 {Constellation::beidou, 41, 63, 223}}};

}  // namespace

std::uint16_t sbf_crc(ByteSpan bytes) { return crc16_ccitt(bytes, 0); }

Bytes encode_sbf_block(std::uint16_t number, std::uint8_t revision, ByteSpan body) {
    const std::size_t size = (sbf_head_size + body.size() + 3) / 4 * 4;
    if (number > 0x1FFF || revision > 7 || size > 0xFFFF) return {};
    Bytes block(size, 0);
    block[0] = sbf_sync_1;
    block[1] = sbf_sync_2;
    const auto put = [&block](std::size_t at, std::size_t value) {
        block[at] = static_cast<std::uint8_t>(value & 0xFF);
        block[at + 1] = static_cast<std::uint8_t>(value >> 8 & 0xFF);
    };
    put(4, number | static_cast<std::size_t>(revision) << 13);
    put(6, size);
    for (std::size_t i = 0; i < body.size(); ++i)
        block[sbf_head_size + i] = body[i];
    put(2, sbf_crc(ByteSpan(block).subspan(4)));
    return block;
}

std::optional<std::size_t> sbf_block_size(ByteSpan bytes) {
    if (bytes.size() < sbf_head_size || bytes[0] != sbf_sync_1 || bytes[1] != sbf_sync_2) return std::nullopt;
    const std::size_t size = bytes[6] + std::size_t{256} * bytes[7];
    if (size < sbf_head_size || size % 4 != 0) return std::nullopt;
    return size;
}

std::optional<SbfBlockView> parse_sbf(ByteSpan bytes) {
    const auto size = sbf_block_size(bytes);
    if (!size || *size != bytes.size()) return std::nullopt;
    if (sbf_crc(bytes.subspan(4)) != bytes[2] + std::size_t{256} * bytes[3]) return std::nullopt;
    const unsigned id = bytes[4] + 256u * bytes[5];
    return SbfBlockView{static_cast<std::uint16_t>(id & 0x1FFF), static_cast<std::uint8_t>(id >> 13),
                        bytes.subspan(sbf_head_size)};
}

std::optional<std::uint8_t> sbf_svid(SatelliteId satellite) {
    for (const SvidRange& range : svid_ranges)
        if (range.constellation == satellite.constellation && satellite.number >= range.first &&
            satellite.number <= range.last)
            return static_cast<std::uint8_t>(range.svid + satellite.number - range.first);
    return std::nullopt;
}

std::optional<SatelliteId> satellite_from_sbf(std::uint8_t svid) {
    for (const SvidRange& range : svid_ranges)
        if (svid >= range.svid && svid <= range.svid + range.last - range.first)
            return SatelliteId{range.constellation, range.first + svid - range.svid};
    return std::nullopt;
}

}  // namespace skyloop::inline receiver
