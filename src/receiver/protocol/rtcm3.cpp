#include "receiver/protocol/rtcm3.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>

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
    bits.skip(6 + 4);  // year of the frame, systems, kind of station
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
    bits.put(all_systems << 1, 4);
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

namespace {

constexpr double metres_per_ms = speed_of_light * 1e-3;
constexpr std::size_t most_msm_cells = 64;
// Beyond it a phase is brought nearer: the fields reach ±2^-8 ms, 1171 m.
constexpr double phase_step_m = 1000;

// What the cells of one satellite share: the whole milliseconds and 1/1024 of its range, and its rate.
struct RoughSatellite {
    std::int64_t range = 0;  // ms/1024
    std::int64_t rate = 0;   // m/s
    bool has_rate = false;
    int info = 0;
};

struct MsmContent {
    std::map<int, RoughSatellite> satellites;
    std::set<int> signals;
    std::map<std::pair<int, int>, Rtcm3MsmCell> cells;
};

void drop_satellite(MsmContent& content, int satellite) {
    content.satellites.erase(satellite);
    std::erase_if(content.cells, [&](const auto& cell) { return cell.first.first == satellite; });
}

MsmContent msm_content(const std::vector<Rtcm3MsmCell>& cells) {
    MsmContent content;
    for (const Rtcm3MsmCell& cell : cells) {
        const auto [at, is_new] = content.satellites.try_emplace(cell.satellite);
        if (is_new) at->second.range = std::llround(cell.range_m / metres_per_ms * 1024);
        at->second.info = cell.satellite_info;
        if (cell.phase_range_rate && !at->second.has_rate) {
            at->second.rate = std::llround(*cell.phase_range_rate);
            at->second.has_rate = true;
        }
        content.signals.insert(cell.signal);
        content.cells[{cell.satellite, cell.signal}] = cell;
    }
    while (content.satellites.size() * content.signals.size() > most_msm_cells)
        drop_satellite(content, content.satellites.rbegin()->first);
    return content;
}

// The number that means that there is none is the least one.
void put_fine(BitWriter& bits, std::optional<double> value, int width) {
    const std::int64_t none = -(std::int64_t{1} << (width - 1));
    const std::int64_t number = value ? std::llround(*value) : none;
    bits.put_signed(number > none && number < -none ? number : none, width);
}

// DF402 (table 3.5-74) and DF407 (table 3.5-75) from the time in ms.
std::uint64_t short_lock_indicator(double ms) {
    return ms < 32 ? 0 : static_cast<std::uint64_t>(std::min(15.0, std::floor(std::log2(ms / 16))));
}
std::uint64_t long_lock_indicator(double ms) {
    const auto whole = static_cast<std::uint64_t>(std::clamp(ms, 0.0, 67108864.0));
    if (whole < 64) return whole;
    std::uint64_t doublings = 0;
    while (whole >> doublings >= 64)
        ++doublings;
    return (whole >> doublings) + 32 * doublings;
}

double fine_range_ms(const MsmContent& content, const Rtcm3MsmCell& cell) {
    return cell.range_m / metres_per_ms - static_cast<double>(content.satellites.at(cell.satellite).range) / 1024;
}

std::optional<double> fine_phase_ms(const MsmContent& content, const Rtcm3MsmCell& cell) {
    if (!cell.phase_range_m) return std::nullopt;
    const double step = std::round(phase_step_m / cell.wavelength_m) * cell.wavelength_m;
    const double beyond = std::round((*cell.phase_range_m - cell.range_m) / step) * step;
    return (*cell.phase_range_m - beyond) / metres_per_ms -
           static_cast<double>(content.satellites.at(cell.satellite).range) / 1024;
}

std::optional<double> fine_rate(const MsmContent& content, const Rtcm3MsmCell& cell) {
    if (!cell.phase_range_rate) return std::nullopt;
    return *cell.phase_range_rate - static_cast<double>(content.satellites.at(cell.satellite).rate);
}

std::optional<double> scaled(std::optional<double> value, double factor) {
    if (value) *value *= factor;
    return value;
}

void put_satellites(BitWriter& bits, const MsmContent& content, bool full) {
    for (const auto& [number, satellite] : content.satellites)
        bits.put_signed(satellite.range / 1024, 8);
    for (const auto& [number, satellite] : content.satellites)
        if (full) bits.put_signed(satellite.info, 4);
    for (const auto& [number, satellite] : content.satellites)
        bits.put_signed(satellite.range % 1024, 10);
    for (const auto& [number, satellite] : content.satellites)
        if (full)
            put_fine(bits, satellite.has_rate ? std::optional(static_cast<double>(satellite.rate)) : std::nullopt, 14);
}

void put_signals(BitWriter& bits, const MsmContent& content, bool full) {
    const int range_bits = full ? 20 : 15, phase_bits = full ? 24 : 22;
    const double range_scale = std::exp2(full ? 29 : 24), phase_scale = std::exp2(full ? 31 : 29);
    for (const auto& [id, cell] : content.cells)
        put_fine(bits, fine_range_ms(content, cell) * range_scale, range_bits);
    for (const auto& [id, cell] : content.cells)
        put_fine(bits, scaled(fine_phase_ms(content, cell), phase_scale), phase_bits);
    for (const auto& [id, cell] : content.cells)
        bits.put(full ? long_lock_indicator(cell.lock_s * 1e3) : short_lock_indicator(cell.lock_s * 1e3),
                 full ? 10 : 4);
    for (const auto& [id, cell] : content.cells)
        bits.put(cell.half_cycle_unknown ? 1 : 0, 1);
    for (const auto& [id, cell] : content.cells)
        bits.put_signed(std::llround(std::clamp(cell.cno_dbhz, 0.0, 63.0) * (full ? 16 : 1)), full ? 10 : 6);
    for (const auto& [id, cell] : content.cells)
        if (full) put_fine(bits, scaled(fine_rate(content, cell), 1e4), 15);
}

void put_msm_header(BitWriter& bits, const Rtcm3MsmObservations& observations, const MsmContent& content) {
    bits.put_signed(observations.number, 12);
    bits.put_signed(observations.station, 12);
    bits.put(observations.epoch, 30);
    bits.put(observations.more ? 1 : 0, 1);
    bits.put(0, 3 + 7 + 2 + 2 + 1 + 3);  // issue, reserved, clocks, smoothing
    for (int satellite = 1; satellite <= 64; ++satellite)
        bits.put(content.satellites.contains(satellite) ? 1 : 0, 1);
    for (int signal = 1; signal <= 32; ++signal)
        bits.put(content.signals.contains(signal) ? 1 : 0, 1);
    for (const auto& [satellite, rough] : content.satellites)
        for (const int signal : content.signals)
            bits.put(content.cells.contains({satellite, signal}) ? 1 : 0, 1);
}

}  // namespace

Bytes encode(const Rtcm3MsmObservations& observations) {
    const auto kind = msm_kind(observations.number);
    const MsmContent content = msm_content(observations.cells);
    if ((kind != 4 && kind != 7) || content.cells.empty()) return {};
    BitWriter bits;
    put_msm_header(bits, observations, content);
    put_satellites(bits, content, kind == 7);
    put_signals(bits, content, kind == 7);
    return encode_rtcm3(bits.bytes());
}

}  // namespace skyloop::inline receiver
