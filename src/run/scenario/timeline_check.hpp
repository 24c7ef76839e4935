/// What of a scenario's timeline can never happen, once start, end and model of the run are known.
#pragma once

#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop::inline run {

/// Refuses with `input` what cannot happen: faults of measurements under a sensor model, which measures nothing; times
/// before the start of the run.
Result<void> check_timeline(const Scenario& scenario, GpsTime start);

/// Entries whose time is behind the end of the run; and expectations that the end leaves undecided or unmet, whatever
/// the run brings: of times behind it, and of events that do not come before.
std::vector<std::string> timeline_warnings(const Scenario& scenario, GpsTime start, GpsTime end);

}  // namespace skyloop::inline run
