// Observations as RTCM 3 multiple signal messages of kinds 4 to 7 (RTCM 10403.3, 3.5.16).
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "receiver/protocol/rtcm3.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr double metres_per_ms = speed_of_light * 1e-3;
constexpr std::size_t most_msm_cells = 64;

// What kinds 4 to 7 have: fields of higher resolution, and rates (RTCM 10403.3, tables 3.5-80, 3.5-82).
struct MsmForm {
    bool fine, rates;
    [[nodiscard]] int range_bits() const { return fine ? 20 : 15; }
    [[nodiscard]] int phase_bits() const { return fine ? 24 : 22; }
    [[nodiscard]] int lock_bits() const { return fine ? 10 : 4; }
    [[nodiscard]] int cno_bits() const { return fine ? 10 : 6; }
    [[nodiscard]] double range_scale() const { return std::exp2(fine ? 29 : 24); }
    [[nodiscard]] double phase_scale() const { return std::exp2(fine ? 31 : 29); }
    [[nodiscard]] double cno_scale() const { return fine ? 16 : 1; }
};
constexpr double rate_scale = 1e4;

std::optional<MsmForm> form_of(int number) {
    const auto kind = msm_kind(number);
    if (!kind || *kind < 4) return std::nullopt;
    return MsmForm{*kind >= 6, *kind == 5 || *kind == 7};
}
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

