#include "skyloop/gnss/navigation_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include "skyloop/gnss/constants.hpp"
#include "skyloop/time/utc_time.hpp"

namespace skyloop {
namespace {

constexpr std::chrono::days one_day{1};

bool time_before_toe(GpsTime time, const KeplerEphemeris& record) { return time < record.toe; }

std::vector<SatelliteRecords> by_satellite(const std::vector<KeplerEphemeris>& records) {
    std::vector<std::size_t> order(records.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto issue = [&](std::size_t i) { return std::tie(records[i].satellite, records[i].toe, records[i].iode); };
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return issue(a) != issue(b) ? issue(a) < issue(b) : a > b; });
    order.erase(
        std::unique(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return issue(a) == issue(b); }),
        order.end());
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(records[a].satellite, records[a].toe, a) < std::tie(records[b].satellite, records[b].toe, b);
    });

    std::vector<SatelliteRecords> satellites;
    for (const std::size_t i : order) {
        if (satellites.empty() || satellites.back().satellite != records[i].satellite)
            satellites.push_back({records[i].satellite, {}});
        satellites.back().records.push_back(records[i]);
    }
    return satellites;
}

// The last of the records that share the toe of `first`.
std::vector<KeplerEphemeris>::const_iterator last_of_toe(const std::vector<KeplerEphemeris>& records,
                                                         std::vector<KeplerEphemeris>::const_iterator first) {
    return std::upper_bound(first, records.end(), first->toe, time_before_toe) - 1;
}

std::int64_t floor_days(Nanoseconds span) { return std::chrono::floor<std::chrono::days>(span).count(); }

}  // namespace

NavigationData::NavigationData(const std::vector<KeplerEphemeris>& records,
                               std::optional<KlobucharCoefficients> klobuchar, std::string description,
                               EphemerisSelection selection)
    : satellites_(by_satellite(records)),
      klobuchar_(klobuchar),
      description_(std::move(description)),
      selection_(selection) {}

std::vector<SatelliteId> NavigationData::satellites() const {
    std::vector<SatelliteId> ids;
    ids.reserve(satellites_.size());
    for (const SatelliteRecords& s : satellites_)
        ids.push_back(s.satellite);
    return ids;
}

const KeplerEphemeris* NavigationData::find(const SatelliteRecords& satellite, GpsTime time) const {
    const std::vector<KeplerEphemeris>& records = satellite.records;
    const Nanoseconds validity = to_nanoseconds(selection_.validity);
    const auto next = std::upper_bound(records.begin(), records.end(), time, time_before_toe);
    if (selection_.rule == EphemerisRule::forward) {
        for (auto r = next; r != records.begin();) {
            --r;
            if (time - r->toe > validity) return nullptr;
            if (r->healthy()) return &*r;
        }
        return nullptr;
    }
    const KeplerEphemeris* nearest = next == records.begin() ? nullptr : &*(next - 1);
    if (next != records.end() && (nearest == nullptr || next->toe - time <= time - nearest->toe))
        nearest = &*last_of_toe(records, next);
    if (nearest == nullptr || std::chrono::abs(time - nearest->toe) > validity) return nullptr;
    return nearest;
}

std::optional<KeplerEphemeris> NavigationData::ephemeris(SatelliteId satellite, GpsTime time) const {
    const auto own = std::lower_bound(satellites_.begin(), satellites_.end(), satellite,
                                      [](const SatelliteRecords& s, SatelliteId id) { return s.satellite < id; });
    if (own == satellites_.end() || own->satellite != satellite) return std::nullopt;
    const KeplerEphemeris* record = find(*own, time);
    if (record == nullptr) return std::nullopt;
    return *record;
}

std::optional<TimeSpan> NavigationData::span() const {
    if (satellites_.empty()) return std::nullopt;
    GpsTime first = GpsTime::max();
    GpsTime last = GpsTime::min();
    for (const SatelliteRecords& s : satellites_) {
        first = std::min(first, s.records.front().toe);
        last = std::max(last, s.records.back().toe);
    }
    const Nanoseconds validity = to_nanoseconds(selection_.validity);
    return TimeSpan{selection_.rule == EphemerisRule::nearest ? first - validity : first, last + validity};
}

std::size_t NavigationData::record_count() const {
    std::size_t count = 0;
    for (const SatelliteRecords& s : satellites_)
        count += s.records.size();
    return count;
}

std::size_t NavigationData::satellites_at(GpsTime time) const {
    return static_cast<std::size_t>(std::count_if(satellites_.begin(), satellites_.end(),
                                                  [&](const SatelliteRecords& s) { return find(s, time) != nullptr; }));
}

KeplerEphemeris moved_by_days(const KeplerEphemeris& record, std::int64_t days) {
    KeplerEphemeris moved = record;
    moved.toe += days * one_day;
    moved.toc += days * one_day;
    // The node's longitude at toe is omega0 − ω_e·toe (IS-GPS-200, table 20-IV), toe being the time of week.
    const Nanoseconds change = week_and_tow(moved.toe).tow - week_and_tow(record.toe).tow;
    const double omega0 = record.omega0 + earth_rotation_rate * std::chrono::duration<double>(change).count();
    if (change != Nanoseconds(0)) moved.omega0 = std::remainder(omega0, 2 * std::numbers::pi);
    return moved;
}

Result<NavigationData> rebased(const NavigationData& data, GpsTime start) {
    const std::optional<TimeSpan> span = data.span();
    if (!span)
        return fail(ErrorCode::usage,
                    fmt::format("{}: found no orbits; expected some to move to the start time", data.description()));
    // Moving the data by d days is looking at it d days earlier; the earliest look leaves the most data ahead.
    std::int64_t best_days = 0;
    std::size_t best_count = 0;
    for (std::int64_t days = floor_days(start - span->first); start - days * one_day <= span->last; --days) {
        const std::size_t count = data.satellites_at(start - days * one_day);
        if (count <= best_count) continue;
        best_count = count;
        best_days = days;
    }
    if (best_count == 0)
        return fail(
            ErrorCode::usage,
            fmt::format("{}: found orbits from {} to {} (GPS time), none at the time of day of the start {}; expected "
                        "a start time of day that the data covers",
                        data.description(), format_utc(gps_calendar(span->first), 0),
                        format_utc(gps_calendar(span->last), 0), format_utc(gps_calendar(start), 0)));
    std::vector<KeplerEphemeris> records;
    records.reserve(data.record_count());
    for (const SatelliteRecords& s : data.records())
        for (const KeplerEphemeris& r : s.records)
            records.push_back(moved_by_days(r, best_days));
    return NavigationData(records, data.klobuchar(), data.description(), data.selection());
}

}  // namespace skyloop
