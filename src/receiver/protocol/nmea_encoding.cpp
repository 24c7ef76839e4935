#include "detail/nmea_encoding.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/core/fixed_text.hpp"

namespace skyloop::nmea_encoding {
namespace {

constexpr double largest_dop = 99.99;
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

void add_dop(Sentence& sentence, const std::optional<double>& dop, int decimals) {
    // A DOP that is not a number is as bad as it can be; receivers show such ones as 99.99.
    const auto shown = [](double d) { return std::isfinite(d) ? std::clamp(d, 0.0, largest_dop) : largest_dop; };
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

}  // namespace skyloop::nmea_encoding
