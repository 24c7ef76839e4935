#include "run/fault/timeline.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "base/core/random.hpp"
#include "receiver/protocol/mavlink.hpp"
#include "run/fault/known_names.hpp"

namespace skyloop::inline run {
namespace {

// A period shorter than this would make more events than a run has instants.
constexpr Seconds shortest_period{1e-3};

double drawn(std::uint64_t seed, const std::string& stream, const std::array<double, 2>& bounds) {
    RandomStream random(seed, stream);
    return bounds[0] + (bounds[1] - bounds[0]) * random.uniform();
}

std::string stream_name(const TimelineEntry& entry, std::string_view of, int occurrence) {
    return "timeline." + entry.name + "." + std::string(of) + "." + std::to_string(occurrence);
}

// Degrees by which the longitude grows from a corner to the next, the short way.
double eastward(const std::array<double, 2>& from, const std::array<double, 2>& to) {
    return std::remainder(to[1] - from[1], 360);
}

// An area smaller than half the Earth whose edges are straight in latitude and longitude, each the short way. Edges
// that lead once round hold a pole: the one that they are nearer to.
bool holds_north_pole(const std::vector<std::array<double, 2>>& polygon) {
    double turned = 0, latitudes = 0;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        turned += eastward(polygon[j], polygon[i]);
        latitudes += polygon[i][0];
    }
    return std::abs(turned) > 180 && latitudes > 0;
}

// Who goes north from the place to the pole crosses the edges an odd number of times where one of both is inside.
bool is_inside(const Geodetic& place, const std::vector<std::array<double, 2>>& polygon) {
    const std::array here{place.latitude.deg(), place.longitude.deg()};
    bool inside = holds_north_pole(polygon);
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const double from = eastward(here, polygon[j]), to = eastward(here, polygon[i]);
        const bool on_this_side = std::abs(to - from) <= 180;  // else it crosses the meridian behind the pole
        if ((from > 0) == (to > 0) || !on_this_side) continue;
        const double latitude = polygon[j][0] + (polygon[i][0] - polygon[j][0]) * from / (from - to);
        if (latitude > here[0]) inside = !inside;
    }
    return inside;
}

bool comes_before(const TimelineEvent& one, const TimelineEvent& other) {
    const auto key = [](const TimelineEvent& e) { return std::tuple(e.time, e.begins, e.entry, e.occurrence); };
    return key(one) < key(other);
}

}  // namespace

Timeline::Timeline(std::vector<TimelineEntry> entries, GpsTime start, std::uint64_t seed)
    : entries_(std::move(entries)), seed_(seed), states_(entries_.size()) {
    for (std::size_t i = 0; i < entries_.size(); ++i)
        if (!entries_[i].when && entries_[i].after.empty() && !entries_[i].by_hand) plan_from(i, start);
}

void Timeline::plan_from(std::size_t index, GpsTime origin) {
    const TimelineEntry& entry = entries_[index];
    if (entry.at_time) return plan(index, *entry.at_time);
    Seconds offset = entry.at.value_or(Seconds(0));
    if (entry.between)
        offset = Seconds(drawn(seed_, stream_name(entry, "begin", states_[index].drawn + 1), *entry.between));
    plan(index, advanced(origin, offset));
}

// Which occurrence it is, is known when it begins: others may come in between.
void Timeline::plan(std::size_t index, GpsTime begin, bool by_hand, std::optional<Seconds> length) {
    TimelineEvent event{index, 0, true, begin, by_hand, length};
    if (!by_hand) ++states_[index].drawn;
    // What an epoch has shown acts behind it: as long as told, and on as many epochs as if it had been known before.
    const bool shown = entries_[index].when && !by_hand;
    if (shown && looked_ && event.time <= *looked_) event.time = *looked_ + Nanoseconds(1);
    insert(event);
}

void Timeline::insert(const TimelineEvent& event) {
    planned_.insert(std::upper_bound(planned_.begin(), planned_.end(), event, comes_before), event);
}

std::optional<Seconds> Timeline::length_of(const TimelineEvent& event) const {
    const TimelineEntry& entry = entries_[event.entry];
    if (event.length) return event.length;
    if (!entry.length_between) return entry.length;
    return Seconds(drawn(seed_, stream_name(entry, "length", event.occurrence), *entry.length_between));
}

void Timeline::plan_end(const TimelineEvent& begin) {
    const auto length = length_of(begin);
    if (!length) return;
    TimelineEvent end = begin;
    end.begins = false;
    end.time = advanced(begin.time, *length);
    insert(end);
}

