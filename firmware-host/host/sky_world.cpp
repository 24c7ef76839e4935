#include <fmt/format.h>

#include <algorithm>

#include "data_folders.hpp"
#include "run/emulator/load_scene.hpp"
#include "run/emulator/load_track.hpp"
#include "run_session.hpp"
#include "sky_parts.hpp"
#include "study/analysis/city_run.hpp"
#include "study/plot/city_run_plot.hpp"

namespace skyloop::host {
namespace {

// --at LAT,LON names a place on a street: its height is that of the ground there, or of the foot of the buildings.
void stand_on_ground(Scenario& scenario, const UrbanScene& scene, const std::string& at) {
    auto* fixed = std::get_if<FixedSettings>(&scenario.trajectory);
    if (!fixed || at.empty() || std::count(at.begin(), at.end(), ',') > 1) return;
    Eigen::Vector3d place = scene.frame().to_enu(to_ecef(fixed->at)).vector();
    place.z() = scene.foot_at(place.x(), place.y()) + antenna_above_scene.value();
    fixed->at.height = to_geodetic(scene.frame().to_ecef(Position<Enu>(place))).height;
}

// Where buildings without an origin stood in the run: by its scenario, as they did then; where that does not tell, as
// with a live trajectory, at the run's first epoch.
Result<Geodetic> scene_start_of(const CityRun& run, Scenario scenario, const Geoid* geoid) {
    const auto time = parse_utc(run.start);
    if (!time) return fail(time.error());
    const GpsTime start = to_gps_time(*time, LeapSeconds::announced());
    if (const auto track = load_track(scenario, geoid, start); !track) return fail(track.error());
    return scene_start(scenario, start).value_or(run.epochs.front().truth);
}

}  // namespace

Result<World> make_world(const Scenario& asked, const SkyOptions& options, const Messages& messages) {
    Scenario scenario = asked;
    auto navigation = load_navigation(scenario, wall_clock(), data_folders());
    if (!navigation) return fail(navigation.error());
    auto geoid = find_geoid(data_folders(), navigation->warnings);
    std::vector<std::string> warnings = scenario_warnings(scenario, geoid.get());
    warnings.insert(warnings.end(), navigation->warnings.begin(), navigation->warnings.end());
    const GpsTime start = navigation->start;
    const auto track = load_track(scenario, geoid.get(), start);
    if (!track) return fail(track.error());
    warnings.insert(warnings.end(), track->warnings.begin(), track->warnings.end());
    auto loaded = load_scene(scenario, scene_start(scenario, start), CityCache{data_folders().cache}, geoid.get());
    if (!loaded) return fail(loaded.error());
    warnings.insert(warnings.end(), loaded->warnings.begin(), loaded->warnings.end());
    if (loaded->scene) {
        stand_on_ground(scenario, *loaded->scene, options.run.at);
        // The antennas of a map stand on the ground, wherever the trajectory starts.
        const bool map = !options.grid.empty();
        if (const auto place = scene_start(scenario, start); place && !map)
            if (auto doubt = doubt_of_height(*loaded->scene, *place)) warnings.push_back(std::move(*doubt));
    }
    for (const std::string& warning : warnings)
        messages.warning(warning);
    auto simulation = make_simulation(
        scenario, {std::move(navigation->source), geoid.get(), start, data_folders(), 0, loaded->scene});
    if (!simulation) return fail(simulation.error());
    return World{std::move(geoid), std::move(*simulation), start, loaded->scene};
}

int show_city_run(const SkyOptions& options, const Scenario& scenario, const Messages& messages) {
    if (options.format != "svg") return messages.error({ErrorCode::usage, "--run comes as --format svg"});
    const Angle mask = scenario.sky.elevation_mask.value_or(Angle::degrees(5));
    const auto run = read_city_run(options.run_folder, mask);
    if (!run) return messages.error(run.error());
    std::vector<std::string> unknown_geoid;  // is told by the scene where it matters
    const auto geoid = find_geoid(data_folders(), unknown_geoid);
    const auto started = scene_start_of(*run, scenario, geoid.get());
    if (!started) return messages.error(started.error());
    const auto loaded = load_scene(scenario, *started, CityCache{data_folders().cache}, geoid.get());
    if (!loaded) return messages.error(loaded.error());
    for (const std::string& warning : loaded->warnings)
        messages.warning(warning);
    fmt::print("{}", city_run_plot_svg(*run, loaded->scene.get(), loaded->scene ? "A run through the city" : "A run"));
    return 0;
}

}  // namespace skyloop::host
