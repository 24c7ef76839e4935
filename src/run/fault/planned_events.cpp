#include "run/fault/planned_events.hpp"

#include <algorithm>

namespace skyloop {
namespace {

bool concerns(const TimelineOrder& order, const TimelineEntry& entry) {
    return !entry.once && (order.fault.empty() || order.fault == entry.name);
}

// As the run does it: what is under way does not begin a second time, nor anything else of its name.
void obey(const TimelineOrder& order, GpsTime now, Timeline& timeline) {
    const auto& entries = timeline.entries();
    for (std::size_t i = 0; i < entries.size(); ++i)
        if (order.begins && !order.fault.empty() && concerns(order, entries[i]) && timeline.is_under_way(i)) return;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (!concerns(order, entries[i])) continue;
        if (order.begins)
            timeline.begin(i, now, order.length);
        else
            timeline.end(i, now);
    }
}

bool hangs(const std::vector<TimelineEntry>& entries, const std::vector<bool>& known, std::size_t index) {
    const TimelineEntry& entry = entries[index];
    if (entry.when) return true;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (!known[i]) continue;
        const bool follows = !entry.after.empty() && entries[i].name == entry.after;
        if (follows || (entries[i].order && concerns(*entries[i].order, entry))) return true;
    }
    return false;
}

}  // namespace

std::vector<TimelineEvent> planned_events(const std::vector<TimelineEntry>& entries, const TimelineSpan& run,
                                          std::size_t most) {
    std::vector<TimelineEvent> events;
    Timeline timeline(entries, run.start, run.seed);
    while (events.size() < most && timeline.next_event() && *timeline.next_event() <= run.end)
        for (const TimelineEvent& event : timeline.advance(*timeline.next_event())) {
            events.push_back(event);
            if (const auto& order = entries[event.entry].order) obey(*order, event.time, timeline);
        }
    return events;
}

std::vector<bool> hang_on_the_run(const std::vector<TimelineEntry>& entries) {
    std::vector<bool> found(entries.size());
    // Each round finds what hangs on those of the round before.
    for (bool more = true; more;) {
        more = false;
        for (std::size_t i = 0; i < entries.size(); ++i)
            if (!found[i] && hangs(entries, found, i)) found[i] = more = true;
    }
    return found;
}

}  // namespace skyloop