void Timeline::follow(const TimelineEvent& event) {
    const TimelineEntry& entry = entries_[event.entry];
    if (event.begins) {
        if (!entry.once) {
            states_[event.entry].under_way.insert(event.occurrence);
            plan_end(event);
        }
        if (entry.every && !event.by_hand && (!entry.times || states_[event.entry].begun_by_itself < *entry.times))
            plan(event.entry, advanced(event.time, std::max(*entry.every, shortest_period)));
    } else {
        states_[event.entry].under_way.erase(event.occurrence);
    }
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const bool from_end = entries_[i].after_end && !entry.once;
        if (entries_[i].after == entry.name && from_end != event.begins) plan_from(i, event.time);
    }
}

std::vector<TimelineEvent> Timeline::advance(GpsTime now) {
    std::vector<TimelineEvent> due;
    while (!planned_.empty() && planned_.front().time <= now) {
        TimelineEvent event = planned_.front();
        planned_.erase(planned_.begin());
        // A fault works once at a time: twice the same step would be another one. It ends, and begins anew.
        if (event.begins && is_under_way(event.entry)) {
            if (event.by_hand) continue;
            end(event.entry, event.time);
            insert(event);
            continue;
        }
        if (event.begins) event.occurrence = ++states_[event.entry].begun;
        if (event.begins && !event.by_hand) ++states_[event.entry].begun_by_itself;
        due.push_back(event);
        follow(event);
    }
    return due;
}

std::optional<GpsTime> Timeline::next_event() const {
    if (planned_.empty()) return std::nullopt;
    return planned_.front().time;
}

std::size_t Timeline::add(TimelineEntry entry) {
    entry.by_hand = true;
    entries_.push_back(std::move(entry));
    states_.emplace_back();
    return entries_.size() - 1;
}

bool Timeline::begin(std::size_t index, GpsTime now, std::optional<Seconds> length) {
    if (is_under_way(index)) return false;
    plan(index, now, true, length);
    return true;
}

bool Timeline::can_end(std::size_t index) const {
    return is_under_way(index) || std::any_of(planned_.begin(), planned_.end(), [&](const TimelineEvent& event) {
               return event.entry == index && event.begins && event.by_hand;
           });
}

bool Timeline::end(std::size_t index, GpsTime now) {
    if (!can_end(index)) return false;
    std::erase_if(planned_, [&](const TimelineEvent& event) {
        return event.entry == index &&
               (event.begins ? event.by_hand : states_[index].under_way.contains(event.occurrence));
    });
    for (const int occurrence : states_[index].under_way)
        insert({index, occurrence, false, now});
    return true;
}

bool Timeline::vehicle_holds(const Trigger& trigger) const {
    if (!trigger.vehicle_mode.empty() && !is_mavlink_mode(vehicle_.mode, trigger.vehicle_mode)) return false;
    if (trigger.custom_mode && vehicle_.custom_mode != trigger.custom_mode) return false;
    return !trigger.armed || vehicle_.armed == trigger.armed;
}

bool Timeline::holds(const Trigger& trigger, GpsTime now) const {
    if (!vehicle_holds(trigger)) return false;
    if (trigger.fix_for && !(fix_since_ && now >= advanced(*fix_since_, *trigger.fix_for))) return false;
    if (trigger.speed_above && !(last_view_.speed > *trigger.speed_above)) return false;
    if (!trigger.height_above && !trigger.height_below && trigger.inside.empty()) return true;
    if (!last_view_.place) return false;
    const Metres height = last_view_.place->height.above_ellipsoid;
    if (trigger.height_above && !(height > *trigger.height_above)) return false;
    if (trigger.height_below && !(height < *trigger.height_below)) return false;
    return trigger.inside.empty() || is_inside(*last_view_.place, trigger.inside);
}

void Timeline::look(GpsTime now, const TriggerView& view) {
    last_view_ = view;
    looked_ = now;
    if (!view.has_fix)
        fix_since_.reset();
    else if (!fix_since_)
        fix_since_ = now;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const auto& trigger = entries_[i].when;
        if (!trigger || !trigger->client_sends.empty()) continue;
        const bool held = std::exchange(states_[i].held, holds(*trigger, now));
        const bool comes_true = states_[i].held && !held;
        if (comes_true) act(i, now);
    }
}

void Timeline::hear(GpsTime now, std::string_view client_message) {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const auto& trigger = entries_[i].when;
        if (trigger && !trigger->client_sends.empty() && is_message_named(client_message, trigger->client_sends) &&
            holds(*trigger, now))
            act(i, now);
    }
}

void Timeline::act(std::size_t index, GpsTime now) {
    if (states_[index].triggered && !entries_[index].again) return;
    states_[index].triggered = true;
    plan_from(index, now);
}

}  // namespace skyloop::inline run
