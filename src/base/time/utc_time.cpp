#include "base/time/utc_time.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace skyloop::inline base {
namespace {

using namespace std::chrono_literals;
using Days = std::chrono::sys_days;

constexpr Days gps_epoch = std::chrono::year(1980) / 1 / 6;

// The calendar day as a count, without leap seconds.
Nanoseconds since_gps_epoch(int year, unsigned month, unsigned day) {
    const Days days = std::chrono::year(year) / static_cast<int>(month) / static_cast<int>(day);
    return days - gps_epoch;
}

// Of a count without leap seconds.
template <class Duration>
UtcTime calendar(Duration since_epoch) {
    const auto days = std::chrono::floor<std::chrono::days>(since_epoch);
    const std::chrono::year_month_day date(gps_epoch + days);
    const std::chrono::hh_mm_ss clock(since_epoch - days);
    return {static_cast<int>(date.year()),
            static_cast<unsigned>(date.month()),
            static_cast<unsigned>(date.day()),
            static_cast<unsigned>(clock.hours().count()),
            static_cast<unsigned>(clock.minutes().count()),
            static_cast<unsigned>(clock.seconds().count()),
            static_cast<std::uint32_t>(clock.subseconds().count())};
}

// First UTC days on which a new offset holds (IERS Bulletin C).
constexpr std::array<std::array<int, 2>, 18> leap_days{{
    {1981, 7},
    {1982, 7},
    {1983, 7},
    {1985, 7},
    {1988, 1},
    {1990, 1},
    {1991, 1},
    {1992, 7},
    {1993, 7},
    {1994, 7},
    {1996, 1},
    {1997, 7},
    {1999, 1},
    {2006, 1},
    {2009, 1},
    {2012, 7},
    {2015, 7},
    {2017, 1},
}};

bool ends_in_leap_second(Days day) {
    const std::chrono::year_month_day next(day + std::chrono::days(1));
    if (next.day() != std::chrono::day(1)) return false;
    const std::array<int, 2> month{static_cast<int>(next.year()),
                                   static_cast<int>(static_cast<unsigned>(next.month()))};
    return std::find(leap_days.begin(), leap_days.end(), month) != leap_days.end();
}

std::vector<LeapSeconds::Step> announced_steps() {
    std::vector<LeapSeconds::Step> steps;
    int offset = 0;
    for (const auto& [year, month] : leap_days) {
        ++offset;
        steps.push_back(
            {GpsTime(since_gps_epoch(year, static_cast<unsigned>(month), 1) + std::chrono::seconds(offset)), offset});
    }
    return steps;
}

bool read_number(std::string_view& text, std::size_t digits, unsigned& value) {
    if (text.size() < digits) return false;
    value = 0;
    for (std::size_t i = 0; i < digits; ++i) {
        if (text[i] < '0' || text[i] > '9') return false;
        value = value * 10 + static_cast<unsigned>(text[i] - '0');
    }
    text.remove_prefix(digits);
    return true;
}

bool read_mark(std::string_view& text, std::string_view marks) {
    if (text.empty() || marks.find(text.front()) == std::string_view::npos) return false;
    text.remove_prefix(1);
    return true;
}

bool read_fraction(std::string_view& text, std::uint32_t& nanosecond) {
    if (!read_mark(text, ".,")) return true;
    std::uint32_t scale = 100'000'000;
    std::size_t digits = 0;
    for (; !text.empty() && text.front() >= '0' && text.front() <= '9'; text.remove_prefix(1), ++digits) {
        nanosecond += static_cast<std::uint32_t>(text.front() - '0') * scale;
        scale /= 10;
    }
    return digits >= 1 && digits <= 9;
}

// The marks stand between all parts, or between none.
bool read_date(std::string_view& text, UtcTime& time, bool& marked) {
    unsigned year = 0;
    if (!read_number(text, 4, year)) return false;
    time.year = static_cast<int>(year);
    marked = read_mark(text, "-");
    return read_number(text, 2, time.month) && (!marked || read_mark(text, "-")) && read_number(text, 2, time.day);
}

// Hours and minutes, and seconds, which may be left out where they are not `needed`.
bool read_clock(std::string_view& text, UtcTime& time, bool marked, bool needed) {
    if (!read_number(text, 2, time.hour) || (marked && !read_mark(text, ":")) || !read_number(text, 2, time.minute))
        return false;
    const bool seconds = marked ? read_mark(text, ":") : !text.empty() && text.front() >= '0' && text.front() <= '9';
    return seconds ? read_number(text, 2, time.second) && read_fraction(text, time.nanosecond) : !needed;
}

tl::unexpected<Error> no_utc_time(std::string_view text) {
    return fail(ErrorCode::usage,
                fmt::format("'{}' is not a UTC time; expected ISO 8601 from 1980-01-06 to 2199, such as "
                            "2024-03-05T12:00:00Z",
                            text));
}

}  // namespace

