// Wrong time: in the reports alone, since the receiver solves with the right one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/time/utc_time.hpp"
#include "detail/fault_catalogue.hpp"

namespace skyloop::inline run {
namespace {

using firmware::NavigationState;

constexpr std::int64_t weeks_of_rollover = 1024;

// Satellites tell the week of a leap second in eight bits (WNLSF; IS-GPS-200, 20.3.3.5.2.4): it is the one nearest to
// the time that the receiver believes. Whichever fault came first, its count of leap seconds follows from these two.
void count_by_leap_event(NavigationState& state) {
    if (!state.leap_event) return;
    Fix& fix = state.epoch.fix;
    firmware::LeapEvent& event = *state.leap_event;
    constexpr double cycle_s = 256.0 * static_cast<double>(seconds_per_week);
    const auto cycles = static_cast<std::int64_t>(std::round(difference(fix.time, event.at).value() / cycle_s));
    event.at += std::chrono::seconds(cycles * 256 * seconds_per_week);
    fix.leap_seconds = fix.time >= event.at ? event.after : event.before;
}

// Times before 1980 cannot be told: the reports stay at the beginning of GPS time.
void shift_time(NavigationState& state, Nanoseconds by) {
    Fix& fix = state.epoch.fix;
    fix.time = std::max(GpsTime{}, fix.time + by);
    GpsTime& measured = state.epoch.observations.receive_time;
    measured = std::max(GpsTime{}, measured + by);
    count_by_leap_event(state);
}

// Its UTC days end by the same count, one that a leap second waits for among them.
Result<Fault> make_leap_second_wrong(const Parameters& parameters, const FaultContext&) {
    const auto error = static_cast<int>(parameters.number("error_s"));
    const bool declared_valid = parameters.flag("declared_valid");
    return fault_of<&Fault::report>([error, declared_valid](NavigationState& state, const FaultMoment&) {
        state.epoch.fix.leap_seconds += error;
        state.time.leap_seconds = declared_valid;
        if (!state.leap_event) return;
        state.leap_event->at += std::chrono::seconds(error);
        state.leap_event->before += error;
        state.leap_event->after += error;
        count_by_leap_event(state);
    });
}

// The end of the UTC day, as a count of UTC without leap seconds. @param leap_seconds GPST − UTC, s
GpsTime end_of_utc_day(GpsTime time, int leap_seconds) {
    const auto day = std::chrono::hours(24);
    const Nanoseconds utc = time.time_since_epoch() - std::chrono::seconds(leap_seconds);
    return GpsTime((utc / day + 1) * day);
}

// A leap second of the IERS at the end of the same day is the one that this tells of, not another.
Result<Fault> make_leap_second_event(const Parameters& parameters, const FaultContext&) {
    const int change = parameters.text("change") == "deleted" ? -1 : 1;
    struct Day {
        GpsTime end;  ///< by end_of_utc_day()
        int announced = 0;
    };
    return fault_of<&Fault::report>(
        [change, day = std::optional<Day>()](NavigationState& state, const FaultMoment& moment) mutable {
            const int announced = LeapSeconds::announced().offset(moment.now), believed = state.epoch.fix.leap_seconds;
            if (!day) day = Day{end_of_utc_day(moment.now, believed), announced};
            const int before = believed - (announced - day->announced), after = before + change;
            state.leap_event = firmware::LeapEvent{day->end + std::chrono::seconds(after), before, after};
            count_by_leap_event(state);
        });
}

Result<Fault> make_week_rollover(const Parameters& parameters, const FaultContext&) {
    const auto rollovers = static_cast<std::int64_t>(parameters.number("rollovers"));
    return fault_of<&Fault::report>([back = rollovers * weeks_of_rollover](NavigationState& state, const FaultMoment&) {
        shift_time(state, -std::chrono::seconds(back * seconds_per_week));
    });
}

Result<Fault> make_week_order(const Parameters& parameters, const FaultContext&) {
    return fault_of<&Fault::report>([lag = Seconds(parameters.number("lag_s"))](
                                        NavigationState& state, const FaultMoment&) { state.week_lag = lag; });
}

Result<Fault> make_time_step(const Parameters& parameters, const FaultContext&) {
    return fault_of<&Fault::report>(
        [step = parameters.number("step_s")](NavigationState& state, const FaultMoment& moment) {
            shift_time(state, to_nanoseconds(Seconds(step * moment.strength)));
        });
}

// @param rate s per s of the true time, counted from the first epoch of the fault: what is reported may be wrong by
// other faults
Fault running_off(double rate) {
    return fault_of<&Fault::report>(
        [rate, first = First<GpsTime>()](NavigationState& state, const FaultMoment& moment) mutable {
            const Seconds since = difference(moment.now, first.of(moment.now));
            shift_time(state, to_nanoseconds(since * (rate * moment.strength)));
        });
}

Result<Fault> make_time_backwards(const Parameters& parameters, const FaultContext&) {
    return running_off(-(1 + parameters.number("rate")));
}

Result<Fault> make_time_drift(const Parameters& parameters, const FaultContext&) {
    return running_off(parameters.number("ppm") * 1e-6);
}

Result<Fault> make_date_unknown(const Parameters& parameters, const FaultContext&) {
    return fault_of<&Fault::report>(
        [time_too = parameters.flag("time_too")](NavigationState& state, const FaultMoment&) {
            state.time.date = state.time.leap_seconds = state.time.confirmed = false;
            if (time_too) state.time.time = false;
        });
}

constexpr std::string_view leap_second_changes[] = {"inserted", "deleted"};

constexpr auto calendar_kinds = without_strength(std::to_array<FaultKind>(
    {FaultKind{"leap_second_wrong",
               "The receiver believes a wrong number of leap seconds, and its UTC is off by as much.",
               "A cold start: firmware counts by the number of its making until the satellites have told theirs.",
               {whole_number_parameter("error_s", -2, -30, 30, "too many leap seconds, s"),
                flag_parameter("declared_valid", false, "it says that the number was decoded")},
               make_leap_second_wrong}
         .that_needs(time_report),
     FaultKind{"leap_second_event",
               "A leap second comes at the end of the UTC day; NAV-TIMELS announces it from the start of the fault.",
               "The IERS: the last was at the end of 2016, and clients' code for it is seldom run.",
               {word_parameter("change", "inserted", leap_second_changes, "23:59:60 is counted, or 23:59:59 is not")},
               make_leap_second_event}
         .that_needs(calendar_report),
     FaultKind{"week_rollover",
               "Dates lie 1024 weeks back; the time of week is right. Refused where that leads to before 1980-01-06.",
               "The ten bits of the week number: firmware resolves them about the date of its making.",
               {whole_number_parameter("rollovers", 1, 1, 2, "times 1024 weeks")},
               make_week_rollover}
         .that_needs(time_report),
     FaultKind{
         "week_order",
         "At the end of the week the week number changes after the time of week has begun anew, or before: of each "
         "time scale (GPS, Galileo, BeiDou, UTC) where its own week ends.",
         "Week and time of week come in messages of different rates (ArduPilot #31914).",
         {number_parameter("lag_s", 2, -3600, 3600, "week number after time of week, s; below 0 before")},
         make_week_order}
         .that_needs(week_report)}));

constexpr auto clock_kinds = std::to_array<FaultKind>(
    {FaultKind{
         "time_step",
         "The time jumps by a constant; the solution stays. Before 1980-01-06 there is no time: it stands still there.",
         "False signals that carry another time, or a clock that was set wrong after a restart.",
         {number_parameter("step_s", 3600, -1e9, 1e9, "later than the true time, s")},
         make_time_step}
         .that_needs(time_report),
     FaultKind{"time_backwards",
               "The time runs backwards from the start of the fault on.",
               "Recorded signals that are sent again, and firmware that corrects its clock in the wrong direction.",
               {number_parameter("rate", 1, 0.001, 100, "how fast, s per s")},
               make_time_backwards}
         .that_needs(time_report),
     FaultKind{"time_drift",
               "The time runs away from the true one; epochs keep their rate.",
               "A receiver that has lost its satellites and counts by its crystal, or false signals.",
               {number_parameter("ppm", 1000, -500'000, 500'000, "how much faster, 1e-6")},
               make_time_drift}
         .that_needs(time_report)});

constexpr auto unknown_time_kinds = without_strength(std::to_array<FaultKind>(
    {FaultKind{"date_unknown",
               "Date and week are told to be unknown while there is a fix.",
               "A receiver that has a fix before it has heard the week, as after a hot start without its clock.",
               {flag_parameter("time_too", false, "the time of day and of the week is unknown as well")},
               make_date_unknown}
         .that_needs(time_report)}));

}  // namespace

std::vector<FaultKind> time_fault_kinds() {
    return all_kinds_of(FaultLayer::solution, {calendar_kinds, clock_kinds, unknown_time_kinds});
}

}  // namespace skyloop::inline run
