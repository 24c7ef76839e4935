#include "run/emulator/load_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/core/bytes.hpp"
#include "base/geo/local_frame.hpp"
#include "run/emulator/assembly.hpp"
#include "world/scene/generated_city.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::string_view terrain_material = "medium-ground";

// Adds a city to another one; coordinates change when their frames differ.
void join_city(CityModel& whole, const CityModel& part) {
    const LocalFrame from(part.origin), to(whole.origin);
    const bool same = part.origin.latitude == whole.origin.latitude &&
                      part.origin.longitude == whole.origin.longitude && part.origin.height == whole.origin.height;
    const auto moved = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
        return same ? v : to.to_enu(from.to_ecef(Position<Enu>(v.x(), v.y(), v.z()))).vector();
    };
    const auto first = static_cast<std::uint32_t>(whole.vertices.size());
    for (const Eigen::Vector3d& vertex : part.vertices)
        whole.vertices.push_back(moved(vertex));
    std::vector<std::uint8_t> materials;
    for (const std::string& name : part.materials)
        materials.push_back(whole.material_index(name));
    for (CityTriangle triangle : part.triangles) {
        for (std::uint32_t& corner : triangle.corners)
            corner += first;
        triangle.material = materials.at(triangle.material);
        whole.triangles.push_back(triangle);
    }
    for (FoliageVolume trees : part.foliage) {
        const double shift = moved({0, 0, trees.base}).z() - trees.base;
        for (Eigen::Vector2d& corner : trees.ring)
            corner = moved({corner.x(), corner.y(), trees.base}).head<2>();
        trees.base += shift;
        trees.top += shift;
        if (trees.ground) *trees.ground += shift;
        whole.foliage.push_back(std::move(trees));
    }
    for (GroundedBuilding building : part.grounded) {
        const Eigen::Vector3d& corner = part.vertices.at(building.first);
        building.ground = moved({corner.x(), corner.y(), building.ground}).z();
        building.first += first;
        whole.grounded.push_back(building);
    }
}

void add_part(JoinedCity& city, const std::filesystem::path& path, CityFile part, std::uint64_t digest) {
    const bool first = city.names.empty();
    city.names.push_back(path.has_filename() ? path.filename().string() : path.parent_path().filename().string());
    city.formats.push_back(part.format);
    city.buildings += part.buildings;
    city.dropped += part.dropped;
    city.warnings.insert(city.warnings.end(), part.warnings.begin(), part.warnings.end());
    city.digest = fnv1a_64(fmt::format("{:016x}", digest), city.digest);
    if (first)
        city.model = std::move(part.model);
    else
        join_city(city.model, part.model);
}

Result<CityReading> read_terrain(const std::filesystem::path& path, const CityFileSettings& reading,
                                 const CityCache& cache) {
    // Units and axes are those of the buildings; a grid has its own.
    CityFileSettings settings;
    settings.origin = reading.origin;
    settings.origin_is_guess = reading.origin_is_guess;
    settings.anchor = reading.anchor;
    settings.file_crs = reading.file_crs;
    settings.heights = reading.heights;
    settings.geoid = reading.geoid;
    settings.material = terrain_material;
    settings.most_triangles = reading.most_triangles;
    settings.memory_limit = reading.memory_limit;
    auto grid = read_city(path, settings, cache);
    if (grid && grid->file.format != "height grid")
        return fail(ErrorCode::input, fmt::format("{}: is of format {}; expected terrain as a height grid (.asc, .tif)",
                                                  path.string(), grid->file.format));
    return grid;
}

// What counts its heights from the ground stands on the terrain.
Result<void> put_on_terrain(JoinedCity& city, const CityModel& terrain, const std::filesystem::path& path) {
    const auto counts = [](const FoliageVolume& trees) { return trees.ground.has_value(); };
    if (city.model.grounded.empty() && std::ranges::none_of(city.model.foliage, counts)) return {};
    CityModel ground;
    ground.origin = city.model.origin;
    join_city(ground, terrain);
    const auto scene = UrbanScene::build(ground);
    if (!scene) return fail(scene.error().code, fmt::format("{}: {}", path.string(), scene.error().message));
    if (const std::size_t beyond = stand_on_terrain(city.model, **scene); beyond > 0)
        city.warnings.push_back(
            fmt::format("{} buildings and woods stand beyond {}: they stay at the height of the "
                        "frame's origin",
                        beyond, path.filename().string()));
    return {};
}

// Metres between a place and the box around a scene, over ground; 0 within.
double distance_to_scene(const Geodetic& place, const UrbanScene& scene) {
    const Eigen::Vector3d at = scene.frame().to_enu(to_ecef(place)).vector();
    const SceneStatistics& box = scene.statistics();
    const Eigen::Vector3d away = (box.lowest - at).cwiseMax(at - box.highest).cwiseMax(0);
    return away.head<2>().norm();
}

