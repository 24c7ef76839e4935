#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "detail/nmea_field_text.hpp"
#include "receiver/protocol/nmea_messages.hpp"

namespace skyloop::inline receiver {
namespace {

using namespace nmea_decoding;

std::optional<MetresPerSecond> from_knots(std::optional<double> knots) {
    return knots ? std::optional(MetresPerSecond(*knots * 1852.0 / 3600.0)) : std::nullopt;
}

// Speeds, m/s, that a field of this many decimals may stand for.
struct SpeedSpan {
    double low;
    double high;
};
SpeedSpan speed_span(double value, std::string_view field, double unit) {
    const std::size_t point = field.find('.');
    const std::size_t decimals = point == std::string_view::npos ? 0 : field.size() - point - 1;
    const double half_digit = 0.5 * std::pow(10.0, -static_cast<double>(decimals));
    return {(value - half_digit) * unit, (value + half_digit) * unit};
}

// Knots and km/h round the same speed differently: it lies where both agree. Where they contradict, knots count.
std::optional<MetresPerSecond> course_speed(FieldReader& r) {
    constexpr std::size_t knots_at = 4, kmh_at = 6;
    const auto knots = r.number(knots_at, "a speed"), kmh = r.number(kmh_at, "a speed");
    if (!knots || !kmh) return kmh ? std::optional(MetresPerSecond(*kmh / 3.6)) : from_knots(knots);
    const SpeedSpan a = speed_span(*knots, r.text(knots_at), 1852.0 / 3600.0);
    const SpeedSpan b = speed_span(*kmh, r.text(kmh_at), 1.0 / 3.6);
    const double low = std::max({a.low, b.low, 0.0}), high = std::min(a.high, b.high);
    return low <= high ? std::optional(MetresPerSecond((low + high) / 2)) : from_knots(knots);
}

void read(Rmc& m, FieldReader& r) {
    m.time = r.time(0);
    m.valid = r.either(1, "AV", "A or V");
    m.position = r.position(2);
    m.speed = from_knots(r.number(6, "a speed"));
    m.course = r.degrees(7, "a course");
    m.date = r.packed_date(8);
    m.mode = r.mode(11);
}

void read(Vtg& m, FieldReader& r) {
    m.course = r.degrees(0, "a course");
    m.speed = course_speed(r);
    m.mode = r.mode(8);
}

void read(Gga& m, FieldReader& r) {
    m.time = r.time(0);
    m.position = r.position(1);
    m.quality = r.integer(5, "a fix quality").value_or(0);
    m.satellites_used = r.integer(6, "a number of satellites").value_or(0);
    m.hdop = r.number(7, "a DOP");
    m.altitude = r.metres(8, "an altitude");
    m.geoid_separation = r.metres(10, "a geoid separation");
    if (const auto age = r.number(12, "an age of corrections")) m.correction_age = Seconds(*age);
    m.correction_station = r.integer(13, "a station number");
}

void read(Gsa& m, FieldReader& r) {
    constexpr std::size_t first = 2, last = 14;
    m.automatic = r.either(0, "AM", "A or M");
    m.fix_mode = r.integer(1, "a fix mode").value_or(1);
    for (std::size_t i = first; i < last; ++i)
        if (const auto number = r.integer(i, "a satellite")) m.satellites.push_back(*number);
    m.pdop = r.number(14, "a DOP");
    m.hdop = r.number(15, "a DOP");
    m.vdop = r.number(16, "a DOP");
    m.system_id = r.integer(17, "a system id", 16);
}

void read(Gsv& m, FieldReader& r) {
    constexpr std::size_t header = 3, block = 4;
    m.pages = r.integer(0, "a number of pages").value_or(1);
    m.page = r.integer(1, "a page").value_or(1);
    m.satellites_in_view = r.integer(2, "a number of satellites").value_or(0);
    const std::size_t rest = r.size() < header ? 0 : r.size() - header;
    const std::size_t blocks = std::min<std::size_t>(rest / block, 4);
    for (std::size_t k = 0; k < blocks; ++k) {
        const std::size_t at = header + k * block;
        GsvSatellite satellite;
        satellite.number = r.integer(at, "a satellite");
        satellite.elevation_deg = r.integer(at + 1, "an elevation");
        satellite.azimuth_deg = r.integer(at + 2, "an azimuth");
        satellite.cn0_dbhz = r.integer(at + 3, "a C/N0");
        // Receivers before 4.10 may pad the last page with empty places.
        if (satellite != GsvSatellite{}) m.satellites.push_back(satellite);
    }
    if (rest % block == 1) m.signal_id = r.integer(r.size() - 1, "a signal id", 16);
}

void read(Gll& m, FieldReader& r) {
    m.position = r.position(0);
    m.time = r.time(4);
    m.valid = r.either(5, "AV", "A or V");
    m.mode = r.mode(6);
}

void read(Gst& m, FieldReader& r) {
    m.time = r.time(0);
    m.range_rms = r.metres(1, "a deviation");
    m.semi_major = r.metres(2, "a deviation");
    m.semi_minor = r.metres(3, "a deviation");
    m.orientation = r.degrees(4, "an angle");
    m.latitude = r.metres(5, "a deviation");
    m.longitude = r.metres(6, "a deviation");
    m.altitude = r.metres(7, "a deviation");
}

void read(Zda& m, FieldReader& r) {
    m.time = r.time(0);
    m.date = r.date(1, 2, 3);
}

std::string unescaped(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned code = 0;
        if (text[i] == '^' && i + 2 < text.size() &&
            std::from_chars(text.data() + i + 1, text.data() + i + 3, code, 16).ptr == text.data() + i + 3) {
            out += static_cast<char>(code);
            i += 2;
        } else {
            out += text[i];
        }
    }
    return out;
}

void read(Txt& m, FieldReader& r) {
    m.count = r.integer(0, "a number of sentences").value_or(1);
    m.index = r.integer(1, "a sentence number").value_or(1);
    m.type = r.integer(2, "a text type").value_or(0);
    std::string text(r.text(3));
    // Some receivers write commas into the text as they are.
    for (std::size_t i = 4; i < r.size(); ++i)
        text += "," + std::string(r.text(i));
    m.text = unescaped(text);
}

void read(Gns& m, FieldReader& r) {
    m.time = r.time(0);
    m.position = r.position(1);
    for (const char letter : r.text(5)) {
        if (std::string_view("NADEFRMSP").find(letter) == std::string_view::npos) r.refuse(5, "mode indicators");
        m.modes.push_back(static_cast<NmeaMode>(letter));
    }
    m.satellites_used = r.integer(6, "a number of satellites").value_or(0);
    m.hdop = r.number(7, "a DOP");
    m.altitude = r.metres(8, "an altitude");
    m.geoid_separation = r.metres(9, "a geoid separation");
    if (const auto age = r.number(10, "an age of corrections")) m.correction_age = Seconds(*age);
    m.correction_station = r.integer(11, "a station number");
}

void read(Gbs& m, FieldReader& r) {
    m.time = r.time(0);
    m.latitude = r.metres(1, "an error");
    m.longitude = r.metres(2, "an error");
    m.altitude = r.metres(3, "an error");
    m.satellite = r.integer(4, "a satellite");
    m.missed_probability = r.number(5, "a probability");
    m.bias = r.metres(6, "a bias");
    m.bias_deviation = r.metres(7, "a deviation");
    m.system_id = r.integer(8, "a system id", 16);
    m.signal_id = r.integer(9, "a signal id", 16);
}

void read(Grs& m, FieldReader& r) {
    constexpr std::size_t first = 2, last = 14;
    m.time = r.time(0);
    m.mode = r.integer(1, "a mode").value_or(0);
    for (std::size_t i = first; i < last; ++i)
        m.residuals.push_back(r.metres(i, "a residual"));
    while (!m.residuals.empty() && !m.residuals.back())
        m.residuals.pop_back();
    m.system_id = r.integer(14, "a system id", 16);
    m.signal_id = r.integer(15, "a signal id", 16);
}

void read(Dtm& m, FieldReader& r) {
    m.datum = r.text(0);
    m.subdivision = r.text(1);
    const double north = r.number(2, "an offset").value_or(0), east = r.number(4, "an offset").value_or(0);
    m.latitude_minutes = r.either(3, "NS", "N or S") ? north : -north;
    m.longitude_minutes = r.either(5, "EW", "E or W") ? east : -east;
    m.altitude_m = r.number(6, "an offset").value_or(0);
    m.reference = r.text(7);
}

void read(Vlw& m, FieldReader& r) {
    constexpr double nautical_mile = 1852.0;
    if (const auto total = r.number(4, "a distance")) m.total = Metres(*total * nautical_mile);
    if (const auto trip = r.number(6, "a distance")) m.since_reset = Metres(*trip * nautical_mile);
}

void read(Ths& m, FieldReader& r) {
    m.heading = r.degrees(0, "a heading");
    if (r.text(1).size() != 1 || std::string_view("AEMSV").find(r.text(1)[0]) == std::string_view::npos)
        r.refuse(1, "a mode");
    else
        m.mode = r.text(1)[0];
}

void read(Hdt& m, FieldReader& r) {
    m.heading = r.degrees(0, "a heading");
    r.either(1, "T", "T");
}

// An amount and a side, negative for the west.
std::optional<Angle> sided_angle(FieldReader& r, std::size_t i) {
    const auto amount = r.degrees(i, "an angle");
    if (!amount) return std::nullopt;
    return r.either(i + 1, "EW", "E or W") ? amount : std::optional(-*amount);
}

void read(Hdg& m, FieldReader& r) {
    const auto sensor = r.degrees(0, "a heading"), deviation = sided_angle(r, 1);
    if (sensor) m.magnetic_heading = *sensor + deviation.value_or(Angle());
    m.variation = sided_angle(r, 3);
}

void read(Rot& m, FieldReader& r) {
    m.degrees_per_minute = r.number(0, "a rate of turn");
    m.valid = r.either(1, "AV", "A or V");
}

template <class Message, std::size_t least_fields>
Result<NmeaMessage> decode(FieldReader r) {
    Message message;
    message.talker = r.talker();
    read(message, r);
    if (const Result<void> good = r.verdict(least_fields); !good) return fail(good.error());
    return NmeaMessage(std::move(message));
}

struct Decoder {
    std::string_view formatter;
    Result<NmeaMessage> (*decode)(FieldReader);
};
constexpr std::array<Decoder, 18> decoders{{{"RMC", decode<Rmc, 9>},
                                            {"VTG", decode<Vtg, 8>},
                                            {"GGA", decode<Gga, 12>},
                                            {"GSA", decode<Gsa, 17>},
                                            {"GSV", decode<Gsv, 3>},
                                            {"GLL", decode<Gll, 6>},
                                            {"GST", decode<Gst, 8>},
                                            {"ZDA", decode<Zda, 4>},
                                            {"TXT", decode<Txt, 4>},
                                            {"GNS", decode<Gns, 12>},
                                            {"GBS", decode<Gbs, 8>},
                                            {"GRS", decode<Grs, 14>},
                                            {"DTM", decode<Dtm, 8>},
                                            {"VLW", decode<Vlw, 4>},
                                            {"THS", decode<Ths, 2>},
                                            {"HDT", decode<Hdt, 2>},
                                            {"HDG", decode<Hdg, 5>},
                                            {"ROT", decode<Rot, 2>}}};

}  // namespace

Result<NmeaMessage> decode_nmea(const SentenceView& sentence) {
    for (const Decoder& decoder : decoders)
        if (sentence.address.size() == 5 && sentence.formatter() == decoder.formatter)
            return decoder.decode(FieldReader(sentence));
    return fail(ErrorCode::input, fmt::format("{}: not a sentence that is read here", sentence.address));
}

Result<NmeaMessage> decode_nmea(std::string_view line) {
    const Result<SentenceView> sentence = parse_sentence(line);
    if (!sentence) return fail(sentence.error());
    return decode_nmea(*sentence);
}

}  // namespace skyloop::inline receiver
