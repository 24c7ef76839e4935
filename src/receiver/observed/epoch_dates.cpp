// Which day or week an epoch is of whose receiver tells the time of day or of week alone.
#include <algorithm>
#include <chrono>

#include "base/time/utc_time.hpp"
#include "detail/observed_parts.hpp"

namespace skyloop {
namespace {

constexpr Nanoseconds whole_day = std::chrono::hours(24), half_day = whole_day / 2;
constexpr Nanoseconds whole_week = 7 * whole_day;

int days_between(Nanoseconds before, Nanoseconds of_day) {
    constexpr Nanoseconds late = std::chrono::hours(1);  // a sentence may come late over midnight
    const Nanoseconds step = of_day - before;
    return step < -half_day ? 1 : step > whole_day - late ? -1 : 0;
}

bool has_fixed_place(const NmeaEpoch& epoch) { return epoch.told.motion.latitude && epoch.told.type != FixType::none; }

// Days of each epoch after the first one. The next day begins where the time of day falls by more than half a day
// (FEEDS.md 1.5). What a receiver says without a fix counts for those with one only where its clock runs on through it.
std::vector<int> days_of(const std::vector<NmeaEpoch>& epochs) {
    constexpr Nanoseconds longest_step = std::chrono::hours(1);
    constexpr int most_days = 10000;  // more are nonsense, which finish_log() leaves out
    std::vector<int> days(epochs.size(), 0);
    std::optional<std::size_t> placed, before;  // the last one with a fix, the last one with a time
    bool runs_on = true;                        // since the former
    for (std::size_t i = 0; i < epochs.size(); ++i) {
        if (!epochs[i].of_day) continue;
        const Nanoseconds of_day = *epochs[i].of_day;
        if (before) {
            const int change = days_between(*epochs[*before].of_day, of_day);
            days[i] = std::clamp(days[*before] + change, -most_days, most_days);
            runs_on &= std::chrono::abs(of_day - *epochs[*before].of_day + change * whole_day) <= longest_step;
        }
        before = i;
        if (!has_fixed_place(epochs[i])) continue;
        if (placed && !runs_on) days[i] = days[*placed] + days_between(*epochs[*placed].of_day, of_day);
        placed = i;
        runs_on = true;
    }
    return days;
}

}  // namespace

bool date_by_days(std::vector<NmeaEpoch>& epochs) {
    const auto dated =
        std::find_if(epochs.begin(), epochs.end(), [](const NmeaEpoch& epoch) { return epoch.date.has_value(); });
    const bool any = dated != epochs.end();
    const std::vector<int> days = days_of(epochs);
    NmeaDate date = any ? *dated->date : NmeaDate{};
    int days_of_date = any ? days[static_cast<std::size_t>(dated - epochs.begin())] : 0;
    for (std::size_t i = 0; i < epochs.size(); ++i) {
        NmeaEpoch& epoch = epochs[i];
        epoch.told.dated = any;
        if (!epoch.of_day) continue;
        if (epoch.date) date = *epoch.date, days_of_date = days[i];
        const UtcTime midnight = midnight_of({date.year, date.month, date.day}, days[i] - days_of_date);
        epoch.told.time = to_gps_time(midnight, LeapSeconds::announced()) + *epoch.of_day;
    }
    return any;
}

bool date_by_weeks(std::vector<ObservedEpoch>& epochs) {
    const auto dated =
        std::find_if(epochs.begin(), epochs.end(), [](const ObservedEpoch& epoch) { return epoch.dated; });
    if (dated == epochs.end() || dated == epochs.begin()) return dated != epochs.end();
    // The nearest to the last one before it.
    const Nanoseconds ahead = dated->time - std::prev(dated)->time + whole_week / 2;
    const Nanoseconds weeks = ahead - ahead % whole_week;
    for (auto epoch = epochs.begin(); epoch != dated; ++epoch) {
        epoch->time += weeks;
        epoch->dated = epoch->place && epoch->type != FixType::none;
    }
    return true;
}

}  // namespace skyloop
