#include "skyloop/protocol/nmea_decode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>

namespace skyloop {
namespace {

// Reads the fields of one sentence; remembers the first that is not what its place demands.
class FieldReader {
public:
    explicit FieldReader(const SentenceView& sentence) : sentence_(sentence) {}

    [[nodiscard]] std::size_t size() const { return sentence_.fields.size(); }
    [[nodiscard]] std::string_view text(std::size_t i) const { return sentence_.field(i); }
    [[nodiscard]] std::string talker() const { return std::string(sentence_.talker()); }

    std::optional<double> number(std::size_t i, std::string_view what) {
        const std::string_view field = text(i);
        if (field.empty()) return std::nullopt;
        double value = 0;
        const auto [end, error] =
            std::from_chars(field.data(), field.data() + field.size(), value, std::chars_format::fixed);
        if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) return refuse(i, what);
        return value;
    }

    std::optional<int> integer(std::size_t i, std::string_view what, int base = 10) {
        const std::string_view field = text(i);
        if (field.empty()) return std::nullopt;
        int value = 0;
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value, base);
        if (error != std::errc() || end != field.data() + field.size() || value < 0) return refuse(i, what);
        return value;
    }

    std::optional<Metres> metres(std::size_t i, std::string_view what) {
        const auto value = number(i, what);
        return value ? std::optional(Metres(*value)) : std::nullopt;
    }

    std::optional<Angle> degrees(std::size_t i, std::string_view what) {
        const auto value = number(i, what);
        return value ? std::optional(Angle::degrees(*value)) : std::nullopt;
    }

    // One of two letters; true for the first.
    bool either(std::size_t i, std::string_view letters, std::string_view what) {
        const std::string_view field = text(i);
        if (field.size() != 1 || letters.find(field[0]) == std::string_view::npos) refuse(i, what);
        return !field.empty() && field[0] == letters[0];
    }

    std::optional<NmeaTime> time(std::size_t i);
    std::optional<NmeaDate> date(std::size_t day_at, std::size_t month_at, std::size_t year_at);
    std::optional<NmeaDate> packed_date(std::size_t i);
    std::optional<NmeaPosition> position(std::size_t i);
    std::optional<NmeaMode> mode(std::size_t i);

    std::nullopt_t refuse(std::size_t i, std::string_view what) {
        if (error_.empty())
            error_ = fmt::format("{}: field {} is '{}'; expected {}", sentence_.address, i + 1, text(i), what);
        return std::nullopt;
    }

    template <class Message>
    Result<NmeaMessage> finish(Message message, std::size_t least_fields) const {
        if (size() < least_fields)
            return fail(ErrorCode::input,
                        fmt::format("{}: {} fields; expected at least {}", sentence_.address, size(), least_fields));
        if (!error_.empty()) return fail(ErrorCode::input, error_);
        return NmeaMessage(std::move(message));
    }

private:
    std::optional<double> coordinate(std::size_t i, std::string_view hemispheres, double limit);

    const SentenceView& sentence_;
    std::string error_;
};

bool decimal_digits(std::string_view text) { return text.find_first_not_of("0123456789") == std::string_view::npos; }

unsigned two_digits(std::string_view text, std::size_t at) {
    return static_cast<unsigned>((text[at] - '0') * 10 + (text[at + 1] - '0'));
}

bool calendar_day(const NmeaDate& d) {
    return (std::chrono::year(d.year) / static_cast<int>(d.month) / static_cast<int>(d.day)).ok();
}

std::optional<NmeaTime> FieldReader::time(std::size_t i) {
    constexpr std::string_view expected = "a time hhmmss.ss";
    const std::string_view field = text(i);
    if (field.empty()) return std::nullopt;
    const bool fraction = field.size() > 7;
    if (field.size() < 6 || !decimal_digits(field.substr(0, 6)) || (field.size() > 6 && field[6] != '.') ||
        (fraction && !decimal_digits(field.substr(7))) || field.size() > 16)
        return refuse(i, expected);
    NmeaTime time{two_digits(field, 0), two_digits(field, 2), two_digits(field, 4), 0};
    std::uint32_t scale = 100'000'000;
    for (std::size_t k = 7; k < field.size(); ++k, scale /= 10)
        time.nanosecond += static_cast<std::uint32_t>(field[k] - '0') * scale;
    if (time.hour > 23 || time.minute > 59 || time.second > 60) return refuse(i, expected);
    return time;
}