bool is_calendar_time(const UtcTime& utc) {
    const std::chrono::year_month_day date =
        std::chrono::year(utc.year) / static_cast<int>(utc.month) / static_cast<int>(utc.day);
    if (!date.ok() || Days(date) < gps_epoch || utc.year >= 2200) return false;
    if (utc.second == 60) return utc.hour == 23 && utc.minute == 59 && ends_in_leap_second(date);
    return utc.hour < 24 && utc.minute < 60 && utc.second < 60;
}

double UtcTime::seconds_of_day() const { return hour * 3600.0 + minute * 60.0 + second + nanosecond * 1e-9; }

const LeapSeconds& LeapSeconds::announced() {
    static const LeapSeconds table(announced_steps());
    return table;
}

LeapSeconds LeapSeconds::constant(int offset) { return LeapSeconds({{GpsTime::min(), offset}}); }

LeapSeconds LeapSeconds::believed(GpsTime time, int offset) {
    return announced().offset(time) == offset ? announced() : constant(offset);
}

int LeapSeconds::offset(GpsTime time) const {
    // From the end: nearly every question is about a time after the last step.
    for (auto step = steps_.rbegin(); step != steps_.rend(); ++step)
        if (time >= step->from) return step->offset;
    return 0;
}

UtcTime to_utc(GpsTime time, const LeapSeconds& leap_seconds) {
    const int offset = leap_seconds.offset(time);
    // During a leap second the offset is still the old one and the calendar would already show the next day.
    if (leap_seconds.offset(time + 1s) > offset && time.time_since_epoch() >= 0s) {
        UtcTime utc = calendar((time - std::chrono::seconds(offset) - 1s).time_since_epoch());
        const UtcTime next = calendar((time - std::chrono::seconds(offset)).time_since_epoch());
        if (next.day != utc.day) {
            utc.second += 1;
            return utc;
        }
    }
    return calendar((time - std::chrono::seconds(offset)).time_since_epoch());
}

GpsTime to_gps_time(const UtcTime& utc, const LeapSeconds& leap_seconds) {
    const Nanoseconds count = since_gps_epoch(utc.year, utc.month, utc.day) + std::chrono::hours(utc.hour) +
                              std::chrono::minutes(utc.minute) + std::chrono::seconds(utc.second) +
                              Nanoseconds(utc.nanosecond);
    // A second of 60 still belongs to the old day.
    const Nanoseconds into_next_day = utc.second == 60 ? Nanoseconds(1s) : Nanoseconds(0);
    return from_utc_count(count - into_next_day, leap_seconds) + into_next_day;
}

GpsTime from_utc_count(Nanoseconds count, const LeapSeconds& leap_seconds) {
    // The table is in GPS time, the question in UTC: a step holds from the UTC count `from` − its offset.
    const auto& steps = leap_seconds.steps();
    for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
        const std::chrono::seconds offset(step->offset);
        if (step->from == GpsTime::min() || count >= step->from.time_since_epoch() - offset)
            return GpsTime(count + offset);
    }
    return GpsTime(count);
}

GpsTime from_posix(Nanoseconds since_1970, const LeapSeconds& leap_seconds) {
    return from_utc_count(since_1970 - std::chrono::seconds(gps_epoch_posix_s), leap_seconds);
}

GpsTime gps_calendar_time(int year, unsigned month, unsigned day, unsigned hour, unsigned minute, double second) {
    return GpsTime(since_gps_epoch(year, month, day) + std::chrono::hours(hour) + std::chrono::minutes(minute) +
                   to_nanoseconds(Seconds(second)));
}

