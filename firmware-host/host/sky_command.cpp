#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/time/utc_time.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "firmware/core/receiver.hpp"
#include "run/scenario/board_files.hpp"
#include "run_session.hpp"
#include "sky_parts.hpp"
#include "study/analysis/sky_listing.hpp"
#include "study/plot/scene_plot.hpp"
#include "study/plot/sky_plot.hpp"
#include "study/plot/track_plot.hpp"
#include "world/sky/satellite_tracks.hpp"

namespace skyloop::host {
namespace {

// Where each satellite was in the two hours before, drawn as a thin line behind it.
void add_trails(SkyPlot& plot, const World& world, const TruthState& truth) {
    constexpr int trail_points = 24;
    constexpr double trail_step_s = 300;
    for (int k = trail_points; k >= 0; --k) {
        TruthState then = truth;
        then.time = advanced(then.time, Seconds(-trail_step_s * k));
        const SkyView view = world.simulation.view(then);
        for (SkyPlotSatellite& satellite : plot.satellites)
            for (const SatelliteInView& v : view.satellites)
                if (v.id == satellite.id) satellite.trail.push_back({v.azimuth, v.elevation});
    }
}

/// A place in the city and what arrives there.
struct CityPlace {
    Eigen::Vector3d antenna;  ///< in the scene's frame, m
    std::vector<SceneSatellite> satellites;
    std::vector<SceneReception> receptions;
};

// By the article's rule (MODELS.md R-21 … R-23) unless all paths are asked for, whatever the model: walls reflect, up
// to 16 times, and only what is not in line of sight needs them.
CityPlace city_place(const SkyOptions& options, const World& world, const Trace& trace) {
    const LocalFrame& frame = world.scene->frame();
    CityPlace place{world.scene->above_surface(frame.to_enu(trace.truth.position).vector()),
                    scene_satellites(frame, trace.sky),
                    {}};
    PathSearchSettings search;
    search.roofs_reflect = search.ground_reflects = options.all_paths;
    search.blocked_only = !options.all_paths;
    search.rays = 65536;
    search.search_ahead = false;
    PathFinder finder(world.scene, search);
    // Each search turns its rays, and what it finds stays: a few of them miss nothing that one may.
    constexpr int searches = 4;
    std::vector<SatellitePaths> found;
    for (int k = 0; k < searches; ++k)
        found = finder.epoch({trace.truth.time, place.antenna}, place.satellites);
    for (const SatellitePaths& paths : found)
        place.receptions.push_back(scene_reception(*world.scene, paths, place.antenna));
    return place;
}

std::string sky_svg(const SkyListing& listing, const World& world, const TruthState& truth,
                    const std::optional<CityPlace>& city) {
    SkyPlot plot = sky_plot(listing);
    add_trails(plot, world, truth);
    if (city) plot.obstruction = sky_mask(*world.scene, city->antenna);
    return sky_plot_svg(plot);
}

std::string plan_svg(const World& world, const CityPlace& city, Angle mask) {
    constexpr double radius = 250;  // m
    ScenePlot plot;
    plot.title = "Signals in the city";
    plot.area = scene_plot_area(city.antenna, radius);
    plot.observer = city.antenna;
    for (std::size_t i = 0; i < city.satellites.size(); ++i) {
        const Eigen::Vector3d towards = (city.satellites[i].position - city.antenna).normalized();
        if (std::asin(towards.z()) >= mask.rad())
            plot.rays.push_back(scene_plot_ray(city.receptions[i], city.satellites[i], city.antenna));
    }
    return scene_plot_svg(*world.scene, plot);
}

int print_tracks(const SkyOptions& options, const World& world) {
    const double step = options.step > 0 ? options.step : 300;
    const auto tracks =
        satellite_tracks(world.simulation.navigation(), {world.start, Seconds(options.tracks_h * 3600), Seconds(step)});
    if (options.format == "svg")
        fmt::print("{}", track_plot_svg(tracks, fmt::format("Satellite tracks in ECEF over {:g} h from {}",
                                                            options.tracks_h, utc_text(world.start))));
    else
        fmt::print("{}", tracks_csv(tracks));
    return 0;
}

// The first option that says what a recorded run has said already, or how to draw something else; empty: none.
std::string_view not_of_a_run(const SkyOptions& options) {
    const std::array<std::pair<bool, std::string_view>, 10> others{
        {{!options.run.at.empty(), "--at"},
         {!options.run.nav.empty(), "--nav"},
         {options.run.keys.given("--rebase-nav"), "--rebase-nav"},
         {options.run.keys.given("--start"), "--start"},
         {options.run.keys.given("--model"), "--model"},
         {options.tracks_h > 0, "--tracks"},
         {options.step > 0, "--step"},
         {!options.grid.empty(), "--grid"},
         {options.all_paths, "--all-paths"},
         {options.view != "sky", "--view"}}};
    const auto* const given = std::find_if(others.begin(), others.end(), [](const auto& other) { return other.first; });
    return given == others.end() ? std::string_view() : given->second;
}

// What contradicts itself on the command line.
std::optional<std::string> sky_misuse(const SkyOptions& options, const Scenario& scenario) {
    const std::string_view beside_run = options.run_folder.empty() ? std::string_view() : not_of_a_run(options);
    if (!beside_run.empty()) return fmt::format("--run draws what was recorded; expected it without {}", beside_run);
    if (options.tracks_h > 0 && options.format == "json") return "--tracks comes as --format csv or svg";
    if (options.tracks_h > 0 && !options.grid.empty()) return "--tracks and --grid show different things; expected one";
    if (options.step > 0 && options.tracks_h == 0 && options.grid.empty())
        return "--step is that of --tracks or --grid; expected one of them";
    if (options.view == "plan" && !scenario.scene.given()) return "--view plan shows buildings: expected --scene FILE";
    if (options.all_paths && !scenario.scene.given())
        return "--all-paths shows reflections off buildings: expected --scene FILE";
    if (options.view == "plan" && options.format != "svg") return "--view plan comes as --format svg";
    return std::nullopt;
}

// That of a scenario says what is used. Without one a receiver that tracks everything shows the whole sky.
Result<ReceiverSettings> looking_receiver(const SkyOptions& options, const Scenario& scenario) {
    ReceiverSettings everything;
    everything.elevation_mask = scenario.sky.elevation_mask.value_or(everything.elevation_mask);
    if (options.run.scenario.empty()) return everything;
    const auto board = find_board(scenario.receivers.front().board, board_folders(data_folders()));
    if (!board) return fail(board.error());
    // Its configuration has a say, too: in the rate, and in how many satellites a solution takes.
    const double rate_hz = scenario.receivers.front().rate_hz.value_or(0);
    ReceiverSettings settings = firmware::Receiver(*board, {rate_hz, receiver_settings(scenario, *board)}).settings();
    settings.start = StartKind::hot;  // one instant has no time to acquire
    return settings;
}

int print_sky(const SkyOptions& options, const Scenario& scenario, World& world, const Messages& messages) {
    const auto asked = looking_receiver(options, scenario);
    if (!asked) return messages.error(asked.error());
    const ReceiverSettings& receiver = *asked;
    const Trace trace = world.simulation.run(world.start, receiver);
    std::optional<CityPlace> city;
    if (world.scene) city = city_place(options, world, trace);
    if (city && sees_no_sky(*world.scene, city->antenna))
        messages.warning("the antenna is inside a building or below the ground: nothing arrives there directly");
    const SkyListing listing = sky_listing(trace.truth, trace.sky, receiver.elevation_mask,
                                           {&trace.arrivals, &trace.epoch.fix, city ? &city->receptions : nullptr});
    if (options.format == "svg")
        fmt::print("{}", city && options.view == "plan" ? plan_svg(world, *city, receiver.elevation_mask)
                                                        : sky_svg(listing, world, trace.truth, city));
    else if (options.format == "json")
        fmt::print("{}", sky_json(listing));
    else
        fmt::print("{}", options.format == "csv" ? sky_csv(std::span(&listing, 1)) : sky_text(listing));
    return 0;
}

int show_sky(const SkyOptions& options) {
    const Messages messages(options.run.verbosity);
    auto scenario = scenario_from(options.run);
    if (!scenario) return messages.error(scenario.error());
    if (const auto misuse = sky_misuse(options, *scenario)) return messages.error({ErrorCode::usage, *misuse});
    if (!options.run_folder.empty()) return show_city_run(options, *scenario, messages);
    if (!options.grid.empty()) return show_coverage(options, *scenario, messages);
    auto world = make_world(*scenario, options, messages);
    if (!world) return messages.error(world.error());
    if (options.tracks_h > 0) return print_tracks(options, *world);
    return print_sky(options, *scenario, *world, messages);
}

void add_city_options(CLI::App& command, SkyOptions& options) {
    command.add_flag("--all-paths", options.all_paths,
                     "In a city also the reflections of satellites in line of sight, and those off roofs and ground");
    command.add_option("--view", options.view, "Of the svg: sky, or plan, the city from above with the signals' ways")
        ->check(CLI::IsMember({"sky", "plan"}));
    command.add_option("--run", options.run_folder,
                       "Draw a recorded run instead (svg): the folder that simulate --out or run --record wrote");
}

void add_grid_options(CLI::App& command, SkyOptions& options) {
    CLI::Option* grid = command.add_option(
        "--grid", options.grid,
        "Map over an area (csv or svg): WEST,SOUTH,EAST,NORTH in degrees; cells by --step or --grid-size");
    command.add_option("--grid-size", options.grid_size, "Cells along the longer side of the map, default 50")
        ->check(CLI::Range(1, 1000));
    command.add_option("--duration", options.duration, "Seconds that the map spans, default 0: one instant");
    command.add_option("--interval", options.interval_s, "Seconds between the instants of the map, default 60")
        ->check(CLI::Range(0.1, 86400.0));
    command.add_option("--height", options.height_m, "Of the map's antennas above the ground, metres, default 1.5")
        ->check(CLI::Range(0.01, 10000.0));
    command.add_flag("--direct-only", options.direct_only, "A map of lines of sight alone: much faster");
    command.add_option("--show", options.show, "What the map's svg shows: los, satellites, hdop, fix or error")
        ->check(
            CLI::IsMember(std::vector<std::string>(coverage_quantity_names.begin(), coverage_quantity_names.end())));
    command.add_option("--threads", options.threads, "That make the map, default all cores; the bytes are the same")
        ->check(CLI::Range(1, 256));
    for (const char* of_maps :
         {"--grid-size", "--duration", "--interval", "--height", "--direct-only", "--show", "--threads"})
        command.get_option(of_maps)->needs(grid);
}

}  // namespace

Action add_sky_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("sky", "Which satellites stand where");
    auto options = std::make_shared<SkyOptions>();
    command->add_option("SCENARIO", options->run.scenario, "Scenario file (TOML); without it embedded defaults");
    add_setting_option(*command, options->run.settings);
    add_place_options(*command, options->run);
    options->run.keys.add(*command, "--model", "model.name");
    add_scene_option(*command, options->run);
    command->add_option("--format", options->format, "text, json, csv or svg")
        ->check(CLI::IsMember({"text", "json", "csv", "svg"}));
    options->run.keys.add(*command, "--mask", "sky.elevation_mask_deg");
    command->add_option("--tracks", options->tracks_h, "ECEF tracks of all satellites over so many hours (csv or svg)")
        ->check(CLI::Range(0.01, 24.0 * 14));
    command
        ->add_option("--step", options->step,
                     "--tracks: seconds between points, default 300; --grid: metres between cells")
        ->check(CLI::Range(0.1, 86400.0));
    add_city_options(*command, *options);
    add_grid_options(*command, *options);
    add_verbosity_options(*command, options->run.verbosity);
    return [options] { return show_sky(*options); };
}

}  // namespace skyloop::host
