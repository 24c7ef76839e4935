/// What of [atmosphere] cannot act in a run.
/// Faults and commands of a scenario of which nothing will be seen.
/// Paths on which a receiver will tell no fix.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/geo/geoid.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/station.hpp"
#include "run/scenario/scenario.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline run {

/// A sentence for the keys that the scenario's model does not take, and one for each rain or cloud that lies below an
/// antenna that stays where it is. @param geoid null: the ellipsoid stands in for the sea
std::vector<std::string> weather_warnings(const Scenario& scenario, const Geoid* geoid);

/// What a fault is for and the run does not have: satellites and signals that no receiver tracks as it starts, a pair
/// of antennas, an ionosphere, echoes, a clock. One sentence for each such fault.
/// So are commands of live runs. @param virtual_time the run has no clock beside it
std::vector<std::string> idle_fault_warnings(const Scenario& scenario, const NavigationSource& navigation,
                                             std::span<const Station> stations, bool virtual_time);

/// A receiver of a scenario on its path, from the start of the run to its end; nothing: for ever.
struct PathUnderLimits {
    const Scenario& scenario;
    std::size_t receiver = 0;
    const firmware::BoardProfile& board;
    DynamicModel dynamic_model;
    GpsTime start;
    std::optional<GpsTime> end;
    const Geoid* geoid = nullptr;
};

/// One sentence where the path leads beyond the height and the speed at which the receiver tells a fix: looked at once
/// a second, more seldom in runs of more than an hour, of endless ones in their first hour. What leads a live path is
/// not known.
std::optional<std::string> limit_warning(const PathUnderLimits& path);

}  // namespace skyloop::inline run
