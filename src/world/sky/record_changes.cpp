#include "world/sky/record_changes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "world/gnss/constants.hpp"
#include "world/gnss/earth_turn.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop {
namespace {

constexpr std::chrono::minutes change_length{5};
constexpr std::chrono::seconds search_step{30};  // no satellite changes its record twice in it
constexpr double longest_step_m = 10;

bool is_same_record(const Ephemeris& a, const Ephemeris& b) {
    return toe_of(a) == toe_of(b) && iode_of(a) == iode_of(b) && message_of(a) == message_of(b);
}

// The first nanosecond at which `before` serves no more; it does at `from` and does not at `to`.
GpsTime change_between(const Ephemeris& before, const NavigationSource& source, GpsTime from, GpsTime to) {
    while (to - from > Nanoseconds(1)) {
        const GpsTime middle = from + (to - from) / 2;
        const std::optional<Ephemeris> there = source.ephemeris(satellite_of(before), middle);
        (there && is_same_record(*there, before) ? from : to) = middle;
    }
    return to;
}

// Position in the frame of the reception and clock, as one record minus another.
struct RecordStep {
    Eigen::Vector3d position, velocity;
    double clock_m = 0, clock_mps = 0;
};

RecordStep step_between(const Ephemeris& before, const Ephemeris& after, GpsTime now, Seconds travel_time) {
    const SatelliteState a = satellite_state(before, now, -travel_time), b = satellite_state(after, now, -travel_time);
    return {turned_by(a.position.vector() - b.position.vector(), travel_time.value()),
            turned_by(a.velocity.vector() - b.velocity.vector(), travel_time.value()),
            speed_of_light * (a.clock_bias - b.clock_bias), speed_of_light * (a.clock_drift - b.clock_drift)};
}

}  // namespace

void RecordChanges::add_change(Satellite& satellite, const Change& change, const Ephemeris& after) {
    const RecordStep step = step_between(change.before, after, change.time, Seconds(0));
    if (step.position.norm() + std::abs(step.clock_m) <= longest_step_m) {
        satellite.changes.push_back(change);
        return;
    }
    satellite.changes.clear();
    satellite.jumped = change.time;
}

// From the last look on.
void RecordChanges::find_changes(Satellite& satellite, SatelliteId id, const NavigationSource& source, GpsTime now) {
    for (GpsTime from = satellite.looked; from < now;) {
        const GpsTime to = std::min<GpsTime>(from + search_step, now);
        std::optional<Ephemeris> after = source.ephemeris(id, to);
        if (!after) {
            satellite.changes.clear();
        } else if (satellite.record && !is_same_record(*satellite.record, *after)) {
            add_change(satellite, {change_between(*satellite.record, source, from, to), *satellite.record}, *after);
        }
        satellite.record = std::move(after);
        from = to;
    }
}

void RecordChanges::follow(Satellite& satellite, const Ephemeris& record, const NavigationSource& source, GpsTime now) {
    const Nanoseconds passed = now - satellite.looked;
    const bool followed = satellite.record && passed >= Nanoseconds(0) && passed <= search_step;
    if (!followed) {
        const GpsTime start = now - change_length;
        satellite = {start, source.ephemeris(satellite_of(record), start), {}, std::nullopt};
    }
    // What served at both ends served in between.
    if (!satellite.record || !is_same_record(*satellite.record, record))
        find_changes(satellite, satellite_of(record), source, now);
    satellite.looked = now;
    std::erase_if(satellite.changes, [now](const Change& change) { return now - change.time >= change_length; });
    if (satellite.jumped && now - *satellite.jumped >= change_length) satellite.jumped.reset();
}

EarlierRecords RecordChanges::at(const Ephemeris& record, const NavigationSource& source, GpsTime now,
                                 const RecordRay& ray) {
    Satellite& satellite = satellites_[satellite_of(record)];
    follow(satellite, record, source, now);
    EarlierRecords result{{}, {}, satellite.jumped};
    const double range = ray.way.norm();
    const Eigen::Vector3d sight = ray.way / range;
    const Eigen::Vector3d sight_rate = (ray.velocity - sight * sight.dot(ray.velocity)) / range;
    for (std::size_t i = 0; i < satellite.changes.size(); ++i) {
        const Change& change = satellite.changes[i];
        const Ephemeris& after = i + 1 < satellite.changes.size() ? satellite.changes[i + 1].before : record;
        const RecordStep step = step_between(change.before, after, now, ray.travel_time);
        const double longer = sight.dot(step.position) - step.clock_m;
        const double rate = sight.dot(step.velocity) + sight_rate.dot(step.position) - step.clock_mps;
        constexpr double length_s = std::chrono::seconds(change_length).count();
        const double passed = difference(now, change.time).value() / length_s;
        const double share = 1 - passed * passed * (3 - 2 * passed), fall = -6 * passed * (1 - passed) / length_s;
        result.range += Metres(share * longer);
        result.range_rate += MetresPerSecond(share * rate + fall * longer);
    }
    return result;
}

}  // namespace skyloop
