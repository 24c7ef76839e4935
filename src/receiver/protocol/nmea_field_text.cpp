#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>

#include "base/core/number_text.hpp"
#include "detail/nmea_field_text.hpp"

namespace skyloop::inline receiver::nmea_encoding {
namespace {

constexpr std::array<std::int64_t, 10> powers_of_ten{1,       10,        100,        1'000,       10'000,
                                                     100'000, 1'000'000, 10'000'000, 100'000'000, 1'000'000'000};

// Degrees and minutes from one integer, so that 59.999996 minutes carry into the degrees.
void add_coordinate(Sentence& sentence, double degrees, int degree_digits, std::string_view hemispheres, int decimals) {
    const std::int64_t scale = power_of_ten(decimals);
    const std::int64_t units = std::llround(std::abs(degrees) * 60.0 * static_cast<double>(scale));
    const std::int64_t minutes = units % (60 * scale);
    std::string text;
    append_padded(text, static_cast<int>(units / (60 * scale)), degree_digits);
    append_padded(text, static_cast<int>(minutes / scale), 2);
    if (decimals > 0) append_padded(text += '.', static_cast<int>(minutes % scale), decimals);
    sentence.text(text).letter(degrees < 0 && units != 0 ? hemispheres[1] : hemispheres[0]);
}

}  // namespace

std::int64_t power_of_ten(int decimals) { return powers_of_ten[static_cast<std::size_t>(std::clamp(decimals, 0, 9))]; }

std::string time_text(const NmeaTime& time, int decimals) {
    std::string text = fmt::format(FMT_COMPILE("{:02}{:02}{:02}"), time.hour, time.minute, time.second);
    if (decimals > 0)
        text += fmt::format(FMT_COMPILE(".{:09}"), time.nanosecond).substr(0, static_cast<std::size_t>(decimals) + 1);
    return text;
}

void add_time(Sentence& sentence, const std::optional<NmeaTime>& time, const NmeaFormat& format) {
    sentence.text(time ? time_text(*time, format.time_decimals) : std::string());
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

void add_metres(Sentence& sentence, const std::optional<Metres>& value, int decimals) {
    sentence.text(value ? fixed_decimals(value->value(), decimals) : std::string());
}

void add_dop(Sentence& sentence, const std::optional<double>& dop, int decimals, double most) {
    // A DOP that is not a number is as bad as it can be.
    const auto shown = [most](double d) { return std::isfinite(d) ? std::clamp(d, 0.0, most) : most; };
    sentence.text(dop ? fixed_decimals(shown(*dop), decimals) : std::string());
}

std::string course_text(Angle course, int decimals) {
    double degrees = std::fmod(course.deg(), 360.0);
    if (degrees < 0) degrees += 360.0;
    const double step = 1.0 / static_cast<double>(power_of_ten(decimals));
    if (degrees >= 360.0 - step / 2) degrees = 0;
    return fixed_decimals(degrees, decimals);
}

std::string date_text(const NmeaDate& date) {
    return fmt::format(FMT_COMPILE("{:02}{:02}{:02}"), date.day, date.month, date.year % 100);
}

std::string deviation_text(Metres deviation) {
    const double value = deviation.value();
    if (value < 0.0995) return fixed_decimals(value, 3);
    if (value < 0.995) return fixed_decimals(value, 2);
    return fixed_decimals(value, value < 9.95 ? 1 : 0);
}

void add_station(Sentence& sentence, const std::optional<int>& station, std::string_view without) {
    if (station)
        sentence.number(*station, 4);
    else
        sentence.text(without);
}

std::string hex_text(int value) { return fmt::format("{:X}", value); }

}  // namespace skyloop::inline receiver::nmea_encoding

namespace skyloop::inline receiver::nmea_decoding {
namespace {

bool decimal_digits(std::string_view text) { return text.find_first_not_of("0123456789") == std::string_view::npos; }

unsigned two_digits(std::string_view text, std::size_t at) {
    return static_cast<unsigned>((text[at] - '0') * 10 + (text[at + 1] - '0'));
}

bool calendar_day(const NmeaDate& d) {
    return (std::chrono::year(d.year) / static_cast<int>(d.month) / static_cast<int>(d.day)).ok();
}

}  // namespace

std::optional<double> FieldReader::number(std::size_t i, std::string_view what) {
    const std::string_view field = text(i);
    if (field.empty()) return std::nullopt;
    double value = 0;
    const auto [end, error] =
        std::from_chars(field.data(), field.data() + field.size(), value, std::chars_format::fixed);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) return refuse(i, what);
    return value;
}

std::optional<int> FieldReader::integer(std::size_t i, std::string_view what, int base) {
    const std::string_view field = text(i);
    if (field.empty()) return std::nullopt;
    int value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value, base);
    if (error != std::errc() || end != field.data() + field.size() || value < 0) return refuse(i, what);
    return value;
}

std::nullopt_t FieldReader::refuse(std::size_t i, std::string_view what) {
    if (error_.empty())
        error_ = fmt::format("{}: field {} is '{}'; expected {}", sentence_.address, i + 1, text(i), what);
    return std::nullopt;
}

Result<void> FieldReader::verdict(std::size_t least_fields) const {
    if (size() < least_fields)
        return fail(ErrorCode::input,
                    fmt::format("{}: {} fields; expected at least {}", sentence_.address, size(), least_fields));
    if (!error_.empty()) return fail(ErrorCode::input, error_);
    return {};
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

}  // namespace skyloop::inline receiver::nmea_decoding
