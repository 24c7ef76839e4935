#include "receiver/protocol/rtcm3_msm.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/core/bit_field.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
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

}  // namespace skyloop
