// The parts of [trajectory]: one function for each group of kinds.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenario_keys.hpp"

namespace skyloop {

// Reads places that may be given on the Earth or in the coordinates of a game level.
class PlaceReader {
public:
    PlaceReader(const std::optional<LevelFrame>& level, std::vector<std::string>& warnings)
        : level_(level), warnings_(warnings) {}

    // `key` = [lat, lon, height], or `key`_level = [x, y, z].
    std::optional<Geodetic> read(TableReader& table, const std::string& key);

private:
    void warn_beyond_reach(const Position<Level>& point);

    const std::optional<LevelFrame>& level_;
    std::vector<std::string>& warnings_;
};

// heading_deg: of the vehicle until it moves.
Angle read_heading(TableReader& table);

void read_fixed(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory);
void read_waypoints(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory);
void read_circle(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory);
void read_live(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory);
void read_file_track(TableReader& table, const std::filesystem::path& folder, TrajectorySettings& trajectory);

}  // namespace skyloop
