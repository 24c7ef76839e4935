/// Scenario files: TOML in, Scenario out.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "run/scenario/scenario.hpp"
#include "run/scenario/scenario_changes.hpp"

namespace skyloop {

/// Reads a scenario (INTERFACE.md section 2; every key in docs/scenario.md).
/// @param text TOML
/// @param file its name, for messages; paths in the text are relative to its folder
/// Fails with `input`, or with `outside` where the only mistakes are tables of antennas that cannot be read: one line
/// per mistake, `FILE:LINE:COLUMN: what was found; what was expected`.
Result<Scenario> read_scenario(std::string_view text, const std::filesystem::path& file);
Result<Scenario> read_scenario_file(const std::filesystem::path& file);

/// Reads the [trajectory] (and [frame]) of a file that holds nothing else, as `--trajectory FILE.toml` names it.
/// @param warnings what a reader should be told of it is added here
/// @param changes of its keys
Result<TrajectorySettings> read_trajectory_file(const std::filesystem::path& file, std::vector<std::string>& warnings,
                                                std::span<const ScenarioChange> changes = {});

}  // namespace skyloop
