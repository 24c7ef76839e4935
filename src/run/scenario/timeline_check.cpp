#include "run/scenario/timeline_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "run/fault/command.hpp"
#include "run/fault/fault_kind.hpp"
#include "run/fault/timeline.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::size_t most_events_looked_at = 10'000;  // what comes every millisecond comes for ever

template <class Entry>
std::optional<std::string> early_time(std::string_view table, const std::vector<Entry>& entries, GpsTime start) {
    for (const Entry& entry : entries)
        if (entry.when.at_time && *entry.when.at_time < start)
            return entry.told_at +
                   fmt::format("[[{}]] '{}': at_utc is {}, before the start of the run; expected {} or later", table,
                               entry.when.name, utc_text(*entry.when.at_time, 3), utc_text(start, 3));
    return std::nullopt;
}

// When it begins for the first time, where that depends on nothing else.
std::optional<GpsTime> first_beginning(const TimelineEntry& entry, GpsTime start, std::uint64_t seed) {
    if (!entry.after.empty()) return std::nullopt;
    return Timeline({entry}, start, seed).next_event();
}

// Weeks are counted from the beginning of GPS time; before it there are none to roll back to.
std::optional<std::string> too_early_to_roll_over(const FaultEntry& fault, GpsTime start, std::uint64_t seed) {
    if (fault.kind != "week_rollover") return std::nullopt;
    const double rollovers = fault.parameters.optional_number("rollovers").value_or(1);
    const GpsTime first = advanced(GpsTime{}, Seconds(rollovers * 1024 * static_cast<double>(seconds_per_week)));
    const GpsTime begins = first_beginning(fault.when, start, seed).value_or(start);
    if (begins >= first) return std::nullopt;
    return fault.told_at +
           fmt::format(
               "[[fault]] '{}': rollovers = {:g} leads to before 1980-01-06; expected {}a beginning at {} or "
               "later",
               fault.when.name, rollovers, rollovers > 1 ? "fewer, or " : "", utc_text(first, 3));
}

// A mount point that is mistaken for another one is there.
std::optional<std::string> unknown_mount_point(const FaultEntry& fault, const Scenario& scenario) {
    if (fault.kind != "wrong_mount_point") return std::nullopt;
    const std::string name = fault.parameters.text("of_receiver");
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i)
        names.push_back(receiver_name(scenario, i));
    if (std::find(names.begin(), names.end(), name) != names.end()) return std::nullopt;
    const std::vector<std::string_view> candidates(names.begin(), names.end());
    return fault.told_at +
           fmt::format("[[fault]] '{}': of_receiver is '{}'; expected the name of a receiver of the run{}",
                       fault.when.name, name, did_you_mean(name, candidates));
}

// Which entries begin before the end, or may: those that a command starts among them.
std::vector<bool> may_begin(const std::vector<TimelineEntry>& entries, const TimelineSpan& run) {
    std::vector<bool> may = hang_on_the_run(entries);
    for (const TimelineEvent& event : planned_events(entries, run, most_events_looked_at))
        may[event.entry] = true;
    return may;
}

void warn_of_late(std::string_view table, const TimelineEntry& entry, const TimelineSpan& run,
                  std::vector<std::string>& warnings) {
    const auto begins = first_beginning(entry, run.start, run.seed);
    if (begins && *begins > run.end)
        warnings.push_back(fmt::format(
            "[[{}]] '{}' will not begin: it is due {:g} s after the start of the run, which ends after {:g} s", table,
            entry.name, difference(*begins, run.start).value(), difference(run.end, run.start).value()));
}

// What is known of the timeline before the run.
struct KnownTimeline {
    struct Entry {
        std::string name, kind;
        bool open = false;     // it depends on what the run will bring
        bool command = false;  // it ends as it begins
        [[nodiscard]] bool is_called(const std::string& by) const { return name == by || kind == by; }
    };
    std::vector<Entry> entries;
    std::vector<TimelineEvent> events;  // by the end of the run, or as many as are looked at
};

KnownTimeline known_timeline(const Scenario& scenario, GpsTime start, GpsTime end) {
    const std::vector<TimelineEntry> entries = timeline_of(scenario);
    const std::vector<bool> open = hang_on_the_run(entries);
    KnownTimeline known;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const bool command = i >= scenario.faults.size();
        known.entries.push_back(
            {entries[i].name,
             command ? std::string(command_name(scenario.commands[i - scenario.faults.size()].command.verb))
                     : scenario.faults[i].kind,
             open[i], command});
    }
    known.events = planned_events(entries, {start, end, scenario.run.seed}, most_events_looked_at);
    return known;
}

// The occurrence that a sentence names, or the first of all; counted as the judge does, as they begin, over all entries
// that the name fits.
struct Occurrence {
    std::optional<GpsTime> begins{}, ends{};
};

