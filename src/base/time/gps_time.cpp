#include "base/time/gps_time.hpp"

#include <cmath>

namespace skyloop::inline base {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds week_length = std::chrono::seconds(seconds_per_week);
constexpr std::int64_t gst_first_week = 1024;

}  // namespace

WeekAndTow week_and_tow(GpsTime time) {
    const Nanoseconds since = time.time_since_epoch();
    std::int64_t week = since / week_length;
    Nanoseconds tow = since % week_length;
    if (tow < 0ns) {
        tow += week_length;
        --week;
    }
    return {week, tow};
}

GpsTime to_gps_time(const WeekAndTow& value) { return GpsTime(value.week * week_length + value.tow); }

GpsTime to_gps_time(std::int64_t week, double tow_seconds) {
    return GpsTime(week * week_length) + to_nanoseconds(Seconds(tow_seconds));
}

Nanoseconds to_nanoseconds(Seconds span) {
    // Whole seconds apart, so that a long span keeps its nanoseconds.
    const double whole = std::floor(span.value());
    return std::chrono::seconds(static_cast<std::int64_t>(whole)) +
           Nanoseconds(std::llround((span.value() - whole) * 1e9));
}

std::int64_t resolve_week(std::int64_t week10, std::int64_t pivot_week) {
    return week10 + 1024 * std::llround(static_cast<double>(pivot_week - week10) / 1024.0);
}

WeekAndTow bdt_week_and_tow(GpsTime time) {
    WeekAndTow value = week_and_tow(time - bdt_lag);
    value.week -= bdt_first_week;
    return value;
}

WeekAndTow gst_week_and_tow(GpsTime time) {
    WeekAndTow value = week_and_tow(time);
    value.week -= gst_first_week;
    return value;
}

}  // namespace skyloop::inline base
