#include "world/rinex/rinex_writer.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <string_view>

#include "base/core/number_text.hpp"
#include "base/time/gps_time.hpp"
#include "base/time/utc_time.hpp"

namespace skyloop::inline world {
namespace rinex {
namespace {

// A header line: content in columns 1-60, label in 61-80, and its end.
std::string header_line(std::string_view content, std::string_view label) {
    return fmt::format("{:<60}{:<20}\n", content, label);
}

// A list on as many lines as it needs, `most` items on each; lines that go on are indented by the width of `first`.
std::string list_lines(const std::string& first, const std::vector<std::string>& items, std::size_t most,
                       std::string_view label) {
    std::string text, line = first;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (i > 0 && i % most == 0) {
            text += header_line(line, label);
            line.assign(first.size(), ' ');
        }
        line += items[i];
    }
    return text + header_line(line, label);
}

// The text in exactly `width` columns, cut or filled with spaces; what is not printable ASCII becomes '?'.
std::string in_columns(std::string_view text, std::size_t width) {
    std::string result(width, ' ');
    for (std::size_t i = 0; i < width && i < text.size(); ++i)
        result[i] = text[i] >= ' ' && text[i] <= '~' ? text[i] : '?';
    return result;
}

// PGM / RUN BY / DATE; the date is that of `time` in UTC, so that the same run gives the same bytes on any day.
std::string program_line(std::string_view program, GpsTime time) {
    const UtcTime utc = to_utc(time, LeapSeconds::announced());
    return header_line(in_columns(program, 20) + std::string(20, ' ') +
                           fmt::format("{:04}{:02}{:02} {:02}{:02}{:02} UTC", utc.year, utc.month, utc.day, utc.hour,
                                       utc.minute, utc.second),
                       "PGM / RUN BY / DATE");
}

// D19.12 and D12.4: a three-digit exponent would overflow the field, so what is as small as that is 0.
std::string d_format(double value, int width, int decimals) {
    if (!std::isfinite(value) || std::abs(value) < 1e-90) value = 0;
    std::string text = fmt::format("{:{}.{}E}", value, width, decimals);
    text[text.find('E')] = 'D';
    return text;
}
std::string d19(double value) { return d_format(value, 19, 12); }

using FourFields = std::array<double, 4>;

std::string orbit_line(const FourFields& fields) {
    std::string line = "    ";
    for (const double value : fields)
        line += d19(value);
    return line + "\n";
}

// Satellite, calendar epoch in the record's own time scale, and the clock.
std::string first_line(SatelliteId satellite, const UtcTime& epoch, const std::array<double, 3>& clock) {
    return fmt::format("{} {:04} {:02} {:02} {:02} {:02} {:02}{}{}{}\n", to_string(satellite), epoch.year, epoch.month,
                       epoch.day, epoch.hour, epoch.minute, epoch.second, d19(clock[0]), d19(clock[1]), d19(clock[2]));
}

// The lines 5 to 7, whose meaning depends on the system.
struct SystemLines {
    FourFields line_5{}, line_6{}, line_7{};
};

SystemLines system_lines_of(const KeplerEphemeris& r, std::int64_t week, double sent_tow) {
    const auto whole = [](int value) { return static_cast<double>(value); };
    SystemLines lines{{r.idot, 0, static_cast<double>(week), 0}, {r.accuracy_m, whole(r.health), r.tgd, 0}, {sent_tow}};
    switch (r.satellite.constellation) {
        case Constellation::galileo:
            // I/NAV of E1-B and E5b-I with the clock of E5b, E1; F/NAV of E5a-I with that of E5a, E1.
            lines.line_5[1] = r.message == NavigationMessage::fnav ? 258 : 517;
            lines.line_6[3] = r.tgd2;
            break;
        case Constellation::beidou:
            lines.line_6[3] = r.tgd2;
            lines.line_7[1] = whole(r.iodc);
            break;
        case Constellation::navic:
            break;
        default:
            lines.line_6[3] = whole(r.iodc);
            lines.line_7[1] = r.fit_interval_h;
    }
    return lines;
}

std::string text_of(const KeplerEphemeris& r, GpsTime sent) {
    const Nanoseconds lag = r.satellite.constellation == Constellation::beidou ? bdt_lag : Nanoseconds(0);
    const WeekAndTow toe = week_and_tow(r.toe - lag);
    const bool beidou = lag.count() != 0;
    const std::int64_t week = beidou ? bdt_week_and_tow(r.toe).week : toe.week;
    // The time of week of the transmission counts from the week of toe.
    const double sent_tow = toe.tow_seconds() + difference(sent, r.toe).value();
    const SystemLines own = system_lines_of(r, week, sent_tow);
    return first_line(r.satellite, gps_calendar(r.toc - lag), {r.af0, r.af1, r.af2}) +
           orbit_line({static_cast<double>(r.iode), r.crs, r.delta_n, r.m0}) +
           orbit_line({r.cuc, r.e, r.cus, r.sqrt_a}) + orbit_line({toe.tow_seconds(), r.cic, r.omega0, r.cis}) +
           orbit_line({r.i0, r.crc, r.omega, r.omega_dot}) + orbit_line(own.line_5) + orbit_line(own.line_6) +
           orbit_line(own.line_7);
}

// Three lines of an axis each, kilometres, with what stands in their last columns.
template <class StateVector>
std::string axis_lines(const StateVector& r, const std::array<double, 3>& last) {
    std::string text;
    for (std::size_t i = 0; i < 3; ++i)
        text += orbit_line({r.position_m[i] / 1000, r.velocity_mps[i] / 1000, r.acceleration_mps2[i] / 1000, last[i]});
    return text;
}

std::string text_of(const GlonassEphemeris& r, GpsTime sent) {
    const auto utc = [](GpsTime time) { return time - std::chrono::seconds(LeapSeconds::announced().offset(time)); };
    // GLONASS sends a frame each 30 s; the field is the start of one, in seconds of the UTC week.
    const GpsTime frame(std::chrono::floor<std::chrono::seconds>(utc(sent).time_since_epoch()));
    constexpr double age_of_data_days = 0;
    return first_line(r.satellite, gps_calendar(utc(r.toe)),
                      {r.clock_bias, r.clock_drift, week_and_tow(frame).tow_seconds()}) +
           axis_lines(r, {static_cast<double>(r.health), static_cast<double>(r.frequency_channel), age_of_data_days});
}

std::string text_of(const SbasEphemeris& r, GpsTime sent) {
    return first_line(r.satellite, gps_calendar(r.toe),
                      {r.clock_bias, r.clock_drift, week_and_tow(sent).tow_seconds()}) +
           axis_lines(r, {static_cast<double>(r.health), r.accuracy_m, static_cast<double>(r.iode)});
}

template <std::size_t count>
std::string ionosphere_line(std::string_view name, const std::array<double, count>& values) {
    std::string line = fmt::format("{:<5}", name);
    for (const double value : values)
        line += d_format(value, 12, 4);
    return header_line(line, "IONOSPHERIC CORR");
}

std::string ionosphere_lines(const BroadcastIonosphere& ionosphere) {
    std::string text;
    const auto klobuchar = [&](std::string_view system, const std::optional<KlobucharCoefficients>& c) {
        if (!c) return;
        text += ionosphere_line(fmt::format("{}A", system), c->alpha);
        text += ionosphere_line(fmt::format("{}B", system), c->beta);
    };
    klobuchar("GPS", ionosphere.gps);
    if (ionosphere.galileo) text += ionosphere_line("GAL", *ionosphere.galileo);
    klobuchar("BDS", ionosphere.beidou);
    klobuchar("QZS", ionosphere.qzss);
    klobuchar("IRN", ionosphere.navic);
    return text;
}

}  // namespace
}  // namespace rinex

