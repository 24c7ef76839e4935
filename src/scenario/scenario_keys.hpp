/// The keys of each part of a scenario file, and those that board files share.
#pragma once

#include "skyloop/scenario/scenario.hpp"
#include "table_reader.hpp"

namespace skyloop {

void read_model_keys(TableReader& model, ModelSettings& settings);
void read_atmosphere_keys(TableReader& atmosphere, AtmosphereParameters& parameters);

/// Reads the list `constellations` of a scenario's [sky] or a board's [navigation].
void read_constellation_list(TableReader& table, std::vector<Constellation>& constellations);

/// Reads [frame] and [trajectory] of a file's top table.
void read_trajectory_keys(TableReader& top, Scenario& scenario);

}  // namespace skyloop
