#include "world/rinex/navigation_writer.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <string_view>

#include "base/time/utc_time.hpp"
#include "detail/header_text.hpp"

namespace skyloop {
namespace rinex {
namespace {

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

}  // namespace skyloop
