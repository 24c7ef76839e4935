#include "base/time/week_of_date.hpp"

namespace skyloop {

std::optional<std::int64_t> week_of_date(const UtcTime& date, Nanoseconds tow) {
    if (!is_calendar_time(date)) return std::nullopt;
    constexpr std::chrono::seconds half{seconds_per_week / 2};
    return week_and_tow(to_gps_time(date, LeapSeconds::announced()) - tow + half).week;
}

}  // namespace skyloop
