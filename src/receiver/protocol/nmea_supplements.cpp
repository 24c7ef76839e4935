#include "receiver/protocol/nmea_supplements.hpp"

#include <algorithm>
#include <cmath>

#include "detail/nmea_encoding.hpp"

namespace skyloop {
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
    add_dop(s, m.hdop, format.dop_decimals);
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
    if (m.satellite)
        s.number(*m.satellite, 2);
    else
        s.empty();
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

std::string encode(const Ths& m, const NmeaFormat&) {
    return Sentence(m.talker + "THS").text(m.heading ? course_text(*m.heading, 2) : "").letter(m.mode).finish();
}

std::string encode(const Hdt& m, const NmeaFormat&) {
    return Sentence(m.talker + "HDT").text(m.heading ? course_text(*m.heading, 2) : "").letter('T').finish();
}

}  // namespace skyloop
