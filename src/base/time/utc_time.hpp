/// Coordinated universal time, its calendar and its leap seconds.
/// The week of a time of week that came with a date.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline base {

/// A UTC instant as a calendar and a clock read it; second 60 is a leap second. It does not subtract from GpsTime.
struct UtcTime {
    int year = 1980;
    unsigned month = 1;  ///< 1 … 12
    unsigned day = 6;    ///< 1 … 31
    unsigned hour = 0;
    unsigned minute = 0;
    unsigned second = 0;  ///< 0 … 60
    std::uint32_t nanosecond = 0;

    auto operator<=>(const UtcTime&) const = default;
    /// Seconds since midnight, fraction included.
    [[nodiscard]] double seconds_of_day() const;
};

/// GPST − UTC over time: a table, so that a coming leap second, or a receiver with the wrong one, is data.
class LeapSeconds {
public:
    struct Step {
        GpsTime from;    ///< first instant at which `offset` holds
        int offset = 0;  ///< GPST − UTC, s
    };
    /// @param steps ascending in time; before the first the offset is 0
    explicit LeapSeconds(std::vector<Step> steps) : steps_(std::move(steps)) {}
    /// The leap seconds announced by the IERS since 1980 (Bulletin C; the last is 2016-12-31, offset 18 s).
    static const LeapSeconds& announced();
    /// The same offset at all times: what a receiver believes between two almanac pages.
    static LeapSeconds constant(int offset);
    /// What a receiver counts by that believes `offset` at `time`: the announced ones where these agree, so that it
    /// counts to 60 in a leap second; with any other belief it just subtracts.
    static LeapSeconds believed(GpsTime time, int offset);

    /// GPST − UTC, s.
    [[nodiscard]] int offset(GpsTime time) const;
    [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }

private:
    std::vector<Step> steps_;
};

UtcTime to_utc(GpsTime time, const LeapSeconds& leap_seconds);
GpsTime to_gps_time(const UtcTime& utc, const LeapSeconds& leap_seconds);
/// GPS time of a count of UTC since 1980-01-06T00:00:00Z that leaves leap seconds out, as POSIX and GLONASS count.
GpsTime from_utc_count(Nanoseconds count, const LeapSeconds& leap_seconds);
/// 1980-01-06T00:00:00Z, the epoch of GPS time, as POSIX counts (IEEE 1003.1, 4.16), s.
inline constexpr std::int64_t gps_epoch_posix_s = 315964800;
/// GPS time of a POSIX time, which leaves leap seconds out.
GpsTime from_posix(Nanoseconds since_1970, const LeapSeconds& leap_seconds);
/// The calendar of GPS time itself, without leap seconds, as RINEX epochs are written.
GpsTime gps_calendar_time(int year, unsigned month, unsigned day, unsigned hour, unsigned minute, double second);
UtcTime gps_calendar(GpsTime time);

/// Day of year, 1.0 at 1 January 00:00, with fraction.
double day_of_year(const UtcTime& utc);
/// Modified Julian date of the day, without fraction.
std::int64_t modified_julian_day(const UtcTime& utc);

/// Whether a calendar has this day and a clock this time, from 1980-01-06 to 2199; a second of 60 is taken
/// where a leap second was announced only (LeapSeconds::announced).
bool is_calendar_time(const UtcTime& utc);
/// Reads ISO 8601 in UTC from 1980-01-06 to 2199: 2024-03-05T12:00:00Z, with a fraction of up to nine digits; `T` may
/// be a space and `Z` be left out. Fails with `usage`, and a sentence that quotes the text, for anything else and for
/// what is no calendar time.
Result<UtcTime> parse_utc(std::string_view text);
/// Reads an instant as ISO 8601 has many ways to write it: what parse_utc() reads, without the seconds or the time of
/// day, without marks (20240305T120000Z), and with a zone (+02:00). In UTC; fails as parse_utc().
Result<UtcTime> parse_instant(std::string_view text);
/// Minutes east of UTC of a zone as ISO 8601 writes it: "+01:00", "-0330", "+02", "Z"; 0 for an empty text. Nothing for
/// what is no zone.
std::optional<int> zone_minutes(std::string_view text);
/// The same instant in UTC. The second stays, so that a leap second does.
/// @param local of a calendar that has its day @param minutes east of UTC
UtcTime utc_of_local(const UtcTime& local, int minutes);
/// Midnight of a day of the calendar, some days later or earlier: one with a leap second is longer than the others.
/// @param day of a calendar that has it; its time of day does not count
UtcTime midnight_of(const UtcTime& day, int days_later);
/// ISO 8601 with `decimals` (0 … 9) digits of fraction, cut off and not rounded as a clock shows them, and a final Z.
std::string format_utc(const UtcTime& utc, int decimals = 3);
/// The same of an instant, by the announced leap seconds.
std::string utc_text(GpsTime time, int decimals = 0);

/// The GPS week in which a time of week is nearest to a date that was told with it, which may be of a little earlier or
/// later; nothing for what is no calendar time. @param tow of GPS, within a week
std::optional<std::int64_t> week_of_date(const UtcTime& date, Nanoseconds tow);

}  // namespace skyloop::inline base
