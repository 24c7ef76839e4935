#include "world/gnss/navigation_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "base/time/utc_time.hpp"
#include "detail/secular_motion.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline world {
namespace {

constexpr std::chrono::days one_day{1};

bool time_before_toe(GpsTime time, const Ephemeris& record) { return time < toe_of(record); }

// Of SBAS t_0 counts 16 s of the day (DO-229, message 9). Merged files hold a state a second time, by a receiver that
// told when it had come, some seconds beside it, and knew nothing of its health.
bool tells_when_it_came(const Ephemeris& record) {
    constexpr std::chrono::seconds unit{16};
    return message_of(record) == NavigationMessage::sbas && toe_of(record).time_since_epoch() % unit != Nanoseconds(0);
}

// Which records serve: messages of one satellite are not mixed.
std::vector<std::size_t> serving_records(const std::vector<Ephemeris>& records) {
    std::set<SatelliteId> with_inav, with_legacy, with_ephemeris, with_t0;
    for (const Ephemeris& r : records) {
        if (message_of(r) == NavigationMessage::sbas && !tells_when_it_came(r)) with_t0.insert(satellite_of(r));
        if (message_of(r) == NavigationMessage::inav) with_inav.insert(satellite_of(r));
        if (message_of(r) == NavigationMessage::almanac) continue;
        with_ephemeris.insert(satellite_of(r));
        if (message_of(r) != NavigationMessage::modern) with_legacy.insert(satellite_of(r));
    }
    std::vector<std::size_t> serving;
    for (std::size_t i = 0; i < records.size(); ++i) {
        const NavigationMessage message = message_of(records[i]);
        if (message == NavigationMessage::fnav && with_inav.contains(satellite_of(records[i]))) continue;
        if (message == NavigationMessage::modern && with_legacy.contains(satellite_of(records[i]))) continue;
        if (message == NavigationMessage::almanac && with_ephemeris.contains(satellite_of(records[i]))) continue;
        if (tells_when_it_came(records[i]) && with_t0.contains(satellite_of(records[i]))) continue;
        serving.push_back(i);
    }
    return serving;
}

std::vector<SatelliteRecords> by_satellite(const std::vector<Ephemeris>& records) {
    std::vector<std::size_t> order = serving_records(records);
    const auto issue = [&](std::size_t i) {
        return std::tuple(satellite_of(records[i]), toe_of(records[i]), iode_of(records[i]));
    };
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return issue(a) != issue(b) ? issue(a) < issue(b) : a > b; });
    order.erase(
        std::unique(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return issue(a) == issue(b); }),
        order.end());
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tuple(satellite_of(records[a]), toe_of(records[a]), a) <
               std::tuple(satellite_of(records[b]), toe_of(records[b]), b);
    });

    std::vector<SatelliteRecords> satellites;
    for (const std::size_t i : order) {
        if (satellites.empty() || satellites.back().satellite != satellite_of(records[i]))
            satellites.push_back({satellite_of(records[i]), {}});
        satellites.back().records.push_back(records[i]);
    }
    return satellites;
}

// The last of the records that share the toe of `first`.
std::vector<Ephemeris>::const_iterator last_of_toe(const std::vector<Ephemeris>& records,
                                                   std::vector<Ephemeris>::const_iterator first) {
    return std::upper_bound(first, records.end(), toe_of(*first), time_before_toe) - 1;
}

GpsTime moved_in_utc(GpsTime time, std::int64_t days) {
    const LeapSeconds& leap_seconds = LeapSeconds::announced();
    const Nanoseconds count = time.time_since_epoch() - std::chrono::seconds(leap_seconds.offset(time));
    return from_utc_count(count + days * one_day, leap_seconds);
}

std::int64_t floor_days(Nanoseconds span) { return std::chrono::floor<std::chrono::days>(span).count(); }

// A file may hold records two hundred years apart; those that a move takes past the end of time serve nobody.
bool can_move(const Ephemeris& record, std::int64_t days) {
    constexpr std::chrono::days end =
        std::chrono::floor<std::chrono::days>(GpsTime::max().time_since_epoch()) - 2 * one_day;
    return floor_days(toe_of(record).time_since_epoch()) + days < end.count();
}

}  // namespace

Seconds usual_validity(const Ephemeris& record) {
    if (message_of(record) == NavigationMessage::almanac) return Seconds(static_cast<double>(seconds_per_week));
    // In the order of Constellation.
    static constexpr std::array<double, 7> of_ephemerides{7200, 360, 14400, 21600, 7200, 1800, 7200};
    return Seconds(of_ephemerides[static_cast<std::size_t>(satellite_of(record).constellation)]);
}

Seconds EphemerisSelection::validity_of(const Ephemeris& record) const {
    return validity.value_or(usual_validity(record));
}

NavigationData::NavigationData(const std::vector<Ephemeris>& records, const BroadcastIonosphere& ionosphere,
                               std::string description, EphemerisSelection selection)
    : satellites_(by_satellite(records)),
      ionosphere_(ionosphere),
      description_(std::move(description)),
      selection_(selection) {}

