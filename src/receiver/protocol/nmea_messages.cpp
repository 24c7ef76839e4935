#include "receiver/protocol/nmea_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "detail/nmea_field_text.hpp"
#include "receiver/protocol/nmea_sentence.hpp"

namespace skyloop::inline receiver {
namespace {

using namespace nmea_encoding;

constexpr std::size_t grs_slots = 12;

// System and signal, hexadecimal, since version 4.10.
void add_system_and_signal(Sentence& s, std::optional<int> system, std::optional<int> signal,
                           const NmeaFormat& format) {
    if (!since_4_10(format)) return;
    s.text(system ? hex_text(*system) : "").text(signal ? hex_text(*signal) : "");
}

std::string gns_text(const Gns& m, const NmeaFormat& format, int coordinate_decimals) {
    Sentence s(m.talker + "GNS");
    add_time(s, m.time, format);
    add_position(s, m.position, coordinate_decimals);
    std::string modes;
    for (const NmeaMode mode : m.modes)
        modes += static_cast<char>(mode);
    s.text(modes).number(std::clamp(m.satellites_used, 0, 99), format.satellites_padded ? 2 : 1);
    add_dop(s, m.hdop, format.dop_decimals, format.most_dop);
    add_metres(s, m.altitude, format.altitude_decimals);
    add_metres(s, m.geoid_separation, format.altitude_decimals);
    add_decimal(s, m.correction_age ? std::optional(m.correction_age->value()) : std::nullopt, 1);
    add_station(s, m.correction_station, {});
    if (since_4_10(format)) s.letter('V');
    return s.finish();
}

std::string grs_text(const Grs& m, const NmeaFormat& format, int decimals) {
    Sentence s(m.talker + "GRS");
    add_time(s, m.time, format);
    s.number(m.mode);
    const std::size_t shown = std::min(m.residuals.size(), grs_slots);
    for (std::size_t i = 0; i < shown; ++i)
        add_metres(s, m.residuals[i], decimals);
    s.empty(static_cast<int>(grs_slots - shown));
    add_system_and_signal(s, m.system_id, m.signal_id, format);
    return s.finish();
}

// Up to six digits, of which one at least: "0.0", "0.08".
std::string offset_text(double value) {
    std::string text = fixed_decimals(value, 6);
    const std::size_t point = text.find('.');
    while (point != std::string::npos && text.size() > point + 2 && text.back() == '0')
        text.pop_back();
    return text;
}

}  // namespace

std::string encode(const Gns& m, const NmeaFormat& format) {
    return within_limit(format, format.coordinate_decimals,
                        [&](int decimals) { return gns_text(m, format, decimals); });
}

std::string encode(const Gbs& m, const NmeaFormat& format) {
    Sentence s(m.talker + "GBS");
    add_time(s, m.time, format);
    for (const auto& error : {m.latitude, m.longitude, m.altitude})
        add_metres(s, error, 1);
    s.number(m.satellite, 2);
    add_decimal(s, m.missed_probability, 1);
    add_metres(s, m.bias, 1);
    add_metres(s, m.bias_deviation, 1);
    add_system_and_signal(s, m.system_id, m.signal_id, format);
    return s.finish();
}

std::string encode(const Grs& m, const NmeaFormat& format) {
    return within_limit(format, 1, [&](int decimals) { return grs_text(m, format, decimals); });
}

std::string encode(const Dtm& m, const NmeaFormat&) {
    Sentence s(m.talker + "DTM");
    s.text(m.datum).text(m.subdivision);
    s.text(offset_text(std::abs(m.latitude_minutes))).letter(m.latitude_minutes < 0 ? 'S' : 'N');
    s.text(offset_text(std::abs(m.longitude_minutes))).letter(m.longitude_minutes < 0 ? 'W' : 'E');
    return s.decimal(m.altitude_m, 1).text(m.reference).finish();
}

std::string encode(const Vlw& m, const NmeaFormat& format) {
    constexpr double nautical_mile = 1852.0;
    Sentence s(m.talker + "VLW");
    s.empty().letter('N').empty().letter('N');
    if (!since_2_3(format)) return s.finish();
    for (const auto& distance : {m.total, m.since_reset}) {
        add_decimal(s, distance ? std::optional(distance->value() / nautical_mile) : std::nullopt, 3);
        s.letter('N');
    }
    return s.finish();
}

namespace {

std::string heading_text(const std::optional<Angle>& heading, const NmeaFormat& format) {
    return heading ? course_text(*heading, format.heading_decimals) : "";
}

// Its amount, and E or W.
void add_variation(Sentence& s, double degrees) { s.decimal(std::abs(degrees), 1).letter(degrees < 0 ? 'W' : 'E'); }

}  // namespace

std::string encode(const Ths& m, const NmeaFormat& format) {
    return Sentence(m.talker + "THS").text(heading_text(m.heading, format)).letter(m.mode).finish();
}

std::string encode(const Hdt& m, const NmeaFormat& format) {
    return Sentence(m.talker + "HDT").text(heading_text(m.heading, format)).letter('T').finish();
}

std::string encode(const Hdg& m, const NmeaFormat& format) {
    Sentence s(m.talker + "HDG");
    s.text(heading_text(m.magnetic_heading, format)).empty(2);
    if (m.variation)
        add_variation(s, m.variation->deg());
    else
        s.empty(2);
    return s.finish();
}

std::string encode(const Rot& m, const NmeaFormat&) {
    Sentence s(m.talker + "ROT");
    add_decimal(s, m.degrees_per_minute, 1);
    return s.letter(m.valid ? 'A' : 'V').finish();
}

namespace {

constexpr std::size_t gsa_slots = 12;
constexpr std::size_t gsv_slots = 4;
constexpr std::size_t gsv_most_pages = 9;

// Since version 2.3 (RECEIVER.md 5.2).
void add_mode(Sentence& sentence, const std::optional<NmeaMode>& mode, const NmeaFormat& format) {
    if (since_2_3(format)) sentence.text(mode ? std::string(1, static_cast<char>(*mode)) : std::string());
}

void add_deviation(Sentence& sentence, const std::optional<Metres>& deviation, const NmeaFormat& format) {
    if (!deviation)
        sentence.empty();
    else
        sentence.text(format.deviations_padded ? fmt::format("{:05.1f}", deviation->value())
                                               : deviation_text(*deviation));
}

void add_clamped(Sentence& sentence, const std::optional<int>& value, int last, int digits) {
    sentence.number(value ? std::optional(std::clamp(*value, 0, last)) : std::nullopt, digits);
}

std::string gga_text(const Gga& m, const NmeaFormat& format, int coordinate_decimals) {
    Sentence s(m.talker + "GGA");
    add_time(s, m.time, format);
    add_position(s, m.position, coordinate_decimals);
    s.number(m.quality).number(std::clamp(m.satellites_used, 0, 99), format.satellites_padded ? 2 : 1);
    add_dop(s, m.hdop, format.dop_decimals, format.most_dop);
    for (const auto& height : {m.altitude, m.geoid_separation}) {
        if (height && std::isfinite(height->value()))
            s.decimal(height->value(), format.altitude_decimals).letter('M');
        else if (format.units_always)
            s.empty().letter('M');
        else
            s.empty(2);
    }
    add_decimal(s, m.correction_age ? std::optional(m.correction_age->value()) : std::nullopt, 1);
    add_station(s, m.correction_station, format.no_station);
    return s.finish();
}

// Characters that would end or split a sentence, as ^hh (NMEA 0183, 5.1.3).
std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        const bool plain = c >= 0x20 && c <= 0x7e && std::string_view("$*,!\\^~").find(c) == std::string_view::npos;
        out += plain ? std::string(1, c) : fmt::format("^{:02X}", static_cast<unsigned char>(c));
    }
    return out;
}

}  // namespace

