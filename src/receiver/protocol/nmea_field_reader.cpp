#include "detail/nmea_field_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

namespace skyloop::nmea_decoding {
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

}  // namespace skyloop::nmea_decoding