std::vector<SatelliteId> NavigationData::satellites() const {
    std::vector<SatelliteId> ids;
    ids.reserve(satellites_.size());
    for (const SatelliteRecords& s : satellites_)
        ids.push_back(s.satellite);
    return ids;
}

const Ephemeris* NavigationData::find(const SatelliteRecords& satellite, GpsTime time) const {
    const std::vector<Ephemeris>& records = satellite.records;
    const auto valid = [&](const Ephemeris& r) {
        return std::chrono::abs(time - toe_of(r)) <= to_nanoseconds(selection_.validity_of(r));
    };
    const auto next = std::upper_bound(records.begin(), records.end(), time, time_before_toe);
    if (selection_.rule == EphemerisRule::forward) {
        for (auto r = next; r != records.begin();) {
            --r;
            if (!valid(*r)) return nullptr;
            if (is_healthy(*r)) return &*r;
        }
        return nullptr;
    }
    const Ephemeris* nearest = next == records.begin() ? nullptr : &*(next - 1);
    if (next != records.end() && (nearest == nullptr || toe_of(*next) - time <= time - toe_of(*nearest)))
        nearest = &*last_of_toe(records, next);
    return nearest != nullptr && valid(*nearest) ? nearest : nullptr;
}

std::optional<Ephemeris> NavigationData::ephemeris(SatelliteId satellite, GpsTime time) const {
    const auto own = std::lower_bound(satellites_.begin(), satellites_.end(), satellite,
                                      [](const SatelliteRecords& s, SatelliteId id) { return s.satellite < id; });
    if (own == satellites_.end() || own->satellite != satellite) return std::nullopt;
    const Ephemeris* record = find(*own, time);
    if (record == nullptr) return std::nullopt;
    return *record;
}

std::optional<TimeSpan> NavigationData::span() const {
    if (satellites_.empty()) return std::nullopt;
    GpsTime first = GpsTime::max();
    GpsTime last = GpsTime::min();
    const bool before_toe = selection_.rule == EphemerisRule::nearest;
    for (const SatelliteRecords& s : satellites_) {
        const Nanoseconds validity = to_nanoseconds(selection_.validity_of(s.records.front()));
        first = std::min(first, toe_of(s.records.front()) - (before_toe ? validity : Nanoseconds(0)));
        last = std::max(last, toe_of(s.records.back()) + validity);
    }
    return TimeSpan{first, last};
}

std::optional<GpsTime> NavigationData::first_epoch() const {
    std::optional<GpsTime> first;
    for (const SatelliteRecords& s : satellites_)
        first = std::min(first.value_or(GpsTime::max()), toe_of(s.records.front()));
    return first;
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
    // The node's longitude at toe is omega0 − ω_e·toe (IS-GPS-200, table 20-IV), toe being the time of the system's
    // week.
    const bool beidou = record.satellite.constellation == Constellation::beidou;
    const auto time_of_week = [&](GpsTime t) { return beidou ? bdt_week_and_tow(t).tow : week_and_tow(t).tow; };
    const double rate = beidou ? earth_rotation_rate_beidou : earth_rotation_rate;
    const Nanoseconds change = time_of_week(moved.toe) - time_of_week(record.toe);
    const double omega0 = record.omega0 + rate * to_seconds(change).value();
    if (change != Nanoseconds(0)) moved.omega0 = std::remainder(omega0, 2 * std::numbers::pi);
    return moved;
}

Ephemeris moved_by_days(const Ephemeris& record, std::int64_t days) {
    if (const auto* kepler = std::get_if<KeplerEphemeris>(&record)) return moved_by_days(*kepler, days);
    Ephemeris moved = record;
    // State vectors are Earth-fixed: only their time moves.
    if (auto* sbas = std::get_if<SbasEphemeris>(&moved)) sbas->toe += days * one_day;
    if (auto* glonass = std::get_if<GlonassEphemeris>(&moved)) {
        glonass->toe += days * one_day;
        // That of GLONASS is a whole quarter of an hour of UTC, and must stay one where leap seconds came between. The
        // orbit stays where days of GPS time bring it, beside those of the other systems.
        const GpsTime quarter = moved_in_utc(toe_of(record), days);
        if (quarter != glonass->toe) return carried_to(moved, quarter);
    }
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
    std::vector<Ephemeris> records;
    records.reserve(data.record_count());
    for (const SatelliteRecords& s : data.records())
        for (const Ephemeris& r : s.records)
            if (can_move(r, best_days)) records.push_back(moved_by_days(r, best_days));
    return NavigationData(records, data.ionosphere(), data.description(), data.selection());
}

