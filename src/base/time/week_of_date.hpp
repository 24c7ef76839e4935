/// The week of a time of week that came with a date.
#pragma once

#include <cstdint>
#include <optional>

#include "base/time/utc_time.hpp"

namespace skyloop {

/// The GPS week in which a time of week is nearest to a date that was told with it, which may be of a little earlier or
/// later; nothing for what is no calendar time. @param tow of GPS, within a week
std::optional<std::int64_t> week_of_date(const UtcTime& date, Nanoseconds tow);

}  // namespace skyloop
