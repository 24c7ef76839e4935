/// A recorded run as someone sees it who looks down at the city: where, and what arrived there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "base/time/utc_time.hpp"
#include "world/flow/arrivals.hpp"

namespace skyloop::inline study {

/// One epoch of a run.
struct CityRunEpoch {
    Seconds since_start;
    Geodetic truth;                                      ///< where the antenna was
    std::optional<Metres> error;                         ///< horizontal; nothing without a fix
    std::array<int, reception_names.size()> received{};  ///< satellites above the lowest elevation, by Reception
};

/// A run, in the order of its epochs.
struct CityRun {
    std::string start;  ///< UTC, as its file writes it
    Angle lowest;       ///< elevation from which satellites are counted
    std::vector<CityRunEpoch> epochs;
};

/// Reads what `simulate --out` or `run --record` left in `folder`: fixes.csv and satellites.csv, each also as .gz.
/// Satellites below `lowest` are not counted. Fails with file and line.
Result<CityRun> read_city_run(const std::filesystem::path& folder, Angle lowest = Angle::degrees(5));

/// The same from text; `name` stands for the folder in messages.
Result<CityRun> parse_city_run(std::string_view fixes, std::string_view satellites, const std::string& name,
                               Angle lowest = Angle::degrees(5));

}  // namespace skyloop::inline study
