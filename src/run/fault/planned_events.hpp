/// What is known of a timeline before the run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "run/fault/timeline.hpp"

namespace skyloop {

/// When a run begins and ends, and what its times are drawn by.
struct TimelineSpan {
    GpsTime start{}, end{};
    std::uint64_t seed = 1;
};

/// What begins and ends by the end of the run, in the order of time, where no trigger acts and nobody steers; the
/// commands that start and stop faults are obeyed. @param most events; what comes after as many is left out
std::vector<TimelineEvent> planned_events(const std::vector<TimelineEntry>& entries, const TimelineSpan& run,
                                          std::size_t most);
/// For each entry: whether its events depend on what the run will bring, through triggers, what it comes after or the
/// commands that start or stop it.
std::vector<bool> hang_on_the_run(const std::vector<TimelineEntry>& entries);
/// Lines for people: what is known of each entry before the run, in the order of time.
std::vector<std::string> timeline_text(const std::vector<TimelineEntry>& entries, const TimelineSpan& run);

}  // namespace skyloop