constexpr double far_m = 2000;

void warn_of_scene(const UrbanScene& scene, const std::optional<Geodetic>& start, std::vector<std::string>& warnings) {
    const SceneStatistics& s = scene.statistics();
    if (s.not_finite > 0)
        warnings.push_back(
            fmt::format("scene: {} triangles have a corner that is no number; they are left out", s.not_finite));
    if (!start) return;
    if (const double distance = distance_to_scene(*start, scene); distance > far_m)
        warnings.push_back(fmt::format(
            "scene: the antenna starts {:.1f} km away from the scene, whose origin is {:.6f}, {:.6f}; is it the right "
            "place? scene.origin sets that of the scene, the trajectory that of the antenna",
            distance / 1000, scene.frame().origin().latitude.deg(), scene.frame().origin().longitude.deg()));
}

enum class OpenPlace { nothing, place, ground };

// What a file of a scene without an origin leaves to be guessed by the start of the run.
OpenPlace left_open_by(const SceneEntry& entry, std::string_view format) {
    constexpr std::array<std::string_view, 4> local{"obj", "ply", "gltf", "mitsuba"};
    constexpr std::array<std::string_view, 3> outlines{"osm", "osm.pbf", "geojson"};
    const std::string& crs = entry.reading.file_crs;
    if (std::ranges::count(local, format) > 0)
        return crs.empty() || crs == "local" ? OpenPlace::place : OpenPlace::nothing;
    return std::ranges::count(outlines, format) > 0 && entry.terrain.empty() ? OpenPlace::ground : OpenPlace::nothing;
}

void warn_of_guessed_origin(const SceneEntry& entry, const JoinedCity& city, std::vector<std::string>& warnings) {
    if (entry.reading.origin) return;
    for (std::size_t i = 0; i < city.names.size(); ++i) {
        const OpenPlace left_open = left_open_by(entry, city.formats[i]);
        if (left_open == OpenPlace::place)
            warnings.push_back(
                fmt::format("scene: {} does not say where it lies; its origin is taken to be {} m below the start of "
                            "the trajectory; scene.origin tells another",
                            city.names[i], antenna_above_scene.value()));
        else if (left_open == OpenPlace::ground)
            warnings.push_back(fmt::format(
                "scene: {} does not say how high its ground lies; it is taken to be {} m below the start of "
                "the trajectory; scene.origin tells another, and scene.terrain its shape",
                city.names[i], antenna_above_scene.value()));
    }
}

// Where no start is known there is nothing to guess by.
Result<void> check_places(const SceneEntry& entry, const JoinedCity& city) {
    for (std::size_t i = 0; i < city.names.size(); ++i) {
        const OpenPlace left_open =
            i == 0 && lies_nowhere(city) ? OpenPlace::place : left_open_by(entry, city.formats[i]);
        if (left_open == OpenPlace::nothing) continue;
        return fail(ErrorCode::usage,
                    fmt::format("{}is missing; {} does not say {}, and a live trajectory without at starts where its "
                                "source says; expected [latitude, longitude, height]",
                                entry.origin_told_at, city.names[i],
                                left_open == OpenPlace::ground ? "how high its ground lies" : "where it lies"));
    }
    return {};
}

// Of the opposite hand, by the antenna of the preset: a telephone's is polarised linearly and hears both alike.
Decibels hand_rejection(ModernPreset preset) {
    return Decibels(preset == ModernPreset::survey ? 20 : preset == ModernPreset::phone ? 0 : 10);
}

}  // namespace

std::optional<Geodetic> scene_start(const Scenario& scenario, GpsTime start) {
    const bool ridden = std::ranges::any_of(scenario.receivers, [](const ReceiverEntry& r) { return !r.trajectory; });
    const TrajectorySettings& way = ridden ? scenario.trajectory : trajectory_of(scenario, 0);
    if (const auto* live = std::get_if<LiveSettings>(&way); live != nullptr && !live->at) return std::nullopt;
    return make_trajectory(way, start)->at(start).geodetic;
}

bool lies_nowhere(const JoinedCity& city) {
    const Geodetic &origin = city.model.origin, nowhere{};
    return city.formats.front() == demo_scene_name ||
           (origin.latitude == nowhere.latitude && origin.longitude == nowhere.longitude);
}