// The least times, in ms, of both indicators.
double time_of_short_lock(std::uint64_t indicator) {
    return indicator == 0 ? 0 : std::exp2(static_cast<double>(indicator) + 4);
}
double time_of_long_lock(std::uint64_t indicator) {
    const std::uint64_t doublings = indicator < 64 ? 0 : indicator / 32 - 1;
    return std::ldexp(static_cast<double>(indicator - 32 * doublings), static_cast<int>(doublings));
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

void put_satellites(BitWriter& bits, const MsmContent& content, const MsmForm& form) {
    for (const auto& [number, satellite] : content.satellites)
        bits.put_signed(satellite.range / 1024, 8);
    for (const auto& [number, satellite] : content.satellites)
        if (form.rates) bits.put_signed(satellite.info, 4);
    for (const auto& [number, satellite] : content.satellites)
        bits.put_signed(satellite.range % 1024, 10);
    for (const auto& [number, satellite] : content.satellites)
        if (form.rates)
            put_fine(bits, satellite.has_rate ? std::optional(static_cast<double>(satellite.rate)) : std::nullopt, 14);
}

void put_signals(BitWriter& bits, const MsmContent& content, const MsmForm& form) {
    for (const auto& [id, cell] : content.cells)
        put_fine(bits, fine_range_ms(content, cell) * form.range_scale(), form.range_bits());
    for (const auto& [id, cell] : content.cells)
        put_fine(bits, scaled(fine_phase_ms(content, cell), form.phase_scale()), form.phase_bits());
    for (const auto& [id, cell] : content.cells)
        bits.put(form.fine ? long_lock_indicator(cell.lock_s * 1e3) : short_lock_indicator(cell.lock_s * 1e3),
                 form.lock_bits());
    for (const auto& [id, cell] : content.cells)
        bits.put(cell.half_cycle_unknown ? 1 : 0, 1);
    for (const auto& [id, cell] : content.cells)
        bits.put_signed(std::llround(std::clamp(cell.cno_dbhz, 0.0, 63.0) * form.cno_scale()), form.cno_bits());
    for (const auto& [id, cell] : content.cells)
        if (form.rates) put_fine(bits, scaled(fine_rate(content, cell), rate_scale), 15);
}

// Nothing where the field has the least number.
std::optional<double> get_fine(BitReader& bits, int width) {
    const std::int64_t number = bits.get_signed(width);
    if (number == -(std::int64_t{1} << (width - 1))) return std::nullopt;
    return static_cast<double>(number);
}

// Numbers of the set bits, the first bit being 1.
std::vector<int> set_bits(std::uint64_t mask, int width) {
    std::vector<int> numbers;
    for (int i = 1; i <= width; ++i)
        if ((mask >> (width - i) & 1) != 0) numbers.push_back(i);
    return numbers;
}

// What the cells of one satellite share, as decoded.
struct DecodedSatellite {
    int number = 0, info = 0;
    std::optional<double> range_ms;
    std::optional<double> rate;  // m/s
};

std::vector<DecodedSatellite> get_satellites(BitReader& bits, const Rtcm3MsmHeader& header, const MsmForm& form) {
    constexpr std::uint64_t no_range = 255;  // DF397
    std::vector<DecodedSatellite> satellites;
    for (const int number : set_bits(header.satellites, 64))
        satellites.push_back({number, 0, {}, {}});
    for (DecodedSatellite& satellite : satellites)
        if (const std::uint64_t whole = bits.get(8); whole != no_range) satellite.range_ms = static_cast<double>(whole);
    for (DecodedSatellite& satellite : satellites)
        if (form.rates) satellite.info = static_cast<int>(bits.get(4));
    for (DecodedSatellite& satellite : satellites) {
        const double fraction = static_cast<double>(bits.get(10)) / 1024;
        if (satellite.range_ms) *satellite.range_ms += fraction;
    }
    for (DecodedSatellite& satellite : satellites)
        if (form.rates) satellite.rate = get_fine(bits, 14);
    return satellites;
}

struct DecodedCell {
    const DecodedSatellite* satellite;
    Rtcm3MsmCell cell;
    bool has_range = false;
};

void get_signals(BitReader& bits, std::vector<DecodedCell>& cells, const MsmForm& form) {
    for (DecodedCell& one : cells)
        if (const auto fine = get_fine(bits, form.range_bits()); fine && one.satellite->range_ms) {
            one.cell.range_m = (*one.satellite->range_ms + *fine / form.range_scale()) * metres_per_ms;
            one.has_range = true;
        }
    for (DecodedCell& one : cells)
        if (const auto fine = get_fine(bits, form.phase_bits()); fine && one.satellite->range_ms)
            one.cell.phase_range_m = (*one.satellite->range_ms + *fine / form.phase_scale()) * metres_per_ms;
    for (DecodedCell& one : cells) {
        const std::uint64_t indicator = bits.get(form.lock_bits());
        one.cell.lock_s = 1e-3 * (form.fine ? time_of_long_lock(indicator) : time_of_short_lock(indicator));
    }
    for (DecodedCell& one : cells)
        one.cell.half_cycle_unknown = bits.get(1) != 0;
    for (DecodedCell& one : cells)
        one.cell.cno_dbhz = static_cast<double>(bits.get(form.cno_bits())) / form.cno_scale();
    for (DecodedCell& one : cells)
        if (const auto fine = form.rates ? get_fine(bits, 15) : std::nullopt; fine && one.satellite->rate)
            one.cell.phase_range_rate = *one.satellite->rate + *fine / rate_scale;
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
    const auto form = form_of(observations.number);
    const MsmContent content = msm_content(observations.cells);
    if (!form || content.cells.empty()) return {};
    BitWriter bits;
    put_msm_header(bits, observations, content);
    put_satellites(bits, content, *form);
    put_signals(bits, content, *form);
    return encode_rtcm3(bits.bytes());
}

std::optional<Rtcm3MsmObservations> decode_msm(const Rtcm3Message& message) {
    constexpr std::size_t header_bits = 12 + 12 + 30 + 1 + 3 + 7 + 2 + 2 + 1 + 3 + 64 + 32;
    const auto form = form_of(message.number);
    const auto header = form ? decode_msm_header(message) : std::nullopt;
    if (!header) return std::nullopt;
    BitReader bits(message.payload);
    bits.skip(header_bits + header->cells.size());
    const std::vector<DecodedSatellite> satellites = get_satellites(bits, *header, *form);
    std::vector<DecodedCell> cells;
    std::size_t place = 0;
    for (const DecodedSatellite& satellite : satellites)
        for (const int signal : set_bits(header->signals, 32))
            if (header->cells.at(place++)) {
                cells.push_back({&satellite, {}});
                cells.back().cell.satellite = satellite.number;
                cells.back().cell.signal = signal;
                cells.back().cell.satellite_info = satellite.info;
            }
    get_signals(bits, cells, *form);
    if (!bits.ok()) return std::nullopt;
    Rtcm3MsmObservations result{header->number, header->station, header->epoch, header->more, {}};
    for (const DecodedCell& one : cells)
        if (one.has_range) result.cells.push_back(one.cell);
    return result;
}

}  // namespace skyloop::inline receiver
