// The epochs of a log in one order of time, whatever single clocks, restarts and joined recordings made of it.
// Which day or week an epoch is of whose receiver tells the time of day or of week alone.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <map>
#include <utility>

#include "base/time/utc_time.hpp"
#include "detail/observed_parts.hpp"

namespace skyloop::inline receiver {
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

namespace {

using ObservedEpochs = std::vector<ObservedEpoch>;

// More than a clock is ever set back by while it counts on: the recording began anew.
constexpr Nanoseconds log_begins_anew = std::chrono::seconds(2);

bool knows_its_place(const ObservedEpoch& epoch) {
    return epoch.type != FixType::none && epoch.type != FixType::time_only;
}

bool earlier(const ObservedEpoch& a, const ObservedEpoch& b) { return a.time < b.time; }

// Leaves out single epochs that are ahead of the one after them, which itself follows the one before.
std::size_t leave_out_ahead(ObservedEpochs& epochs) {
    ObservedEpochs kept;
    std::size_t ahead = 0;
    for (ObservedEpoch& epoch : epochs) {
        const std::size_t count = kept.size();
        if (count >= 2 && epoch.time < kept[count - 1].time - log_begins_anew && epoch.time > kept[count - 2].time) {
            kept.pop_back();
            ++ahead;
        }
        kept.push_back(std::move(epoch));
    }
    epochs = std::move(kept);
    return ahead;
}

// Cuts where the time goes back by more than two seconds.
std::vector<ObservedEpochs> recordings_of(ObservedEpochs epochs) {
    std::vector<ObservedEpochs> parts;
    for (ObservedEpoch& epoch : epochs) {
        if (parts.empty() || epoch.time < parts.back().back().time - log_begins_anew) parts.emplace_back();
        parts.back().push_back(std::move(epoch));
    }
    return parts;
}

// The epochs of a part, each later than the one before.
std::size_t leave_out_repeated(ObservedEpochs& part) {
    ObservedEpochs kept;
    for (ObservedEpoch& epoch : part)
        if (kept.empty() || epoch.time > kept.back().time) kept.push_back(std::move(epoch));
    const std::size_t repeated = part.size() - kept.size();
    part = std::move(kept);
    return repeated;
}

struct OrderCounts {
    std::size_t ahead = 0, repeated = 0, parts = 1;
};

// Recordings that have times of their own follow one another in time; of those that do not the longest stays. One epoch
// in front of a recording that goes on earlier ran ahead.
ObservedEpochs joined(ObservedEpochs epochs, OrderCounts& counts) {
    std::vector<ObservedEpochs> parts = recordings_of(std::move(epochs));
    constexpr std::size_t fewest_behind = 3;
    if (parts.size() > 1 && parts[0].size() == 1 && parts[1].size() >= fewest_behind) {
        parts.erase(parts.begin());
        ++counts.ahead;
    }
    for (ObservedEpochs& part : parts)
        counts.repeated += leave_out_repeated(part);
    std::stable_sort(parts.begin(), parts.end(),
                     [](const ObservedEpochs& a, const ObservedEpochs& b) { return a.size() > b.size(); });
    std::map<GpsTime, ObservedEpochs> kept;  // by their begin; none reaches into the next
    for (ObservedEpochs& part : parts) {
        const auto next = kept.upper_bound(part.front().time);
        const bool overlaps = (next != kept.begin() && std::prev(next)->second.back().time >= part.front().time) ||
                              (next != kept.end() && next->first <= part.back().time);
        if (overlaps)
            counts.repeated += part.size();
        else
            kept.emplace_hint(next, part.front().time, std::move(part));
    }
    counts.parts = kept.size();
    ObservedEpochs whole;
    for (auto& [begin, part] : kept)
        whole.insert(whole.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
    return whole;
}

// Of the epochs without a place those that fit between the ones with a place that stand beside them in the log.
ObservedEpochs fitting(const ObservedEpochs& epochs) {
    const auto places_from = [&](auto from, auto to) { return std::find_if(from, to, knows_its_place); };
    ObservedEpochs fit;
    const ObservedEpoch* before = nullptr;
    auto after = places_from(epochs.begin(), epochs.end());
    for (auto epoch = epochs.begin(); epoch != epochs.end(); ++epoch) {
        if (epoch == after) {
            before = &*epoch;
            after = places_from(epoch + 1, epochs.end());
            continue;
        }
        const bool late_enough = before == nullptr || epoch->time > before->time;
        const bool early_enough = after == epochs.end() || epoch->time < after->time;
        const bool begins_anew = before != nullptr && after != epochs.end() && after->time <= before->time;
        if (begins_anew ? late_enough || early_enough : late_enough && early_enough) fit.push_back(*epoch);
    }
    return fit;
}

}  // namespace

void put_epochs_in_order(ObservedLog& log) {
    OrderCounts counts;
    ObservedEpochs& epochs = log.epochs;
    counts.ahead = leave_out_ahead(epochs);
    ObservedEpochs placed;
    std::copy_if(epochs.begin(), epochs.end(), std::back_inserter(placed), knows_its_place);
    if (placed.empty()) {
        epochs = joined(std::move(epochs), counts);
    } else {
        const std::size_t without = epochs.size() - placed.size();
        ObservedEpochs others = fitting(epochs);
        counts.repeated += without - others.size();
        epochs = joined(std::move(placed), counts);
        epochs.insert(epochs.end(), std::make_move_iterator(others.begin()), std::make_move_iterator(others.end()));
        std::stable_sort(epochs.begin(), epochs.end(), earlier);
        counts.repeated += leave_out_repeated(epochs);
    }
    if (counts.parts > 1)
        log.notes.push_back(
            fmt::format("{} recordings do not follow each other in time; they were put in its order", counts.parts));
    add_note(log, counts.ahead, "epochs have a time that ran ahead and were left out");
    add_note(log, counts.repeated, "epochs that repeat a time or go back were left out");
}

}  // namespace skyloop::inline receiver
