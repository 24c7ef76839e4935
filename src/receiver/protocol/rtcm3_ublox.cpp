#include "receiver/protocol/rtcm3_ublox.hpp"

#include <algorithm>

namespace skyloop::inline receiver {
namespace {

constexpr int ublox_own = 4072, moving_station = 0, station_biases = 1;
constexpr std::size_t most_biases = 168;

void put_ublox_head(BitWriter& bits, const Rtcm3UbloxHead& head, int subtype) {
    bits.put_signed(ublox_own, 12);
    bits.put_signed(subtype, 12);
    bits.put_signed(head.station, 12);
    bits.put(0, 12);
    bits.put_signed(head.kind, 4);
    bits.put(head.epoch, 30);
    bits.put(0, 14);
}

Rtcm3UbloxHead get_ublox_head(BitReader& bits) {
    Rtcm3UbloxHead head;
    bits.skip(12 + 12);
    head.station = static_cast<int>(bits.get(12));
    bits.skip(12);
    head.kind = static_cast<int>(bits.get(4));
    head.epoch = static_cast<std::uint32_t>(bits.get(30));
    bits.skip(14);
    return head;
}

bool is_ublox(const Rtcm3Message& message, int subtype) {
    return message.number == ublox_own && message.subtype == subtype;
}

}  // namespace

std::optional<Rtcm3MovingStation> decode_moving_station(const Rtcm3Message& message) {
    if (!is_ublox(message, moving_station)) return std::nullopt;
    BitReader bits(message.payload);
    Rtcm3MovingStation result;
    result.head = get_ublox_head(bits);
    for (std::int64_t& axis : result.position)
        axis = bits.get_signed(38);
    for (std::int32_t& axis : result.velocity)
        axis = static_cast<std::int32_t>(bits.get_signed(24));
    result.position_deviation_mm = static_cast<std::uint32_t>(bits.get(20));
    result.velocity_deviation = static_cast<std::uint32_t>(bits.get(20));
    if (!bits.ok()) return std::nullopt;
    return result;
}

Bytes encode(const Rtcm3MovingStation& station) {
    constexpr std::uint32_t most = (1u << 20) - 1;
    BitWriter bits;
    put_ublox_head(bits, station.head, moving_station);
    for (const std::int64_t axis : station.position)
        bits.put_signed(axis, 38);
    for (const std::int32_t axis : station.velocity)
        bits.put_signed(axis, 24);
    bits.put(std::min(station.position_deviation_mm, most), 20);
    bits.put(std::min(station.velocity_deviation, most), 20);
    return encode_rtcm3(bits.bytes());
}

std::optional<Rtcm3StationBiases> decode_station_biases(const Rtcm3Message& message) {
    constexpr std::size_t head_bytes = 14, bias_bytes = 6;
    if (!is_ublox(message, station_biases)) return std::nullopt;
    BitReader bits(message.payload);
    Rtcm3StationBiases result;
    result.head = get_ublox_head(bits);
    const std::uint64_t count = bits.get(16);
    if (message.payload.size() != head_bytes + count * bias_bytes) return std::nullopt;
    for (std::uint64_t i = 0; i < count; ++i) {
        Rtcm3StationBiases::Bias& bias = result.biases.emplace_back();
        bias.system = static_cast<std::uint8_t>(bits.get(8));
        bias.band = static_cast<std::uint8_t>(bits.get(8));
        bias.offset = static_cast<std::int16_t>(bits.get_signed(16));
        bias.deviation = static_cast<std::uint16_t>(bits.get(16));
    }
    return result;
}

Bytes encode(const Rtcm3StationBiases& biases) {
    const std::size_t count = std::min(biases.biases.size(), most_biases);
    BitWriter bits;
    put_ublox_head(bits, biases.head, station_biases);
    bits.put(count, 16);
    for (std::size_t i = 0; i < count; ++i) {
        const Rtcm3StationBiases::Bias& bias = biases.biases[i];
        bits.put(bias.system, 8);
        bits.put(bias.band, 8);
        bits.put_signed(bias.offset, 16);
        bits.put(bias.deviation, 16);
    }
    return encode_rtcm3(bits.bytes());
}

}  // namespace skyloop::inline receiver