Result<JoinedCity> read_scene_files(const SceneEntry& entry, const std::optional<Geodetic>& start,
                                    const CityCache& cache, const Geoid* geoid) {
    CityFileSettings reading = entry.reading;
    reading.geoid = geoid;
    reading.memory_limit = entry.memory_limit_mb << 20;
    reading.origin_is_guess = !reading.origin;
    if (!reading.origin && start) reading.origin = below_antenna(*start);
    const CityCache kept = entry.cache ? cache : CityCache{};
    JoinedCity city;
    for (const std::filesystem::path& path : entry.buildings) {
        if (path == demo_scene_name) {
            CityFile demo;
            demo.model = demo_city(reading.origin.value_or(below_antenna(FixedSettings().at)));
            demo.format = demo_scene_name;
            add_part(city, path, std::move(demo), 0);
        } else {
            auto read = read_city(path, reading, kept);
            if (!read) return fail(read.error());
            city.from_cache = city.from_cache || read->from_cache;
            const std::optional<MapAnchor>& anchor = read->file.anchor;
            if (anchor && (!reading.anchor || reading.anchor->system == anchor->system)) reading.anchor = anchor;
            add_part(city, path, std::move(read->file), read->digest);
        }
        // What follows lies in the frame of the first file.
        if (!reading.origin) reading.origin = city.model.origin;
    }
    if (!entry.terrain.empty()) {
        auto terrain = read_terrain(entry.terrain, reading, kept);
        if (!terrain) return fail(terrain.error());
        if (const auto put = put_on_terrain(city, terrain->file.model, entry.terrain); !put) return fail(put.error());
        add_part(city, entry.terrain, std::move(terrain->file), terrain->digest);
    }
    return city;
}

std::optional<std::string> doubt_of_height(const UrbanScene& scene, const Geodetic& start) {
    constexpr double far_below_m = 20, far_above_m = 300;
    if (distance_to_scene(start, scene) > far_m) return std::nullopt;
    const SceneStatistics& s = scene.statistics();
    const double up = scene.frame().to_enu(to_ecef(start)).vector().z();
    const bool below = up < s.lowest.z() - far_below_m;
    if (!below && up <= s.highest.z() + far_above_m) return std::nullopt;
    return fmt::format(
        "scene: the antenna starts {:.0f} m {} point of the scene; are the heights of both above the ellipsoid?",
        below ? s.lowest.z() - up : up - s.highest.z(), below ? "below the lowest" : "above the highest");
}

std::string scene_description(const std::vector<std::string>& names, const UrbanScene& scene) {
    const SceneStatistics& s = scene.statistics();
    return fmt::format("{}, {} triangles, {} planes, {:.1f} MB", fmt::join(names, " + "), s.triangles, s.planes,
                       static_cast<double>(s.memory) * 1e-6);
}

Result<LoadedScene> load_scene(const Scenario& scenario, const std::optional<Geodetic>& start, const CityCache& cache,
                               const Geoid* geoid) {
    LoadedScene loaded;
    if (!scenario.scene.given()) return loaded;
    auto city = read_scene_files(scenario.scene, start, cache, geoid);
    if (!city) return fail(city.error());
    if (!scenario.scene.reading.origin && !start)
        if (const auto placed = check_places(scenario.scene, *city); !placed) return fail(placed.error());
    const SceneSettings settings{SceneSettings().merge_tolerance, scenario.scene.memory_limit_mb << 20};
    auto scene = UrbanScene::build(city->model, settings);
    if (!scene) return fail(scene.error().code, fmt::format("scene: {}", scene.error().message));
    loaded.scene = std::move(*scene);
    loaded.digest = city->digest;
    loaded.description = scene_description(city->names, *loaded.scene);
    loaded.from_cache = city->from_cache;
    loaded.warnings = std::move(city->warnings);
    warn_of_guessed_origin(scenario.scene, *city, loaded.warnings);
    warn_of_scene(*loaded.scene, start, loaded.warnings);
    return loaded;
}

RayTracedSceneSettings scene_effect_settings(const Scenario& scenario, double epochs_per_second) {
    const bool modern = !scenario.model.sensor_model;
    const SceneEntry& entry = scenario.scene;
    RayTracedSceneSettings settings;
    settings.profile = modern ? SceneProfile::modern : SceneProfile::baseline;
    settings.search.most_reflections = entry.reflections.value_or(modern ? 3 : most_reflections);
    settings.search.roofs_reflect = entry.roofs_reflect;
    settings.search.ground_reflects = entry.ground_reflects.value_or(modern);
    settings.search.rays = entry.rays;
    settings.search.threads = entry.threads.value_or(1);
    settings.epochs_per_second = epochs_per_second;
    settings.diffraction = entry.diffraction;
    if (!modern) return settings;
    settings.scattering.coefficient = entry.scattering;
    settings.scattering.seed = scenario.run.seed_of_sky();
    const ModernPropagationParameters& propagation = scenario.model.modern.propagation;
    settings.crowns = {propagation.loss_model.canopy_db_per_m, propagation.loss_model.most_foliage,
                       entry.foliage ? propagation.foliage.factor() : 0};
    // As ModernLinkBudget scales it for the direct ray: one antenna hears them all.
    settings.antenna = propagation.link.antenna.scaled(propagation.antenna.factor());
    settings.opposite_hand_rejection = hand_rejection(scenario.model.modern.preset);
    return settings;
}

}  // namespace skyloop::inline run