Occurrence occurrence_of(const EventReference& event, const KnownTimeline& known) {
    Occurrence found;
    std::map<std::pair<std::size_t, int>, int> numbers;  // by entry and its own count
    int begun = 0;
    for (const TimelineEvent& e : known.events) {
        const KnownTimeline::Entry& entry = known.entries[e.entry];
        if (!entry.is_called(event.name)) continue;
        int& number = numbers[{e.entry, e.occurrence}];
        if (e.begins) number = ++begun;
        if (event.occurrence && *event.occurrence != number) continue;
        if (e.begins && !found.begins) found.begins = e.time;
        if ((!e.begins || entry.command) && !found.ends) found.ends = e.time;
    }
    return found;
}

// Why the event of a sentence does not come; empty: it does, or may. @param at its first time, where that is known
std::string why_no_event(const EventReference& event, const KnownTimeline& known, std::optional<GpsTime>& at) {
    at.reset();
    for (const KnownTimeline::Entry& entry : known.entries)
        if (entry.open && entry.is_called(event.name)) return "";
    const Occurrence occurrence = occurrence_of(event, known);
    at = event.end ? occurrence.ends : occurrence.begins;
    if (at || known.events.size() >= most_events_looked_at) return "";
    const std::string name = event.name + (event.occurrence ? fmt::format("#{}", *event.occurrence) : std::string());
    return occurrence.begins ? fmt::format("'{}' does not end before the run does", name)
                             : fmt::format("'{}' does not begin before the run ends", name);
}

// A silence that begins in time shows when it has lasted.
TimeClause watched(const ExpectedSentence& sentence) {
    TimeClause time = sentence.time;
    const ExpectedSubject subject = sentence.subject.subject;
    const bool silence = subject == ExpectedSubject::client_silent || subject == ExpectedSubject::receiver_silent;
    if (silence && time.rule == TimeRule::within) time.until = *time.until + sentence.subject.silence;
    return time;
}

// Why a sentence cannot be decided by the end, or may not be; empty: it can.
std::string why_too_late(const TimeClause& time, const KnownTimeline& known, GpsTime start, GpsTime end) {
    std::optional<GpsTime> origin = start;
    if (time.event && time.event->is_run()) {
        if (time.event->end) return {};
    } else if (time.event) {
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

void warn_of_expectations(const Scenario& scenario, GpsTime start, GpsTime end, std::vector<std::string>& warnings) {
    const KnownTimeline known = known_timeline(scenario, start, end);
    for (const Expectation& expectation : scenario.expectations) {
        std::string why;
        if (expectation.sentence) why = why_too_late(watched(*expectation.sentence), known, start, end);
        if (expectation.probe)
            why = why_no_time(*expectation.probe, scenario.run.speed, difference(end, start).value());
        if (!why.empty()) warnings.push_back(fmt::format("[[expect]] '{}' {}", expectation.title(), why));
    }
}

}  // namespace

Result<void> check_timeline(const Scenario& scenario, GpsTime start) {
    for (const FaultEntry& fault : scenario.faults) {
        const FaultKind* kind = find_fault_kind(fault.kind);
        if (kind != nullptr && kind->measuring_receivers_only && scenario.model.sensor_model)
            return fail(ErrorCode::input,
                        fmt::format("{}[[fault]] '{}': kind = \"{}\" spoils measurements, and model.name = \"{}\" "
                                    "makes none; expected model.name = \"modern\"",
                                    fault.told_at, fault.when.name, fault.kind, model_name(scenario.model)));
    }
    for (const FaultEntry& fault : scenario.faults)
        if (const auto mistake = too_early_to_roll_over(fault, start, scenario.run.seed))
            return fail(ErrorCode::input, *mistake);
    for (const FaultEntry& fault : scenario.faults)
        if (const auto mistake = unknown_mount_point(fault, scenario)) return fail(ErrorCode::input, *mistake);
    auto early = early_time("fault", scenario.faults, start);
    if (!early) early = early_time("command", scenario.commands, start);
    if (early) return fail(ErrorCode::input, *early);
    return {};
}

std::vector<std::string> timeline_warnings(const Scenario& scenario, GpsTime start, GpsTime end) {
    std::vector<std::string> warnings;
    const TimelineSpan run{start, end, scenario.run.seed};
    const std::vector<TimelineEntry> entries = timeline_of(scenario);
    const std::vector<bool> may = may_begin(entries, run);
    for (std::size_t i = 0; i < entries.size(); ++i)
        if (!may[i]) warn_of_late(i < scenario.faults.size() ? "fault" : "command", entries[i], run, warnings);
    warn_of_expectations(scenario, start, end, warnings);
    return warnings;
}

}  // namespace skyloop::inline run
