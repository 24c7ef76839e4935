#include "world/rinex/observation_file.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>

#include "base/core/fixed_text.hpp"
#include "base/time/utc_time.hpp"
#include "detail/header_text.hpp"

namespace skyloop {
namespace rinex {
namespace {

constexpr std::string_view observed_kinds = "CLDS";
constexpr std::size_t observation_width = 16;  // F14.3 and the two digits

// F14.3, blank where the number does not fit; zero without a sign.
std::string three_decimals(double value) {
    std::string text;
    append_fixed(text, value, 3);
    if (text.size() > 14 || !std::isfinite(value)) return std::string(14, ' ');
    if (text == "-0.000") text.erase(0, 1);
    return text.insert(0, 14 - text.size(), ' ');
}

// C/N0 in steps of 6 dB (RINEX 3.04, table 9).
char strength_digit(DbHz cn0) {
    if (!(cn0.value() > 0)) return ' ';
    return static_cast<char>('0' + static_cast<int>(std::clamp(cn0.value() / 6, 1.0, 9.0)));
}

char loss_of_lock_digit(const Observation& o) {
    const int digit = (o.slipped ? 1 : 0) + (o.half_cycle_resolved ? 0 : 2);
    return digit == 0 ? ' ' : static_cast<char>('0' + digit);
}

void write_observation(const Observation& o, std::string& row, std::size_t at) {
    const auto put = [&](std::size_t kind, const std::string& number, char lock, char strength) {
        row.replace(at + kind * observation_width, number.size(), number);
        if (number.back() == ' ') return;
        row[at + kind * observation_width + 14] = lock;
        row[at + kind * observation_width + 15] = strength;
    };
    if (o.pseudorange) put(0, three_decimals(o.pseudorange->value()), ' ', strength_digit(o.cn0));
    if (o.carrier_phase) put(1, three_decimals(*o.carrier_phase), loss_of_lock_digit(o), strength_digit(o.cn0));
    if (o.doppler) put(2, three_decimals(o.doppler->value()), ' ', ' ');
    if (o.cn0.value() > 0) put(3, three_decimals(o.cn0.value()), ' ', ' ');
}

// Year to minute, and seconds with 100 ns, each in its width.
struct EpochText {
    explicit EpochText(GpsTime time)
        : calendar(gps_calendar(GpsTime(std::chrono::round<HundredNanoseconds>(time.time_since_epoch())))),
          second(fmt::format("{:2}.{:07}", calendar.second, calendar.nanosecond / 100)) {}
    using HundredNanoseconds = std::chrono::duration<std::int64_t, std::ratio<1, 10'000'000>>;
    UtcTime calendar;
    std::string second;
};

}  // namespace
}  // namespace rinex

ObservationWriter::ObservationWriter(ObservationHeader header) : header_(std::move(header)) {
    for (auto& [system, signals] : header_.signals)
        std::erase_if(signals, [system = system](Signal s) { return !rinex_signal_code(system, s); });
    std::erase_if(header_.signals, [](const auto& system) { return system.second.empty(); });
}

std::string ObservationWriter::header() const {
    using rinex::header_line;
    using rinex::in_columns;
    const Eigen::Vector3d& p = header_.approximate_position.vector();
    const rinex::EpochText first(header_.first_epoch);
    const UtcTime& c = first.calendar;
    std::string text =
        header_line("     3.04           OBSERVATION DATA    M: MIXED", "RINEX VERSION / TYPE") +
        rinex::program_line(header_.program, header_.first_epoch) +
        header_line(in_columns(header_.marker, 60), "MARKER NAME") + header_line("", "MARKER TYPE") +
        header_line("", "OBSERVER / AGENCY") +
        header_line(std::string(20, ' ') + in_columns(header_.receiver, 20) + in_columns(header_.receiver_version, 20),
                    "REC # / TYPE / VERS") +
        header_line(std::string(20, ' ') + in_columns(header_.antenna, 20), "ANT # / TYPE") +
        header_line(fmt::format("{:14.4f}{:14.4f}{:14.4f}", p[0], p[1], p[2]), "APPROX POSITION XYZ") +
        header_line(fmt::format("{:14.4f}{:14.4f}{:14.4f}", 0.0, 0.0, 0.0), "ANTENNA: DELTA H/E/N") + system_lines();
    text += header_line("DBHZ", "SIGNAL STRENGTH UNIT");
    if (header_.interval.value() > 0)
        text += header_line(fmt::format("{:10.3f}", header_.interval.value()), "INTERVAL");
    text += header_line(
        fmt::format("{:6}{:6}{:6}{:6}{:6}   {}     GPS", c.year, c.month, c.day, c.hour, c.minute, first.second),
        "TIME OF FIRST OBS");
    for (const auto& [system, signals] : header_.signals)
        for (const Signal signal : signals)
            text +=
                header_line(fmt::format("{} L{}  0.00000", rinex_letter(system), *rinex_signal_code(system, signal)),
                            "SYS / PHASE SHIFT");
    if (header_.signals.contains(Constellation::glonass)) text += glonass_lines();
    const int leap = header_.leap_seconds.value_or(LeapSeconds::announced().offset(header_.first_epoch));
    return text + header_line(fmt::format("{:6}", leap), "LEAP SECONDS") + header_line("", "END OF HEADER");
}

std::string ObservationWriter::system_lines() const {
    constexpr std::size_t most_types = 13;
    std::string text;
    for (const auto& [system, signals] : header_.signals) {
        std::vector<std::string> types;
        for (const Signal signal : signals)
            for (const char kind : rinex::observed_kinds)
                types.push_back(fmt::format("{}{}", kind, *rinex_signal_code(system, signal)));
        std::string line = fmt::format("{}  {:3}", rinex_letter(system), types.size());
        for (std::size_t i = 0; i < types.size(); ++i) {
            if (i > 0 && i % most_types == 0) {
                text += rinex::header_line(line, "SYS / # / OBS TYPES");
                line = std::string(6, ' ');
            }
            line += " " + types[i];
        }
        text += rinex::header_line(line, "SYS / # / OBS TYPES");
    }
    return text;
}

std::string ObservationWriter::glonass_lines() const {
    constexpr std::size_t most_slots = 8;
    std::string text;
    std::string line = fmt::format("{:3}", header_.glonass_channels.size());
    std::size_t count = 0;
    for (const auto& [slot, channel] : header_.glonass_channels) {
        if (count > 0 && count % most_slots == 0) {
            text += rinex::header_line(line, "GLONASS SLOT / FRQ #");
            line = std::string(3, ' ');
        }
        line += fmt::format(" R{:02} {:2}", slot, channel);
        ++count;
    }
    return text + rinex::header_line(line, "GLONASS SLOT / FRQ #") +
           rinex::header_line(" C1C    0.000 C1P    0.000 C2C    0.000 C2P    0.000", "GLONASS COD/PHS/BIS");
}

std::optional<std::size_t> ObservationWriter::place(const Observation& observation) const {
    const auto system = header_.signals.find(observation.satellite.constellation);
    if (system == header_.signals.end()) return std::nullopt;
    const auto found = std::find(system->second.begin(), system->second.end(), observation.signal);
    if (found == system->second.end()) return std::nullopt;
    return static_cast<std::size_t>(found - system->second.begin());
}

std::string ObservationWriter::epoch(const Observations& observations) const {
    std::string rows;
    std::string row;
    int satellites = 0;
    const auto finish_row = [&] {
        if (row.empty()) return;
        row.erase(row.find_last_not_of(' ') + 1);
        rows += row + "\n";
        row.clear();
        ++satellites;
    };
    SatelliteId at;
    for (const Observation& o : observations.signals) {
        const std::optional<std::size_t> index = place(o);
        if (!index) continue;
        if (row.empty() || o.satellite != at) {
            finish_row();
            at = o.satellite;
            const std::size_t kinds = rinex::observed_kinds.size() * header_.signals.at(at.constellation).size();
            row = to_string(at) + std::string(kinds * rinex::observation_width, ' ');
        }
        rinex::write_observation(o, row, 3 + *index * rinex::observed_kinds.size() * rinex::observation_width);
    }
    finish_row();
    const rinex::EpochText time(observations.receive_time);
    const UtcTime& c = time.calendar;
    return fmt::format(FMT_COMPILE("> {:04} {:02} {:02} {:02} {:02} {}  0{:3}\n"), c.year, c.month, c.day, c.hour,
                       c.minute, time.second, satellites) +
           rows;
}

}  // namespace skyloop
