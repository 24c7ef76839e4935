/// Maps of the ionosphere for a run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/core/result.hpp"
#include "run/scenario/scenario.hpp"
#include "world/propagation/named_ionosphere_maps.hpp"

namespace skyloop {

/// The IONEX file that a run's delays come from; empty: none.
std::filesystem::path acting_ionosphere_maps(const Scenario& scenario);

/// Those of an IONEX file; nothing where none is named.
Result<std::optional<NamedIonosphereMaps>> load_ionosphere_maps(const std::filesystem::path& file);

/// The span for which maps must be there; of a run without an end its start.
TimeSpan span_of_tables(const Scenario& scenario, GpsTime start);

/// Of a run without an end: until when the maps of its ionosphere reach, of which the last then holds on. Nothing where
/// the run has an end or no maps act.
std::optional<std::string> warning_of_last_map(const Scenario& scenario);

}  // namespace skyloop
