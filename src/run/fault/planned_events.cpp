#include <fmt/format.h>

#include <algorithm>

#include "run/fault/timeline.hpp"

namespace skyloop::inline run {
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

namespace {

// A list for people; who wants thousands of periods reads how often they come.
constexpr std::size_t most_lines = 200;
constexpr std::size_t most_events = 100'000;

std::string seconds_text(double seconds) { return fmt::format("{:.3f} s", seconds); }

std::string conditions(const Trigger& trigger) {
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : " and ") + part; };
    if (trigger.height_above) add(fmt::format("above {:g} m", trigger.height_above->value()));
    if (trigger.height_below) add(fmt::format("below {:g} m", trigger.height_below->value()));
    if (trigger.speed_above) add(fmt::format("faster than {:g} m/s", trigger.speed_above->value()));
    if (!trigger.inside.empty()) add(fmt::format("inside a polygon of {} corners", trigger.inside.size()));
    if (trigger.fix_for) add(fmt::format("after a fix for {:g} s", trigger.fix_for->value()));
    if (!trigger.vehicle_mode.empty()) add(fmt::format("the vehicle's mode is {}", trigger.vehicle_mode));
    if (trigger.custom_mode) add(fmt::format("the vehicle's custom_mode is {}", *trigger.custom_mode));
    if (trigger.armed) add(*trigger.armed ? "the vehicle is armed" : "the vehicle is disarmed");
    if (!trigger.client_sends.empty()) add(fmt::format("the client sends {}", trigger.client_sends));
    return text;
}

std::string consequence(const TimelineEntry& entry) {
    std::string begins = fmt::format("{:g} s", entry.at.value_or(Seconds(0)).value());
    if (entry.between) begins = fmt::format("{:g} to {:g} s", (*entry.between)[0], (*entry.between)[1]);
    return fmt::format("{:>14}  {}: {} after {}{}", "then", entry.name, begins, entry.after_end ? "the end of " : "",
                       entry.after);
}

std::string line(const TimelineEvent& event, const TimelineEntry& entry, GpsTime start) {
    const double at = difference(event.time, start).value();
    const std::string number = event.occurrence > 1 ? fmt::format(" (no. {})", event.occurrence) : "";
    const std::string_view what = entry.once ? "" : event.begins ? " begins" : " ends";
    return fmt::format("{:>14}  {}{}{}", seconds_text(at), entry.name, what, number);
}

}  // namespace

std::vector<std::string> timeline_text(const std::vector<TimelineEntry>& entries, const TimelineSpan& run) {
    const std::vector<TimelineEvent> events = planned_events(entries, run, most_events);
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < std::min(events.size(), most_lines); ++i)
        lines.push_back(line(events[i], entries[events[i].entry], run.start));
    if (events.size() > most_lines) lines.push_back(fmt::format("{:>14}  and {} more", "", events.size() - most_lines));
    for (const TimelineEntry& entry : entries)
        if (entry.when) lines.push_back(fmt::format("{:>14}  {}: {}", "when", entry.name, conditions(*entry.when)));
    const std::vector<bool> hanging = hang_on_the_run(entries);
    for (std::size_t i = 0; i < entries.size(); ++i)
        if (hanging[i] && !entries[i].after.empty()) lines.push_back(consequence(entries[i]));
    return lines;
}

}  // namespace skyloop::inline run
