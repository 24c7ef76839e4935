#include "skyloop/protocol/nmea_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "skyloop/protocol/nmea_sentence.hpp"

namespace skyloop {
namespace {

constexpr std::size_t longest_sentence = 82;  // NMEA 0183, 5.3: with "$" and line end
constexpr std::size_t gsa_slots = 12;
constexpr std::size_t gsv_slots = 4;
constexpr std::size_t gsv_most_pages = 9;
constexpr double largest_dop = 99.99;
constexpr std::array<std::int64_t, 10> powers_of_ten{1,       10,        100,        1'000,       10'000,
                                                     100'000, 1'000'000, 10'000'000, 100'000'000, 1'000'000'000};

std::int64_t power_of_ten(int decimals) { return powers_of_ten[static_cast<std::size_t>(std::clamp(decimals, 0, 9))]; }

std::string time_text(const NmeaTime& time, int decimals) {
    std::string text = fmt::format("{:02}{:02}{:02}", time.hour, time.minute, time.second);
    if (decimals > 0) text += fmt::format(".{:09}", time.nanosecond).substr(0, static_cast<std::size_t>(decimals) + 1);
    return text;
}

void add_time(Sentence& sentence, const std::optional<NmeaTime>& time, const NmeaFormat& format) {
    sentence.text(time ? time_text(*time, format.time_decimals) : std::string());
}

// Degrees and minutes from one integer, so that 59.999996 minutes carry into the degrees.
void add_coordinate(Sentence& sentence, double degrees, int degree_digits, std::string_view hemispheres, int decimals) {
    const std::int64_t scale = power_of_ten(decimals);
    const std::int64_t units = std::llround(std::abs(degrees) * 60.0 * static_cast<double>(scale));
    const std::int64_t minutes = units % (60 * scale);
    std::string text = fmt::format("{:0{}}{:02}", units / (60 * scale), degree_digits, minutes / scale);
    if (decimals > 0) text += fmt::format(".{:0{}}", minutes % scale, decimals);
    sentence.text(text).letter(degrees < 0 && units != 0 ? hemispheres[1] : hemispheres[0]);
}

void add_position(Sentence& sentence, const std::optional<NmeaPosition>& position, int decimals) {
    if (!position || !std::isfinite(position->latitude.rad()) || !std::isfinite(position->longitude.rad())) {
        sentence.empty(4);
        return;
    }
    const double longitude = position->longitude.deg();
    const bool in_range = std::abs(longitude) <= 180.0;
    add_coordinate(sentence, std::clamp(position->latitude.deg(), -90.0, 90.0), 2, "NS", decimals);
    add_coordinate(sentence, in_range ? longitude : std::remainder(longitude, 360.0), 3, "EW", decimals);
}

void add_decimal(Sentence& sentence, const std::optional<double>& value, int decimals) {
    sentence.text(value ? fixed_decimals(*value, decimals) : std::string());
}

void add_dop(Sentence& sentence, const std::optional<double>& dop) {
    // A DOP that is not a number is as bad as it can be; receivers show such ones as 99.99.
    const auto shown = [](double d) { return std::isfinite(d) ? std::clamp(d, 0.0, largest_dop) : largest_dop; };
    sentence.text(dop ? fixed_decimals(shown(*dop), 2) : std::string());
}

// Degrees with `decimals` digits in 0 ≤ course < 360: 359.996 is 0.00.
std::string course_text(Angle course, int decimals) {
    double degrees = std::fmod(course.deg(), 360.0);
    if (degrees < 0) degrees += 360.0;
    const double step = 1.0 / static_cast<double>(power_of_ten(decimals));
    if (degrees >= 360.0 - step / 2) degrees = 0;
    return fixed_decimals(degrees, decimals);
}

std::string date_text(const NmeaDate& date) {
    return fmt::format("{:02}{:02}{:02}", date.day, date.month, date.year % 100);
}

std::string mode_text(const std::optional<NmeaMode>& mode) {
    return mode ? std::string(1, static_cast<char>(*mode)) : std::string();
}

// Two to three digits that mean something: 0.98, 3.1, 228650 (captures in RECEIVER.md 5.3).
std::string deviation_text(Metres deviation) {
    const double value = deviation.value();
    if (value < 0.995) return fixed_decimals(value, 2);
    return fixed_decimals(value, value < 9.95 ? 1 : 0);
}

void add_deviation(Sentence& sentence, const std::optional<Metres>& deviation) {
    sentence.text(deviation ? deviation_text(*deviation) : std::string());
}

void add_clamped(Sentence& sentence, const std::optional<int>& value, int last, int digits) {
    if (!value)
        sentence.empty();
    else
        sentence.number(std::clamp(*value, 0, last), digits);
}

std::string hex_text(int value) { return fmt::format("{:X}", value); }

bool since_4_10(const NmeaFormat& format) { return format.version >= NmeaVersion::v4_10; }

double in_knots(MetresPerSecond speed) { return speed.value() * 3600.0 / 1852.0; }
double in_kmh(MetresPerSecond speed) { return speed.value() * 3.6; }

std::string gga_text(const Gga& m, const NmeaFormat& format, int coordinate_decimals) {
    Sentence s(m.talker + "GGA");
    add_time(s, m.time, format);
    add_position(s, m.position, coordinate_decimals);
    s.number(m.quality).number(std::clamp(m.satellites_used, 0, 99), 2);
    add_dop(s, m.hdop);
    for (const auto& height : {m.altitude, m.geoid_separation}) {
        if (height && std::isfinite(height->value()))
            s.decimal(height->value(), format.altitude_decimals).letter('M');
        else
            s.empty(2);
    }
    add_decimal(s, m.correction_age ? std::optional(m.correction_age->value()) : std::nullopt, 1);
    if (m.correction_station)
        s.number(*m.correction_station, 4);
    else
        s.empty();
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
    add_decimal(s, m.speed ? std::optional(in_knots(*m.speed)) : std::nullopt, 3);
    s.text(m.course ? course_text(*m.course, 2) : "").text(m.date ? date_text(*m.date) : "");
    s.empty(2).text(mode_text(m.mode));  // no magnetic variation
    if (since_4_10(format)) s.letter('V');
    return s.finish();
}

std::string encode(const Vtg& m, const NmeaFormat&) {
    Sentence s(m.talker + "VTG");
    if (!m.speed) return s.empty(8).text(mode_text(m.mode)).finish();
    s.text(m.course ? course_text(*m.course, 2) : "").letter('T').empty().letter('M');
    s.decimal(in_knots(*m.speed), 3).letter('N').decimal(in_kmh(*m.speed), 3).letter('K');
    return s.text(mode_text(m.mode)).finish();
}

std::string encode(const Gga& m, const NmeaFormat& format) {
    std::string text = gga_text(m, format, format.coordinate_decimals);
    for (int decimals = format.coordinate_decimals; format.limit_82 && text.size() > longest_sentence && decimals > 0;)
        text = gga_text(m, format, --decimals);
    return text;
}

std::string encode(const Gsa& m, const NmeaFormat& format) {
    Sentence s(m.talker + "GSA");
    s.letter(m.automatic ? 'A' : 'M').number(m.fix_mode);
    const std::size_t shown = std::min(m.satellites.size(), gsa_slots);
    for (std::size_t i = 0; i < shown; ++i)
        s.number(m.satellites[i], 2);
    s.empty(static_cast<int>(gsa_slots - shown));
    for (const auto& dop : {m.pdop, m.hdop, m.vdop})
        add_dop(s, dop);
    if (since_4_10(format)) s.text(m.system_id ? hex_text(*m.system_id) : "");
    return s.finish();
}

std::string encode(const Gsv& m, const NmeaFormat& format) {
    Sentence s(m.talker + "GSV");
    s.number(m.pages).number(m.page).number(m.satellites_in_view, 2);
    for (std::size_t i = 0; i < std::min(m.satellites.size(), gsv_slots); ++i) {
        const GsvSatellite& satellite = m.satellites[i];
        s.text(satellite.number ? fmt::format("{:02}", *satellite.number) : "");
        add_clamped(s, satellite.elevation_deg, 90, 2);
        add_clamped(s, satellite.azimuth_deg ? std::optional(*satellite.azimuth_deg % 360) : std::nullopt, 359, 3);
        add_clamped(s, satellite.cn0_dbhz, 99, 2);
    }
    if (since_4_10(format)) s.text(m.signal_id ? hex_text(*m.signal_id) : "");
    return s.finish();
}

std::string encode(const Gll& m, const NmeaFormat& format) {
    Sentence s(m.talker + "GLL");
    add_position(s, m.position, format.coordinate_decimals);
    add_time(s, m.time, format);
    return s.letter(m.valid ? 'A' : 'V').text(mode_text(m.mode)).finish();
}

std::string encode(const Gst& m, const NmeaFormat& format) {
    Sentence s(m.talker + "GST");
    add_time(s, m.time, format);
    add_deviation(s, m.range_rms);
    add_deviation(s, m.semi_major);
    add_deviation(s, m.semi_minor);
    s.text(m.orientation ? course_text(*m.orientation, 0) : "");
    add_deviation(s, m.latitude);
    add_deviation(s, m.longitude);
    add_deviation(s, m.altitude);
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

}  // namespace skyloop
