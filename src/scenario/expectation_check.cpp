#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "skyloop/fault/command.hpp"
#include "skyloop/fault/planned_events.hpp"
#include "skyloop/scenario/timeline_check.hpp"

namespace skyloop {
namespace {

constexpr std::size_t most_events_looked_at = 10'000;  // what comes every millisecond comes for ever

// What is known of an entry before the run.
struct KnownEntry {
    std::string name, kind;
    bool open = false;                        // it depends on what the run will bring
    int begun = 0;                            // by the end of the run
    std::optional<GpsTime> begins{}, ends{};  // the first time
};

std::vector<KnownEntry> known_entries(const Scenario& scenario, GpsTime start, GpsTime end) {
    const std::vector<TimelineEntry> entries = timeline_of(scenario);
    const std::vector<bool> open = hang_on_the_run(entries);
    std::vector<KnownEntry> known(entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
        known[i].name = entries[i].name;
        known[i].kind = i < scenario.faults.size()
                            ? scenario.faults[i].kind
                            : command_name(scenario.commands[i - scenario.faults.size()].command.verb);
        known[i].open = open[i];
    }
    for (const TimelineEvent& event : planned_events(entries, {start, end, scenario.run.seed}, most_events_looked_at)) {
        KnownEntry& entry = known[event.entry];
        auto& first = event.begins ? entry.begins : entry.ends;
        if (!first) first = event.time;
        entry.begun += event.begins ? 1 : 0;
    }
    return known;
}

// Why the event of a sentence does not come; empty: it does, or may. @param at its first time, where that is known
std::string why_no_event(const EventReference& event, const std::vector<KnownEntry>& known,
                         std::optional<GpsTime>& at) {
    int begun = 0;
    for (const KnownEntry& entry : known) {
        if (entry.name != event.name && entry.kind != event.name) continue;
        if (entry.open) return at.reset(), "";
        begun += entry.begun;
        const auto& first = event.end ? entry.ends : entry.begins;
        if (first && (!at || *first < *at)) at = first;
    }
    if (begun < event.occurrence.value_or(1))
        return fmt::format("'{}{}' does not begin before the run ends", event.name,
                           event.occurrence ? fmt::format("#{}", *event.occurrence) : "");
    if (!at) return fmt::format("'{}' does not end before the run does", event.name);
    if (event.occurrence.value_or(1) > 1) at.reset();  // a later time than the first
    return {};
}

// Why a sentence cannot be decided by the end, or may not be; empty: it can.
std::string why_too_late(const TimeClause& time, const std::vector<KnownEntry>& known, GpsTime start, GpsTime end) {
    std::optional<GpsTime> origin = start;
    if (time.event && time.event->is_run()) {
        if (time.event->end) return {};
    } else if (time.event) {
        origin.reset();
        if (time.rule == TimeRule::until_event) return {};  // it holds until the end where nothing comes
        if (std::string why = why_no_event(*time.event, known, origin); !why.empty()) return "cannot be met: " + why;
    }
    if (!origin) return {};
    const auto late = [&](Seconds offset) { return advanced(*origin, offset) > end; };
    const auto shown = [&](Seconds offset) { return difference(advanced(*origin, offset), start).value(); };
    const double length = difference(end, start).value();
    if (late(time.from))
        return fmt::format("cannot be met: it is due {:g} s after the start of the run, which ends after {:g} s",
                           shown(time.from), length);
    const bool lasts = time.never || time.rule == TimeRule::from_to || time.rule == TimeRule::after;
    if (lasts && time.until && late(*time.until))
        return fmt::format("cannot be met: it lasts until {:g} s after the start of the run, which ends after {:g} s",
                           shown(*time.until), length);
    if (time.until && late(*time.until))  // it may come true before
        return fmt::format(
            "may stay undecided: it has until {:g} s after the start of the run, which ends after {:g} s",
            shown(*time.until), length);
    return {};
}

// The same of a command, whose own times are the host's. @param speed simulated seconds of each of them
std::string why_no_time(const Probe& probe, double speed, double length) {
    const double at = probe.at.value();
    if (at >= length)
        return fmt::format("cannot be met: it is asked {:g} s after the start of the run, which ends after {:g} s", at,
                           length);
    const double until = at + probe.within.value_or(probe.timeout).value() * speed;
    if (until <= length) return {};
    return fmt::format("may stay undecided: it has until {:g} s after the start of the run, which ends after {:g} s",
                       until, length);
}

}  // namespace

std::vector<std::string> expectation_warnings(const Scenario& scenario, GpsTime start, GpsTime end) {
    const std::vector<KnownEntry> known = known_entries(scenario, start, end);
    std::vector<std::string> warnings;
    for (const Expectation& expectation : scenario.expectations) {
        std::string why;
        if (expectation.sentence) why = why_too_late(expectation.sentence->time, known, start, end);
        if (expectation.probe)
            why = why_no_time(*expectation.probe, scenario.run.speed, difference(end, start).value());
        if (!why.empty()) warnings.push_back(fmt::format("[[expect]] '{}' {}", expectation.title(), why));
    }
    return warnings;
}

}  // namespace skyloop
