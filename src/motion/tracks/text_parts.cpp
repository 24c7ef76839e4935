// Numbers, lines, cells and times of text files.
#include "detail/text_track.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/core/number_in.hpp"

namespace skyloop {
namespace {

// Digits at the front of `text`, which they are taken from; nothing unless there are `count`.
std::optional<unsigned> take_digits(std::string_view& text, std::size_t count) {
    if (text.size() < count) return std::nullopt;
    unsigned value = 0;
    for (const char digit : text.substr(0, count)) {
        if (digit < '0' || digit > '9') return std::nullopt;
        value = value * 10 + static_cast<unsigned>(digit - '0');
    }
    text.remove_prefix(count);
    return value;
}

bool take_char(std::string_view& text, std::string_view any_of) {
    if (text.empty() || any_of.find(text.front()) == std::string_view::npos) return false;
    text.remove_prefix(1);
    return true;
}

// The fraction of a second, when there is one: nanoseconds. False: a point without digits.
bool take_fraction(std::string_view& text, std::uint32_t& nanosecond) {
    if (!take_char(text, ".,")) return true;
    std::uint32_t unit = 100'000'000;
    bool any = false;
    for (; !text.empty() && text.front() >= '0' && text.front() <= '9'; text.remove_prefix(1)) {
        nanosecond += unit * static_cast<std::uint32_t>(text.front() - '0');
        unit /= 10;
        any = true;
    }
    return any;
}

bool could_be(const UtcTime& local) {
    using namespace std::chrono;
    return year_month_day(year(local.year), month(local.month), day(local.day)).ok() && local.hour < 24 &&
           local.minute < 60 && local.second <= 60;
}

}  // namespace

std::string one_line_of(std::string text) {
    for (char& letter : text)
        if (static_cast<unsigned char>(letter) < 0x20) letter = ' ';
    return text;
}

std::optional<double> text_number(std::string_view text) { return signed_number_in<double>(trimmed_cell(text)); }

bool TextLines::next() {
    if (rest_.empty()) return false;
    constexpr std::size_t longest = 65536;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, std::min(end, longest));
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    return true;
}

std::optional<IsoTime> parse_iso_time(std::string_view text) {
    text = trimmed_cell(text);
    UtcTime local;
    const auto year = take_digits(text, 4);
    const bool first = take_char(text, "-/");
    const auto month = take_digits(text, 2);
    const bool second = take_char(text, "-/");
    const auto day = take_digits(text, 2);
    const bool between = take_char(text, "Tt ");
    const auto hour = take_digits(text, 2);
    const bool third = take_char(text, ":");
    const auto minute = take_digits(text, 2);
    const bool with_seconds = take_char(text, ":");
    const auto whole = with_seconds ? take_digits(text, 2) : std::optional(0U);
    if (!year || !month || !day || !hour || !minute || !whole) return std::nullopt;
    if (!first || !second || !between || !third) return std::nullopt;
    local = {static_cast<int>(*year), *month, *day, *hour, *minute, *whole, 0};
    if (with_seconds && !take_fraction(text, local.nanosecond)) return std::nullopt;
    text = trimmed_cell(text);
    const auto zone = zone_minutes(text);
    if (!zone || !could_be(local)) return std::nullopt;
    const auto since = utc_since_1980(utc_of_local(local, *zone));
    return IsoTime{GpsTime(since.value_or(Nanoseconds(0))), !text.empty(), since.has_value()};
}

std::optional<Nanoseconds> utc_since_1980(const UtcTime& utc) {
    if (!is_calendar_time(utc)) return std::nullopt;
    return to_gps_time(utc, LeapSeconds::announced()).time_since_epoch();
}

Attitude attitude_of_flu_in_enu(const Eigen::Quaterniond& body_to_enu) {
    // Both pairs of axes turn into one another by half a turn about an axis between them.
    const double half = std::sqrt(0.5);
    const Eigen::Quaterniond enu_to_ned(0, half, half, 0), frd_to_flu(0, 1, 0, 0);
    return Attitude(enu_to_ned * body_to_enu.normalized() * frd_to_flu);
}

}  // namespace skyloop