std::string navigation_header_text(const NavigationTextHeader& header) {
    std::string text = rinex::header_line("     3.04           N: GNSS NAV DATA    M: MIXED", "RINEX VERSION / TYPE") +
                       rinex::program_line(header.program, header.date) + rinex::ionosphere_lines(header.ionosphere);
    if (header.leap_seconds) text += rinex::header_line(fmt::format("{:6}", *header.leap_seconds), "LEAP SECONDS");
    return text + rinex::header_line("", "END OF HEADER");
}

std::string navigation_record_text(const Ephemeris& record, std::optional<GpsTime> sent) {
    const GpsTime first_sent = sent ? *sent : toe_of(record);
    return std::visit([&](const auto& r) { return rinex::text_of(r, first_sent); }, record);
}

std::string navigation_text(std::span<const Ephemeris> records, const NavigationTextHeader& header) {
    std::string text = navigation_header_text(header);
    for (const Ephemeris& record : records)
        text += navigation_record_text(record);
    return text;
}

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
                types.push_back(fmt::format(" {}{}", kind, *rinex_signal_code(system, signal)));
        text += rinex::list_lines(fmt::format("{}  {:3}", rinex_letter(system), types.size()), types, most_types,
                                  "SYS / # / OBS TYPES");
    }
    return text;
}

std::string ObservationWriter::glonass_lines() const {
    constexpr std::size_t most_slots = 8;
    std::vector<std::string> slots;
    for (const auto& [slot, channel] : header_.glonass_channels)
        slots.push_back(fmt::format(" R{:02} {:2}", slot, channel));
    return rinex::list_lines(fmt::format("{:3}", slots.size()), slots, most_slots, "GLONASS SLOT / FRQ #") +
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

}  // namespace skyloop::inline world