std::optional<NmeaDate> FieldReader::packed_date(std::size_t i) {
    const std::string_view field = text(i);
    if (field.empty()) return std::nullopt;
    if (field.size() != 6 || !decimal_digits(field)) return refuse(i, "a date ddmmyy");
    const int year = static_cast<int>(two_digits(field, 4));
    const NmeaDate date{year + (year < 80 ? 2000 : 1900), two_digits(field, 2), two_digits(field, 0)};
    if (!calendar_day(date)) return refuse(i, "a date ddmmyy");
    return date;
}

std::optional<NmeaDate> FieldReader::date(std::size_t day_at, std::size_t month_at, std::size_t year_at) {
    const auto day = integer(day_at, "a day"), month = integer(month_at, "a month"), year = integer(year_at, "a year");
    if (!day && !month && !year) return std::nullopt;
    const NmeaDate date{year.value_or(0), static_cast<unsigned>(month.value_or(0)),
                        static_cast<unsigned>(day.value_or(0))};
    if (!day || !month || !year || date.month > 12 || date.day > 31 || date.year > 9999 || !calendar_day(date))
        return refuse(day_at, "a day of the calendar");
    return date;
}

std::optional<double> FieldReader::coordinate(std::size_t i, std::string_view hemispheres, double limit) {
    const std::string_view expected = limit < 100 ? "a latitude ddmm.mmmmm" : "a longitude dddmm.mmmmm";
    const auto value = number(i, expected);
    if (!value) return std::nullopt;
    const double degrees = std::floor(*value / 100.0);
    // The minutes are read from their own digits: taking the degrees off first would cost the last ones.
    const std::size_t point = std::min(text(i).find('.'), text(i).size());
    double minutes = 0;
    const std::string_view digits = text(i).substr(point < 2 ? 0 : point - 2);
    std::from_chars(digits.data(), digits.data() + digits.size(), minutes, std::chars_format::fixed);
    const double total = degrees + minutes / 60.0;
    if (*value < 0 || text(i).front() == '-' || minutes >= 60.0 || total > limit) return refuse(i, expected);
    return either(i + 1, hemispheres, limit < 100 ? "N or S" : "E or W") ? total : -total;
}

std::optional<NmeaPosition> FieldReader::position(std::size_t i) {
    const auto latitude = coordinate(i, "NS", 90), longitude = coordinate(i + 2, "EW", 180);
    if (!latitude || !longitude) {
        if (latitude || longitude) refuse(latitude ? i + 2 : i, "a coordinate beside the other");
        return std::nullopt;
    }
    return NmeaPosition{Angle::degrees(*latitude), Angle::degrees(*longitude)};
}

std::optional<NmeaMode> FieldReader::mode(std::size_t i) {
    const std::string_view field = text(i);
    if (field.empty()) return std::nullopt;
    if (field.size() != 1 || std::string_view("NADEFRMSP").find(field[0]) == std::string_view::npos)
        return refuse(i, "a mode indicator");
    return static_cast<NmeaMode>(field[0]);
}

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

Result<NmeaMessage> decode_rmc(FieldReader r) {
    Rmc m;
    m.talker = r.talker();
    m.time = r.time(0);
    m.valid = r.either(1, "AV", "A or V");
    m.position = r.position(2);
    m.speed = from_knots(r.number(6, "a speed"));
    m.course = r.degrees(7, "a course");
    m.date = r.packed_date(8);
    m.mode = r.mode(11);
    return r.finish(std::move(m), 9);
}

