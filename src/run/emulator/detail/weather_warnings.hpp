/// What of [atmosphere] cannot act in a run.
#pragma once

#include <string>
#include <vector>

#include "base/geo/geoid.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop {

/// A sentence for the keys that the scenario's model does not take, and one for each rain or cloud that lies below an
/// antenna that stays where it is. @param geoid null: the ellipsoid stands in for the sea
std::vector<std::string> weather_warnings(const Scenario& scenario, const Geoid* geoid);

}  // namespace skyloop