UtcTime gps_calendar(GpsTime time) { return calendar(time.time_since_epoch()); }

double day_of_year(const UtcTime& utc) {
    const Nanoseconds days = since_gps_epoch(utc.year, utc.month, utc.day) - since_gps_epoch(utc.year, 1, 1);
    return 1.0 + std::chrono::duration<double>(days).count() / 86400.0 + utc.seconds_of_day() / 86400.0;
}

std::int64_t modified_julian_day(const UtcTime& utc) {
    constexpr std::int64_t gps_epoch_mjd = 44244;
    return gps_epoch_mjd + since_gps_epoch(utc.year, utc.month, utc.day) / std::chrono::days(1);
}

Result<UtcTime> parse_utc(std::string_view text) {
    std::string_view rest = text;
    UtcTime t;
    bool marked = false;
    const bool read = read_date(rest, t, marked) && marked && read_mark(rest, "T ") && read_clock(rest, t, true, true);
    if (read) read_mark(rest, "Z");
    if (!read || !rest.empty() || !is_calendar_time(t)) return no_utc_time(text);
    return t;
}

Result<UtcTime> parse_instant(std::string_view text) {
    std::string_view rest = text;
    UtcTime local;
    bool marked = false;
    if (!read_date(rest, local, marked)) return no_utc_time(text);
    if (!rest.empty() && !(read_mark(rest, "T ") && read_clock(rest, local, marked, false))) return no_utc_time(text);
    const auto zone = zone_minutes(rest);
    // A zone's leap second is not at its midnight.
    UtcTime on_calendar = local;
    if (local.second == 60) on_calendar.second = 59;
    if (!zone || !is_calendar_time(on_calendar)) return no_utc_time(text);
    const UtcTime utc = utc_of_local(local, *zone);
    if (!is_calendar_time(utc)) return no_utc_time(text);
    return utc;
}

std::optional<int> zone_minutes(std::string_view text) {
    if (text.empty() || text == "Z" || text == "z") return 0;
    const int sign = text.front() == '-' ? -1 : 1;
    unsigned hours = 0, minutes = 0;
    if (!read_mark(text, "+-") || !read_number(text, 2, hours)) return std::nullopt;
    read_mark(text, ":");
    if (!text.empty() && !read_number(text, 2, minutes)) return std::nullopt;
    if (!text.empty() || hours > 14 || minutes > 59) return std::nullopt;
    return sign * static_cast<int>(hours * 60 + minutes);
}

UtcTime utc_of_local(const UtcTime& local, int minutes) {
    using namespace std::chrono;
    const sys_days day = year_month_day(year(local.year), month(local.month), std::chrono::day(local.day));
    UtcTime utc =
        calendar(day - gps_epoch + hours(local.hour) + std::chrono::minutes(static_cast<int>(local.minute) - minutes));
    utc.second = local.second;
    utc.nanosecond = local.nanosecond;
    return utc;
}

UtcTime midnight_of(const UtcTime& day, int days_later) {
    constexpr int minutes_of_day = 24 * 60;
    return utc_of_local({day.year, day.month, day.day, 0, 0, 0, 0}, -days_later * minutes_of_day);
}

std::string format_utc(const UtcTime& utc, int decimals) {
    std::string text = fmt::format(FMT_COMPILE("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}"), utc.year, utc.month, utc.day,
                                   utc.hour, utc.minute, utc.second);
    if (decimals > 0)
        text += fmt::format(FMT_COMPILE(".{:09}"), utc.nanosecond).substr(0, static_cast<std::size_t>(decimals) + 1);
    return text + "Z";
}

std::string utc_text(GpsTime time, int decimals) {
    return format_utc(to_utc(time, LeapSeconds::announced()), decimals);
}

std::optional<std::int64_t> week_of_date(const UtcTime& date, Nanoseconds tow) {
    if (!is_calendar_time(date)) return std::nullopt;
    constexpr std::chrono::seconds half{seconds_per_week / 2};
    return week_and_tow(to_gps_time(date, LeapSeconds::announced()) - tow + half).week;
}

}  // namespace skyloop::inline base
