/// What a scenario asks of its receivers and their boards cannot do.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "run/emulator/assembly.hpp"
#include "run/fault/receiver_needs.hpp"
#include "run/scenario/scenario.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline run {

/// A scenario with its receivers as the run begins with them, in its order.
struct PlannedRun {
    const Scenario& scenario;
    const NavigationSource& navigation;
    std::span<const UsedReceiver> receivers;
    const RunMode& mode;
};

/// Keys of [[receiver]] of which, or of some of whose values, nothing comes: a sentence each, with the key's place.
std::vector<std::string> idle_key_warnings(const PlannedRun& run);
/// Expectations that no receiver of theirs can fulfil, or miss: likewise.
std::vector<std::string> idle_expectation_warnings(const PlannedRun& run);

/// Faults and commands of which nothing will be seen, and values of their parameters.
struct IdleEntries {
    std::vector<std::string> warnings{};
    std::vector<std::string> refused{};  ///< faults of a run with expectations, without allow_idle
};
/// By the boards, and by what the run does not have: satellites and signals that no receiver tracks as it starts, a
/// pair of antennas, an ionosphere, echoes, a clock. What only the clock lacks is not refused in a run that is only
/// checked.
IdleEntries idle_entries(const PlannedRun& run);

}  // namespace skyloop::inline run
