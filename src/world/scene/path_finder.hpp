/// Finds the paths of all satellites at one place, epoch after epoch.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/time/gps_time.hpp"
#include "world/scene/scene_path.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop::inline world {

/// What reflects, how far, and how paths are sought.
struct PathSearchSettings {
    int most_reflections = skyloop::most_reflections;  ///< 1 … 16
    bool walls_reflect = true, roofs_reflect = false, ground_reflects = false;
    bool blocked_only = true;  ///< paths of satellites in line of sight are not sought (the article, MODELS.md R-21)
    /// Rays of a search, of the whole hemisphere; 0: as default_rays() says.
    int rays = 0;
    double cache_seconds = 2;   ///< how long a path is remembered that is no longer there
    double tolerance_deg = 10;  ///< of an escaped ray to a satellite
    /// Rays only where walls may lead them to a hidden satellite, by elevation; false: all of the hemisphere.
    bool banded = true;
    int most_hops = 6;
    /// Threads that search beside the caller; 0: the caller itself. The paths are the same.
    int threads = 0;
    /// A search of one epoch serves the next one (a worker has time until then): it is made for where the antenna and
    /// the satellites will be if they go on as they do, and with 2048 rays while the antenna stands still. False: a
    /// search serves the same epoch, at once. So do in either case those of the first two epochs, of the two after a
    /// gap longer than `cache_seconds`, and the one after a jump by more than 50 m.
    bool search_ahead = true;
};

/// Rays for an epoch rate: 65536 up to 10 Hz, 16384 at 25 Hz, between and beyond by the same work per second
/// (CITY.md section 3), never less than 2048.
int default_rays(double epochs_per_second);

/// Counts since the beginning, and of the last epoch.
struct PathSearchCounters {
    std::uint64_t epochs = 0;
    std::uint64_t rays = 0;        ///< of lattices
    std::uint64_t segments = 0;    ///< stretches between reflections that were traced, of lattices and guesses
    std::uint64_t candidates = 0;  ///< guessed sequences that were tried, remembered ones among them
    std::uint64_t accepted = 0;    ///< paths answered
    int rays_last = 0;             ///< of the search that served the last epoch
    int cached_last = 0;           ///< sequences remembered when it began
    int found_last = 0;            ///< sequences that the search added
};

/// Where the antenna is, in the scene's frame.
struct SceneObserver {
    GpsTime now;
    Eigen::Vector3d position;                            ///< m
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
};

/// CITY.md section 2: cached paths first, then a banded lattice of rays, then hops to the fixed point.
///
/// State: remembered paths, the turn of the lattice, a running search. Deterministic: the same calls give the same
/// paths, whatever the number of threads and their timing.
class PathFinder {
public:
    PathFinder(std::shared_ptr<const UrbanScene> scene, const PathSearchSettings& settings);
    ~PathFinder();
    PathFinder(PathFinder&&) noexcept;
    PathFinder& operator=(PathFinder&&) noexcept;

    /// A satellite, or an antenna, whose position is no number is not in sight and has no paths.
    ///
    /// @param satellites each once
    /// @returns one for each satellite, in their order
    std::vector<SatellitePaths> epoch(const SceneObserver& observer, std::span<const SceneSatellite> satellites);

    [[nodiscard]] const UrbanScene& scene() const;
    [[nodiscard]] const PathSearchCounters& counters() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace skyloop::inline world
