#include "run/scenario/timeline_check.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/time/utc_time.hpp"
#include "run/fault/fault_kind.hpp"
#include "run/fault/planned_events.hpp"

namespace skyloop {
namespace {

std::string check_utc_text(GpsTime time) { return format_utc(to_utc(time, LeapSeconds::announced())); }

template <class Entry>
std::optional<std::string> early_time(std::string_view table, const std::vector<Entry>& entries, GpsTime start) {
    for (const Entry& entry : entries)
        if (entry.when.at_time && *entry.when.at_time < start)
            return entry.told_at +
                   fmt::format("[[{}]] '{}': at_utc is {}, before the start of the run; expected {} or later", table,
                               entry.when.name, check_utc_text(*entry.when.at_time), check_utc_text(start));
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
               fault.when.name, rollovers, rollovers > 1 ? "fewer, or " : "", check_utc_text(first));
}

// Which entries begin before the end, or may: those that a command starts among them.
std::vector<bool> may_begin(const std::vector<TimelineEntry>& entries, const TimelineSpan& run) {
    constexpr std::size_t most_looked_at = 10'000;  // what comes every millisecond comes for ever
    std::vector<bool> may = hang_on_the_run(entries);
    for (const TimelineEvent& event : planned_events(entries, run, most_looked_at))
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
    for (std::string& warning : expectation_warnings(scenario, start, end))
        warnings.push_back(std::move(warning));
    return warnings;
}

}  // namespace skyloop
