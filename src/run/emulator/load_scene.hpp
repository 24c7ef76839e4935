/// The buildings of a scenario, from their files to what rays are traced in.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "run/scenario/scenario.hpp"
#include "world/city/city_cache.hpp"
#include "world/propagation/ray_traced_scene.hpp"

namespace skyloop::inline run {

/// Above the frame of a scene that has no origin stands the antenna at the start of the trajectory, as a pedestrian's.
inline constexpr Metres antenna_above_scene{1.5};

/// The place `antenna_above_scene` below another.
inline Geodetic below_antenna(Geodetic place) {
    place.height.above_ellipsoid = place.height.above_ellipsoid - antenna_above_scene;
    return place;
}

/// Where the antenna of a run starts whose scene has no origin: that of the scenario's own vehicle, or, where nobody
/// rides on it, of the first receiver's. Nothing for a live vehicle without `at`, which starts where its source says.
/// @param start of the run; trajectories of files have been loaded by load_track()
std::optional<Geodetic> scene_start(const Scenario& scenario, GpsTime start);

/// All files of a scene in one frame.
struct JoinedCity {
    CityModel model;
    std::vector<std::string> names;    ///< of the files, without their folders
    std::vector<std::string> formats;  ///< of each
    std::size_t buildings = 0;         ///< where formats tell them apart
    std::size_t dropped = 0;           ///< facets and footprints that could not be used
    std::uint64_t digest = 0;          ///< of the bytes of all files
    bool from_cache = false;           ///< of one at least
    std::vector<std::string> warnings;
};

/// Reads the files of a scene and joins them. Fails as read_city() and parse_height_grid() do.
/// @param start where the trajectory starts; a scene without an origin lies antenna_above_scene below it, and without
/// either where its first file says
/// @param geoid of files whose heights count from the sea; may be absent
Result<JoinedCity> read_scene_files(const SceneEntry& entry, const std::optional<Geodetic>& start,
                                    const CityCache& cache, const Geoid* geoid = nullptr);

/// Of files read without an origin and a start: the first one is the demo, or its coordinates say nothing of the Earth.
bool lies_nowhere(const JoinedCity& city);

/// A scene that receivers share; without one nothing stands around.
struct LoadedScene {
    std::shared_ptr<const UrbanScene> scene;
    std::string description;  ///< "munich.tar.gz, 38938 triangles, 12104 planes, 15 MB"
    std::uint64_t digest = 0;
    bool from_cache = false;  ///< of one file at least
    std::vector<std::string> warnings;
};

/// Reads the scene of a scenario and makes it ready for rays. Fails with `input` when it would take more memory than
/// allowed or nothing is in it, with `usage` when neither its files nor its origin nor a start tell where it lies, and
/// as read_scene_files().
/// @param start scene_start()
Result<LoadedScene> load_scene(const Scenario& scenario, const std::optional<Geodetic>& start, const CityCache& cache,
                               const Geoid* geoid = nullptr);

/// What to say of an antenna that starts more than 20 m below all of a scene, or 300 m above it: mostly its heights
/// count from somewhere else. Nothing where it stands farther than 2 km aside.
std::optional<std::string> doubt_of_height(const UrbanScene& scene, const Geodetic& start);

/// "munich.tar.gz, 38938 triangles, 12104 planes, 15 MB".
std::string scene_description(const std::vector<std::string>& names, const UrbanScene& scene);

/// What the scene does to the signals in the scenario's model.
RayTracedSceneSettings scene_effect_settings(const Scenario& scenario, double epochs_per_second);

}  // namespace skyloop::inline run