UtcTime rounded_utc(GpsTime time, int decimals, const LeapSeconds& leap_seconds) {
    const std::int64_t step = 1'000'000'000 / power_of_ten(decimals);
    const std::int64_t count = time.time_since_epoch().count() + step / 2;
    const std::int64_t below = ((count % step) + step) % step;
    return to_utc(GpsTime(Nanoseconds(count - below)), leap_seconds);
}

NmeaTime nmea_time(const UtcTime& utc) { return {utc.hour, utc.minute, utc.second, utc.nanosecond}; }
NmeaDate nmea_date(const UtcTime& utc) { return {utc.year, utc.month, utc.day}; }

std::vector<Gsv> gsv_pages(const std::string& talker, const std::vector<GsvSatellite>& satellites,
                           std::optional<int> signal_id) {
    const std::size_t shown = std::min(satellites.size(), gsv_slots * gsv_most_pages);
    const std::size_t count = std::max<std::size_t>(1, (shown + gsv_slots - 1) / gsv_slots);
    std::vector<Gsv> pages;
    for (std::size_t page = 0; page < count; ++page) {
        const auto first = satellites.begin() + static_cast<std::ptrdiff_t>(page * gsv_slots);
        const auto last = satellites.begin() + static_cast<std::ptrdiff_t>(std::min(shown, (page + 1) * gsv_slots));
        pages.push_back({talker,
                         static_cast<int>(count),
                         static_cast<int>(page + 1),
                         static_cast<int>(shown),
                         {first, last},
                         signal_id});
    }
    return pages;
}

std::string encode(const Rmc& m, const NmeaFormat& format) {
    Sentence s(m.talker + "RMC");
    add_time(s, m.time, format);
    s.letter(m.valid ? 'A' : 'V');
    add_position(s, m.position, format.coordinate_decimals);
    add_decimal(s, m.speed ? std::optional(in_knots(*m.speed)) : std::nullopt, format.speed_decimals);
    s.text(m.course ? course_text(*m.course, format.course_decimals) : "").text(m.date ? date_text(*m.date) : "");
    if (format.magnetic_fields)
        add_variation(s, format.magnetic_variation_deg);
    else
        s.empty(2);
    add_mode(s, m.mode, format);
    if (since_4_10(format)) s.letter(m.valid ? format.rmc_status : 'V');
    return s.finish();
}

