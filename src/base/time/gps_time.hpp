/// GPS time: the only clock of the simulation.
#pragma once

#include <chrono>
#include <cstdint>

#include "base/core/units.hpp"

namespace skyloop::inline base {

/// GPS time (GPST), continuous since 1980-01-06T00:00:00 UTC.
struct GpsClock {
    using rep = std::int64_t;
    using period = std::nano;
    using duration = std::chrono::nanoseconds;
    using time_point = std::chrono::time_point<GpsClock, duration>;
    static constexpr bool is_steady = true;
};

/// An instant of GPS time in whole nanoseconds since its epoch.
using GpsTime = GpsClock::time_point;
using Nanoseconds = std::chrono::nanoseconds;

inline constexpr std::int64_t seconds_per_day = 86400;
inline constexpr std::int64_t seconds_per_week = 604800;
/// The last one whose every instant is a GpsTime, with a week to spare: 15249, of 2272.
inline constexpr std::int64_t last_gps_week =
    GpsTime::max().time_since_epoch() / std::chrono::seconds(seconds_per_week) - 1;

/// A GPS week, never reduced modulo 1024, and the time of week.
struct WeekAndTow {
    std::int64_t week = 0;
    Nanoseconds tow{0};  ///< 0 … 604 800 s
    /// Time of week, s.
    [[nodiscard]] double tow_seconds() const { return std::chrono::duration<double>(tow).count(); }
    bool operator==(const WeekAndTow&) const = default;
};

WeekAndTow week_and_tow(GpsTime time);
GpsTime to_gps_time(const WeekAndTow& value);
/// @param tow_seconds s; may lie outside the week (it carries), rounded to the nearest nanosecond
GpsTime to_gps_time(std::int64_t week, double tow_seconds);

/// A span of whole nanoseconds as a floating-point number of seconds.
inline Seconds to_seconds(Nanoseconds span) { return Seconds(std::chrono::duration<double>(span).count()); }
/// The difference a − b as a floating-point number of seconds.
inline Seconds difference(GpsTime a, GpsTime b) { return to_seconds(a - b); }
/// A span of seconds as whole nanoseconds, rounded to nearest. It must be finite and shorter than 292 years.
Nanoseconds to_nanoseconds(Seconds span);
/// `time` moved by `span`, rounded to the nearest nanosecond.
inline GpsTime advanced(GpsTime time, Seconds span) { return time + to_nanoseconds(span); }

/// The full week whose lowest ten bits are `week10` and that lies nearest to `pivot_week`
/// (MODELS.md 3.1: w = w10 + 1024·round((pivot − w10)/1024)).
std::int64_t resolve_week(std::int64_t week10, std::int64_t pivot_week);

/// By how much BeiDou time is behind GPS time (BeiDou ICD B1I 3.0, 3.3: it began with UTC of 2006).
inline constexpr Nanoseconds bdt_lag = std::chrono::seconds(14);
/// The GPS week of its week 0.
inline constexpr std::int64_t bdt_first_week = 1356;

/// BeiDou time, GPST − 14 s.
WeekAndTow bdt_week_and_tow(GpsTime time);
/// Galileo system time, equal to GPST to nanoseconds; its week 0 is GPS week 1024.
WeekAndTow gst_week_and_tow(GpsTime time);

}  // namespace skyloop::inline base