Result<NmeaMessage> decode_vtg(FieldReader r) {
    Vtg m;
    m.talker = r.talker();
    m.course = r.degrees(0, "a course");
    m.speed = course_speed(r);
    m.mode = r.mode(8);
    return r.finish(std::move(m), 8);
}

Result<NmeaMessage> decode_gga(FieldReader r) {
    Gga m;
    m.talker = r.talker();
    m.time = r.time(0);
    m.position = r.position(1);
    m.quality = r.integer(5, "a fix quality").value_or(0);
    m.satellites_used = r.integer(6, "a number of satellites").value_or(0);
    m.hdop = r.number(7, "a DOP");
    m.altitude = r.metres(8, "an altitude");
    m.geoid_separation = r.metres(10, "a geoid separation");
    if (const auto age = r.number(12, "an age of corrections")) m.correction_age = Seconds(*age);
    m.correction_station = r.integer(13, "a station number");
    return r.finish(std::move(m), 12);
}

Result<NmeaMessage> decode_gsa(FieldReader r) {
    constexpr std::size_t first = 2, last = 14;
    Gsa m;
    m.talker = r.talker();
    m.automatic = r.either(0, "AM", "A or M");
    m.fix_mode = r.integer(1, "a fix mode").value_or(1);
    for (std::size_t i = first; i < last; ++i)
        if (const auto number = r.integer(i, "a satellite")) m.satellites.push_back(*number);
    m.pdop = r.number(14, "a DOP");
    m.hdop = r.number(15, "a DOP");
    m.vdop = r.number(16, "a DOP");
    m.system_id = r.integer(17, "a system id", 16);
    return r.finish(std::move(m), 17);
}

Result<NmeaMessage> decode_gsv(FieldReader r) {
    constexpr std::size_t header = 3, block = 4;
    Gsv m;
    m.talker = r.talker();
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
    return r.finish(std::move(m), header);
}

Result<NmeaMessage> decode_gll(FieldReader r) {
    Gll m;
    m.talker = r.talker();
    m.position = r.position(0);
    m.time = r.time(4);
    m.valid = r.either(5, "AV", "A or V");
    m.mode = r.mode(6);
    return r.finish(std::move(m), 6);
}

Result<NmeaMessage> decode_gst(FieldReader r) {
    Gst m;
    m.talker = r.talker();
    m.time = r.time(0);
    m.range_rms = r.metres(1, "a deviation");
    m.semi_major = r.metres(2, "a deviation");
    m.semi_minor = r.metres(3, "a deviation");
    m.orientation = r.degrees(4, "an angle");
    m.latitude = r.metres(5, "a deviation");
    m.longitude = r.metres(6, "a deviation");
    m.altitude = r.metres(7, "a deviation");
    return r.finish(std::move(m), 8);
}

Result<NmeaMessage> decode_zda(FieldReader r) {
    Zda m;
    m.talker = r.talker();
    m.time = r.time(0);
    m.date = r.date(1, 2, 3);
    return r.finish(std::move(m), 4);
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

Result<NmeaMessage> decode_txt(FieldReader r) {
    Txt m;
    m.talker = r.talker();
    m.count = r.integer(0, "a number of sentences").value_or(1);
    m.index = r.integer(1, "a sentence number").value_or(1);
    m.type = r.integer(2, "a text type").value_or(0);
    std::string text(r.text(3));
    // Some receivers write commas into the text as they are.
    for (std::size_t i = 4; i < r.size(); ++i)
        text += "," + std::string(r.text(i));
    m.text = unescaped(text);
    return r.finish(std::move(m), 4);
}

struct Decoder {
    std::string_view formatter;
    Result<NmeaMessage> (*decode)(FieldReader);
};
constexpr std::array<Decoder, 9> decoders{{{"RMC", decode_rmc},
                                           {"VTG", decode_vtg},
                                           {"GGA", decode_gga},
                                           {"GSA", decode_gsa},
                                           {"GSV", decode_gsv},
                                           {"GLL", decode_gll},
                                           {"GST", decode_gst},
                                           {"ZDA", decode_zda},
                                           {"TXT", decode_txt}}};

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

}  // namespace skyloop
