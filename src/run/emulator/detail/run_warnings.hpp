/// What of [atmosphere] cannot act in a run.
/// Paths on which a receiver will tell no fix.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/geo/geoid.hpp"
#include "run/emulator/assembly.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop::inline run {

/// A sentence for the keys that the scenario's model does not take, one for each rain or cloud that lies below an
/// antenna that stays where it is, and one for layers of the air that overlap. @param geoid null: the ellipsoid stands
/// in for the sea
std::vector<std::string> weather_warnings(const Scenario& scenario, const Geoid* geoid);

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
