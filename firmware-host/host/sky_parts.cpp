#include "sky_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "data_folders.hpp"
#include "run/emulator/load_scene.hpp"
#include "run/emulator/load_track.hpp"
#include "run/scenario/board_files.hpp"
#include "run_session.hpp"
#include "study/analysis/city_run.hpp"
#include "study/analysis/coverage_map.hpp"
#include "study/plot/city_run_plot.hpp"
#include "study/plot/scene_plot.hpp"

namespace skyloop::host {
namespace {

// --at LAT,LON names a place on a street: its height is that of the ground there, or of the foot of the buildings.
void stand_on_ground(Scenario& scenario, const UrbanScene& scene, const std::string& at) {
    auto* fixed = std::get_if<FixedSettings>(&scenario.trajectory);
    if (!fixed || at.empty() || std::ranges::count(at, ',') > 1) return;
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
    for (const std::string& note : navigation->notes)
        messages.info(note);
    messages.warnings(warnings);
    SimulationSetup setup{std::move(navigation->source), geoid.get(), start, data_folders(), 0, loaded->scene};
    // The receiver below reports a board that does not exist.
    if (const auto board = find_board(scenario.receivers.front().board, board_folders(data_folders())))
        setup.board_keys = board->modern;
    auto simulation = make_simulation(scenario, setup);
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
    messages.warnings(loaded->warnings);
    fmt::print("{}", city_run_plot_svg(*run, loaded->scene.get(), loaded->scene ? "A run through the city" : "A run"));
    return 0;
}

namespace {

constexpr double most_map_epochs = 10'000;

Result<CoverageGrid> asked_grid(const SkyOptions& options) {
    if (options.step > 0 && options.grid_size > 0)
        return fail(ErrorCode::usage, "--step and --grid-size both say how large cells are; expected one of them");
    if (options.step > 0) return CoverageGrid::parse(options.grid, Metres(options.step));
    constexpr int default_cells = 50;
    return CoverageGrid::parse(options.grid, options.grid_size > 0 ? options.grid_size : default_cells);
}

// The sky above the middle of the area: satellites are so far that it serves every cell.
Result<std::vector<CoverageEpoch>> map_epochs(const SkyOptions& options, const World& world, const Geodetic& middle) {
    const double duration = options.duration;
    const double count = std::floor(duration / options.interval_s) + 1;
    if (!(count <= most_map_epochs))
        return fail(ErrorCode::usage, fmt::format("--interval {:g}: {:g} s make {:.0f} epochs; expected at most {:.0f}",
                                                  options.interval_s, duration, count, most_map_epochs));
    std::vector<CoverageEpoch> epochs;
    TruthState truth;
    truth.geodetic = middle;
    truth.position = to_ecef(middle);
    for (int k = 0; k < static_cast<int>(count); ++k) {
        truth.time = advanced(world.start, Seconds(k * options.interval_s));
        epochs.push_back({truth.time, world.simulation.view(truth)});
    }
    return epochs;
}

CoverageSettings map_settings(const SkyOptions& options, const Scenario& scenario) {
    CoverageSettings settings;
    settings.antenna_height = Metres(options.height_m);
    settings.mask = scenario.sky.elevation_mask.value_or(settings.mask);
    settings.reflections = !options.direct_only;
    settings.search.most_reflections = scenario.scene.reflections.value_or(most_reflections);
    settings.search.roofs_reflect = options.all_paths || scenario.scene.roofs_reflect;
    settings.search.ground_reflects = options.all_paths || scenario.scene.ground_reflects.value_or(false);
    if (scenario.scene.rays > 0) settings.search.rays = scenario.scene.rays;
    // What an epoch found is tried first at the next one, however long that takes to come.
    settings.search.cache_seconds = std::max(settings.search.cache_seconds, 2.5 * options.interval_s);
    const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
    settings.threads = options.threads > 0 ? options.threads : static_cast<int>(std::min(cores, 64U));
    return settings;
}

bool stands_in(const UrbanScene& scene, const CoverageMap& map) {
    const SceneStatistics& s = scene.statistics();
    Eigen::AlignedBox2d grid;
    for (const CoverageCell& cell : map.cells)
        grid.extend(cell.position.head<2>());
    return grid.intersects(Eigen::AlignedBox2d(s.lowest.head<2>(), s.highest.head<2>()));
}

CoverageQuantity shown_quantity(const std::string& name) {
    const auto found = std::ranges::find(coverage_quantity_names, name);
    return static_cast<CoverageQuantity>(found - coverage_quantity_names.begin());
}

}  // namespace

int show_coverage(const SkyOptions& options, Scenario scenario, const Messages& messages) {
    const auto grid = asked_grid(options);
    if (!grid) return messages.error(grid.error());
    if (options.format == "json") return messages.error({ErrorCode::usage, "--grid comes as --format csv or svg"});
    // Buildings without an origin stand in the middle of the area unless a place is named.
    if (options.run.at.empty() && options.run.scenario.empty()) scenario.trajectory = FixedSettings{grid->middle()};
    const auto world = make_world(scenario, options, messages);
    if (!world) return messages.error(world.error());
    const auto epochs = map_epochs(options, *world, grid->middle());
    if (!epochs) return messages.error(epochs.error());
    const CoverageSettings settings = map_settings(options, scenario);
    messages.detail(fmt::format("{} cells, {} epochs, {} threads", grid->cells(), epochs->size(), settings.threads));
    const CoverageMap map = coverage_map(world->scene, *grid, *epochs, settings);
    if (world->scene && !stands_in(*world->scene, map))
        messages.warning("--grid lies beside the buildings: nothing of the scene stands in it");
    if (options.format == "svg")
        fmt::print("{}", coverage_plot_svg(map, shown_quantity(options.show), world->scene.get()));
    else
        fmt::print("{}", coverage_csv(map));
    return 0;
}

}  // namespace skyloop::host
