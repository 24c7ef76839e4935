/// What the ways to look at the sky share: satellites at a place, maps over an area, a recorded run.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "messages.hpp"
#include "run/emulator/assembly.hpp"
#include "run_options.hpp"

namespace skyloop::host {

/// What was typed after `skyloop sky`.
struct SkyOptions {
    RunOptions run;
    std::string format = "text";
    double tracks_h = 0;
    double step = 0;           ///< --tracks: s; --grid: m; 0: not given
    bool all_paths = false;    ///< of satellites in line of sight too, off roofs and ground too
    std::string view = "sky";  ///< of the svg: sky or plan
    std::string grid;          ///< WEST,SOUTH,EAST,NORTH
    int grid_size = 0;         ///< cells along the longer side; 0: not given
    double duration = 0;       ///< that a map spans, s
    double interval_s = 60;    ///< between epochs of a map
    double height_m = 1.5;     ///< of a map's antennas above the ground
    int threads = 0;           ///< 0: as many as the machine has
    std::string show = "los";  ///< what a map's svg shows
    bool direct_only = false;  ///< a map without reflections
    std::string run_folder;    ///< a recorded run to draw
};

/// The world of a scenario, without a receiver.
struct World {
    std::unique_ptr<Geoid> geoid;
    Simulation simulation;
    GpsTime start;
    std::shared_ptr<const UrbanScene> scene;  ///< null: nothing stands around
};

/// Reads navigation data and buildings, and tells of what is doubtful about them. A place on the command line that has
/// no height is one `antenna_above_scene` over the ground of the buildings.
Result<World> make_world(const Scenario& scenario, const SkyOptions& options, const Messages& messages);

/// Prints a map over an area and a span of time. @returns the exit code
int show_coverage(const SkyOptions& options, Scenario scenario, const Messages& messages);

/// Prints a picture of a recorded run. @returns the exit code
int show_city_run(const SkyOptions& options, const Scenario& scenario, const Messages& messages);

}  // namespace skyloop::host
