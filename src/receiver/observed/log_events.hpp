/// What went wrong in a log, as far as its epochs show it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "receiver/observed/observed_log.hpp"

namespace skyloop::inline receiver {

/// From which size on something counts.
struct EventLimits {
    double drop_db = 6;                    ///< of C/N0, the median of all satellites against their own level
    double satellite_drop_db = 10;         ///< of one satellite, beyond that of all
    Seconds least{3};                      ///< how long a drop lasts
    Seconds satellite_least{5};            ///< how long one satellite is weak or away
    int elevation_deg = 10;                ///< of single satellites: lower ones come and go by themselves
    Seconds window{300};                   ///< before and after, over which a satellite's own level is the median
    Seconds reacquisition{1};              ///< from the return of the signals until a receiver shows it
    std::size_t most_of_satellites = 200;  ///< events of single satellites that are kept
    std::size_t most_of_types = 500;       ///< changes of the type that are kept
};

enum class LogEventKind { signals_lost, silent, fix_type, drop, satellite_drop, satellite_lost };

/// One event; times count from the first epoch, which an event begins with and another one ends it.
struct LogEvent {
    LogEventKind kind = LogEventKind::signals_lost;
    Nanoseconds at{0}, lasts{0};
    FixType type = FixType::none;            ///< fix_type
    double drop_db = 0;                      ///< drop, satellite_drop
    std::optional<SatelliteId> satellite{};  ///< satellite_drop, satellite_lost
    std::string seen;                        ///< what the log shows, a sentence
};

struct LogEvents {
    Nanoseconds period{0};         ///< of the epochs: the median
    std::vector<LogEvent> events;  ///< ascending in time
    std::vector<std::string> notes;
};

/// Finds them. @param log one epoch or more
LogEvents find_events(const ObservedLog& log, const EventLimits& limits);

/// The files of a scenario that is like the log.
struct LogScenario {
    std::string scenario;  ///< scenario.toml
    std::string track;     ///< track.csv; empty: the log has one place, at which the scenario stands
    std::size_t places = 0;
};
/// Fails with `input` for a log without any place.
Result<LogScenario> scenario_of_log(const ObservedLog& log, const LogEvents& events);

}  // namespace skyloop::inline receiver
