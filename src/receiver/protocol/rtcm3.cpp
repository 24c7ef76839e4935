#include "receiver/protocol/rtcm3.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/core/bytes.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr std::uint8_t rtcm3_first_byte = 0xD3;
constexpr std::size_t rtcm3_head_bytes = 3, rtcm3_tail_bytes = 3, rtcm3_most_payload = 1023;
constexpr int station_1005 = 1005, station_1006 = 1006, biases_1230 = 1230, ublox_4072 = 4072;
constexpr int rtcm3_most_cells = 64;

// Ephemerides have a satellite where others have a station, network and space state messages an epoch or a network.
bool begins_with_station(int number) {
    const auto within = [number](int first, int last) { return number >= first && number <= last; };
    return within(1001, 1013) || number == 1029 || within(1032, 1035) || msm_kind(number) || number == biases_1230;
}

void put_rtcm3_begin(BitWriter& bits, int number, int station) {
    bits.put_signed(number, 12);
    bits.put_signed(station, 12);
}

Bytes rtcm3_framed(const BitWriter& bits) { return encode_rtcm3(bits.bytes()); }

}  // namespace

std::optional<Rtcm3Message> parse_rtcm3(ByteSpan frame) {
    if (frame.size() < rtcm3_head_bytes + rtcm3_tail_bytes || frame[0] != rtcm3_first_byte || (frame[1] & 0xFC) != 0)
        return std::nullopt;
    const std::size_t length = static_cast<std::size_t>(frame[1] & 3) << 8 | frame[2];
    if (frame.size() != rtcm3_head_bytes + length + rtcm3_tail_bytes) return std::nullopt;
    BitReader check(frame.last(rtcm3_tail_bytes));
    if (crc24q(frame.first(rtcm3_head_bytes + length)) != check.get(24)) return std::nullopt;

    Rtcm3Message message;
    message.payload = frame.subspan(rtcm3_head_bytes, length);
    BitReader bits(message.payload);
    message.number = static_cast<int>(bits.get(12));
    const int second = static_cast<int>(bits.get(12));
    if (!bits.ok()) return std::nullopt;
    if (begins_with_station(message.number)) message.station = second;
    if (message.number == ublox_4072) {
        message.subtype = second;
        // Nobody tells its layout; where a real ZED-F9T, whose station is 0, has zeros.
        const int third = static_cast<int>(bits.get(12));
        if (bits.ok()) message.station = third;
    }
    return message;
}

Bytes encode_rtcm3(ByteSpan payload) {
    if (payload.size() > rtcm3_most_payload) return {};
    Bytes frame{rtcm3_first_byte, static_cast<std::uint8_t>(payload.size() >> 8),
                static_cast<std::uint8_t>(payload.size() & 0xFF)};
    frame.insert(frame.end(), payload.begin(), payload.end());
    const std::uint32_t check = crc24q(frame);
    for (const int shift : {16, 8, 0})
        frame.push_back(static_cast<std::uint8_t>(check >> shift & 0xFF));
    return frame;
}

std::optional<Rtcm3Station> decode_station(const Rtcm3Message& message) {
    if (message.number != station_1005 && message.number != station_1006) return std::nullopt;
    BitReader bits(message.payload);
    bits.skip(12);
    Rtcm3Station result;
    result.station = static_cast<int>(bits.get(12));
    bits.skip(6 + 3);  // year of the frame, systems
    result.computed = bits.get(1) != 0;
    result.position[0] = bits.get_signed(38);
    bits.skip(2);
    result.position[1] = bits.get_signed(38);
    bits.skip(2);
    result.position[2] = bits.get_signed(38);
    if (message.number == station_1006) result.antenna_height = static_cast<int>(bits.get(16));
    if (!bits.ok()) return std::nullopt;
    return result;
}

Bytes encode(const Rtcm3Station& station) {
    constexpr std::uint64_t all_systems = 0b111;
    BitWriter bits;
    put_rtcm3_begin(bits, station.antenna_height ? station_1006 : station_1005, station.station);
    bits.put(0, 6);
    bits.put(all_systems, 3);
    bits.put(station.computed ? 1 : 0, 1);
    bits.put_signed(station.position[0], 38);
    bits.put(0, 2);
    bits.put_signed(station.position[1], 38);
    bits.put(0, 2);
    bits.put_signed(station.position[2], 38);
    if (station.antenna_height) bits.put_signed(*station.antenna_height, 16);
    return rtcm3_framed(bits);
}

std::optional<Rtcm3GlonassBiases> decode_glonass_biases(const Rtcm3Message& message) {
    if (message.number != biases_1230) return std::nullopt;
    BitReader bits(message.payload);
    bits.skip(12);
    Rtcm3GlonassBiases result;
    result.station = static_cast<int>(bits.get(12));
    result.aligned = bits.get(1) != 0;
    bits.skip(3);
    const std::uint64_t mask = bits.get(4);
    for (std::size_t i = 0; i < result.bias.size(); ++i)
        if ((mask >> (3 - i) & 1) != 0) result.bias[i] = static_cast<std::int16_t>(bits.get_signed(16));
    if (!bits.ok()) return std::nullopt;
    return result;
}

Bytes encode(const Rtcm3GlonassBiases& biases) {
    BitWriter bits;
    put_rtcm3_begin(bits, biases_1230, biases.station);
    bits.put(biases.aligned ? 1 : 0, 1);
    bits.put(0, 3);
    for (const auto& bias : biases.bias)
        bits.put(bias ? 1 : 0, 1);
    for (const auto& bias : biases.bias)
        if (bias) bits.put_signed(*bias, 16);
    return rtcm3_framed(bits);
}

int Rtcm3MsmHeader::satellite_count() const { return std::popcount(satellites); }
int Rtcm3MsmHeader::signal_count() const { return std::popcount(signals); }

std::optional<Rtcm3MsmHeader> decode_msm_header(const Rtcm3Message& message) {
    if (!msm_kind(message.number)) return std::nullopt;
    BitReader bits(message.payload);
    Rtcm3MsmHeader result;
    result.number = static_cast<int>(bits.get(12));
    result.station = static_cast<int>(bits.get(12));
    result.epoch = static_cast<std::uint32_t>(bits.get(30));
    result.more = bits.get(1) != 0;
    result.issue = static_cast<int>(bits.get(3));
    bits.skip(7 + 2 + 2 + 1 + 3);  // reserved, clocks, smoothing
    result.satellites = bits.get(64);
    result.signals = static_cast<std::uint32_t>(bits.get(32));
    const int cells = result.satellite_count() * result.signal_count();
    if (!bits.ok() || cells > rtcm3_most_cells) return std::nullopt;
    for (int i = 0; i < cells; ++i)
        result.cells.push_back(bits.get(1) != 0);
    if (!bits.ok()) return std::nullopt;
    return result;
}

Bytes encode(const Rtcm3MsmHeader& header) {
    BitWriter bits;
    put_rtcm3_begin(bits, header.number, header.station);
    bits.put(header.epoch, 30);
    bits.put(header.more ? 1 : 0, 1);
    bits.put_signed(header.issue, 3);
    bits.put(0, 7 + 2 + 2 + 1 + 3);
    bits.put(header.satellites, 64);
    bits.put(header.signals, 32);
    for (const bool cell : header.cells)
        bits.put(cell ? 1 : 0, 1);
    return rtcm3_framed(bits);
}

std::optional<int> msm_kind(int number) {
    if (number < 1070 || number >= 1140) return std::nullopt;
    const int kind = number % 10;
    if (kind < 1 || kind > 7) return std::nullopt;
    return kind;
}

}  // namespace skyloop::inline receiver