std::string encode(const Vtg& m, const NmeaFormat& format) {
    Sentence s(m.talker + "VTG");
    if (!m.speed) {
        s.empty(8);
    } else {
        const auto own = [](int decimals, int of_rmc) { return decimals < 0 ? of_rmc : decimals; };
        const int speed_decimals = own(format.vtg_speed_decimals, format.speed_decimals);
        const int course_decimals = own(format.vtg_course_decimals, format.course_decimals);
        const Angle variation = Angle::degrees(format.magnetic_variation_deg);
        s.text(m.course ? course_text(*m.course, course_decimals) : "").letter('T');
        const bool magnetic = m.course && format.magnetic_fields;
        s.text(magnetic ? course_text(*m.course - variation, course_decimals) : "").letter('M');
        s.decimal(in_knots(*m.speed), speed_decimals).letter('N');
        s.decimal(in_kmh(*m.speed), speed_decimals).letter('K');
    }
    add_mode(s, m.mode, format);
    return s.finish();
}

std::string encode(const Gga& m, const NmeaFormat& format) {
    return within_limit(format, format.coordinate_decimals,
                        [&](int decimals) { return gga_text(m, format, decimals); });
}

std::string encode(const Gsa& m, const NmeaFormat& format) {
    Sentence s(m.talker + "GSA");
    s.text(m.has_mode ? (m.automatic ? "A" : "M") : "").number(m.fix_mode);
    const std::size_t shown = std::min(m.satellites.size(), gsa_slots);
    for (std::size_t i = 0; i < shown; ++i)
        s.number(m.satellites[i], 2);
    s.empty(static_cast<int>(gsa_slots - shown));
    for (const auto& dop : {m.pdop, m.hdop, m.vdop})
        add_dop(s, dop, format.dop_decimals, format.most_dop);
    if (since_4_10(format)) s.text(m.system_id ? hex_text(*m.system_id) : "");
    return s.finish();
}

std::string encode(const Gsv& m, const NmeaFormat& format) {
    Sentence s(m.talker + "GSV");
    s.number(m.pages).number(m.page).number(m.satellites_in_view, 2);
    for (std::size_t i = 0; i < std::min(m.satellites.size(), gsv_slots); ++i) {
        const GsvSatellite& satellite = m.satellites[i];
        s.number(satellite.number, 2);
        add_clamped(s, satellite.elevation_deg, 90, 2);
        add_clamped(s, satellite.azimuth_deg ? std::optional(*satellite.azimuth_deg % 360) : std::nullopt, 359, 3);
        add_clamped(s, satellite.cn0_dbhz, 99, 2);
    }
    const bool empty = m.satellites.empty() && format.empty_gsv_fields;
    if (empty) s.empty(4);
    if (since_4_10(format)) s.text(m.signal_id && !empty ? hex_text(*m.signal_id) : "");
    return s.finish();
}

std::string encode(const Gll& m, const NmeaFormat& format) {
    Sentence s(m.talker + "GLL");
    add_position(s, m.position, format.coordinate_decimals);
    add_time(s, m.time, format);
    s.letter(m.valid ? 'A' : 'V');
    add_mode(s, m.mode, format);
    return s.finish();
}

std::string encode(const Gst& m, const NmeaFormat& format) {
    Sentence s(m.talker + "GST");
    add_time(s, m.time, format);
    add_deviation(s, m.range_rms, format);
    add_deviation(s, m.semi_major, format);
    add_deviation(s, m.semi_minor, format);
    if (format.deviations_padded && m.orientation)
        s.text(fmt::format("{:05.1f}", m.orientation->deg()));
    else
        s.text(m.orientation ? course_text(*m.orientation, 0) : "");
    add_deviation(s, m.latitude, format);
    add_deviation(s, m.longitude, format);
    if (format.deviations_padded && m.altitude)
        s.text(fmt::format("{:05.0f}", m.altitude->value()));
    else
        add_deviation(s, m.altitude, format);
    return s.finish();
}

std::string encode(const Zda& m, const NmeaFormat& format) {
    Sentence s(m.talker + "ZDA");
    add_time(s, m.time, format);
    if (m.date)
        s.text(fmt::format("{:02}", m.date->day))
            .text(fmt::format("{:02}", m.date->month))
            .text(fmt::format("{:04}", m.date->year));
    else
        s.empty(3);
    return s.text("00").text("00").finish();
}

std::string encode(const Txt& m, const NmeaFormat&) {
    return Sentence(m.talker + "TXT")
        .number(m.count, 2)
        .number(m.index, 2)
        .number(m.type, 2)
        .text(escaped(m.text))
        .finish();
}

std::string encode(const NmeaMessage& message, const NmeaFormat& format) {
    return std::visit([&](const auto& m) { return encode(m, format); }, message);
}

}  // namespace skyloop::inline receiver
