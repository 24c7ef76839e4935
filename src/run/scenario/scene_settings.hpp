/// The buildings around a run, as a scenario sets them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "world/city/city_file.hpp"

namespace skyloop {

/// In place of a file: demo_city().
inline constexpr const char* demo_scene_name = "demo";

/// [scene]: which files stand around the antenna, how they are read, and what their surfaces do.
struct SceneEntry {
    std::vector<std::filesystem::path> buildings;  ///< files, or demo_scene_name; joined into one frame
    std::filesystem::path terrain;                 ///< height grid; empty: none
    /// Without an origin the frame lies antenna_above_scene below scene_start() (emulator/load_scene.hpp).
    CityFileSettings reading;
    std::string origin_told_at = "scene.origin: ";  ///< "FILE:LINE:COLUMN: KEY: ", for messages

    std::optional<int> reflections;       ///< most of one path, 1 … 16; nothing: 16, in the modern model 3
    bool roofs_reflect = false;           ///< besides walls
    std::optional<bool> ground_reflects;  ///< nothing: in the modern model alone
    bool diffraction = true;              ///< modern: at edges
    bool foliage = true;                  ///< modern: the scene's own trees
    int rays = 0;                         ///< of a search, of the whole hemisphere; 0: by the epoch rate
    std::optional<int> threads;           ///< of each receiver, that search beside the loop; nothing: 1, of led runs 0
    std::size_t memory_limit_mb = 4096;   ///< of the scene; 0: none
    bool cache = true;                    ///< of cities that take time to read

    /// False: nothing stands around, the default.
    [[nodiscard]] bool given() const { return !buildings.empty() || !terrain.empty(); }
};

}  // namespace skyloop