namespace {

// Right ascensions of the ascending nodes of planes A … F at the epoch, degrees (SPS PS 2008, table 3.2-1).
constexpr std::array<double, 6> nominal_nodes_deg{272.847, 332.847, 32.847, 92.847, 152.847, 212.847};
// Greenwich hour angle at the epoch: 18 h 36 min 14.4 s (the same table).
constexpr double greenwich_hour_angle_deg = 279.06;
// 1993-07-01T00:00:00, as week and second of week; the table says 0000Z, and the 9 leap seconds of then move a
// satellite by 0.08°, far less than a slot's tolerance.
constexpr std::int64_t nominal_epoch_week = 703;
constexpr std::int64_t nominal_epoch_tow_s = 4 * seconds_per_day;
constexpr double nominal_semi_major_axis_m = 26559.7e3;
constexpr double nominal_inclination_deg = 55;
// Regression of the nodes by the Earth's oblateness, degrees per second (SPS PS 2001, table A-2-1).
constexpr double nominal_node_rate_deg_s = -4.4874e-7;
constexpr std::int64_t nominal_record_s = 7200;

constexpr std::array<NominalSlot, 31> nominal_slots{{
    {"A1", 268.126},  {"A2", 161.786}, {"A3", 11.676},  {"A4", 41.806},  {"A5", 101.796},  {"B1F", 94.916},
    {"B1A", 66.356},  {"B2", 173.336}, {"B3", 309.976}, {"B4", 204.376}, {"B5", 8.166},    {"C1", 111.876},
    {"C2", 11.796},   {"C3", 339.666}, {"C4", 241.556}, {"C5", 176.716}, {"D1", 135.226},  {"D2F", 282.676},
    {"D2A", 257.976}, {"D3", 35.156},  {"D4", 167.356}, {"E1", 197.046}, {"E2", 302.596},  {"E3", 66.066},
    {"E4", 333.686},  {"E5", 131.556}, {"F1", 238.886}, {"F2F", 0.456},  {"F2A", 334.016}, {"F3", 105.206},
    {"F4", 135.346},
}};

constexpr double nominal_radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }

}  // namespace

std::span<const NominalSlot> NominalConstellation::slots() { return nominal_slots; }

std::vector<SatelliteId> NominalConstellation::satellites() const {
    std::vector<SatelliteId> all;
    for (int number = 1; number <= static_cast<int>(nominal_slots.size()); ++number)
        all.push_back({Constellation::gps, number});
    return all;
}

std::optional<Ephemeris> NominalConstellation::ephemeris(SatelliteId satellite, GpsTime time) const {
    if (auto found = record(satellite, time)) return *found;
    return std::nullopt;
}

std::optional<KeplerEphemeris> NominalConstellation::record(SatelliteId satellite, GpsTime time) const {
    if (satellite.constellation != Constellation::gps || satellite.number < 1 ||
        satellite.number > static_cast<int>(nominal_slots.size()))
        return std::nullopt;
    const NominalSlot& slot = nominal_slots[static_cast<std::size_t>(satellite.number - 1)];
    const double node = nominal_radians(nominal_nodes_deg[static_cast<std::size_t>(slot.name[0] - 'A')]);

    const GpsTime epoch = to_gps_time({nominal_epoch_week, std::chrono::seconds(nominal_epoch_tow_s)});
    const auto elapsed = std::chrono::floor<std::chrono::seconds>(time - epoch).count();
    const std::int64_t count = floor_divide(elapsed, nominal_record_s);

    KeplerEphemeris r;
    r.satellite = satellite;
    r.toe = epoch + std::chrono::seconds(count * nominal_record_s);
    r.toc = r.toe;
    r.sqrt_a = std::sqrt(nominal_semi_major_axis_m);
    r.i0 = nominal_radians(nominal_inclination_deg);
    r.omega_dot = nominal_radians(nominal_node_rate_deg_s);
    // The user algorithm squares sqrt_a again; the mean motion must be the one that it will find.
    const double a = r.sqrt_a * r.sqrt_a;
    const double motion = std::sqrt(gravitational_constant_gps / (a * a * a));
    r.m0 = reduced_angle(nominal_radians(slot.argument_of_latitude_deg), motion * static_cast<double>(nominal_record_s),
                         count);
    // omega0 counts from the start of the week of toe: the Earth's rotation since then is the algorithm's, whole weeks
    // are taken out here.
    const std::int64_t weeks = week_and_tow(r.toe).week - nominal_epoch_week;
    const double node_at_epoch = node - nominal_radians(greenwich_hour_angle_deg) +
                                 earth_rotation_rate * static_cast<double>(nominal_epoch_tow_s);
    r.omega0 = reduced_angle(node_at_epoch + r.omega_dot * static_cast<double>(count * nominal_record_s),
                             -earth_rotation_rate * static_cast<double>(seconds_per_week), weeks);
    r.accuracy_m = 2;
    r.fit_interval_h = 4;
    r.iode = static_cast<int>(((count % 256) + 256) % 256);
    r.iodc = r.iode;
    return r;
}

}  // namespace skyloop::inline world
