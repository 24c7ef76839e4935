#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "commands.hpp"
#include "data_folders.hpp"
#include "run_session.hpp"
#include "skyloop/analysis/sky_listing.hpp"
#include "skyloop/analysis/tracks_csv.hpp"
#include "skyloop/plot/sky_plot.hpp"
#include "skyloop/plot/track_plot.hpp"
#include "skyloop/sky/satellite_tracks.hpp"
#include "skyloop/time/utc_time.hpp"

namespace skyloop::host {
namespace {

struct SkyOptions {
    RunOptions run;
    std::string format = "text";
    std::optional<double> mask_deg;
    double tracks_h = 0;
    double step_s = 0;
};

/// The world of a scenario, without a receiver.
struct World {
    std::unique_ptr<Geoid> geoid;
    Simulation simulation;
    GpsTime start;
};

Result<World> make_world(const Scenario& scenario, const Messages& messages) {
    auto navigation = load_navigation(scenario, wall_clock());
    if (!navigation) return fail(navigation.error());
    std::vector<std::string> warnings = scenario_warnings(scenario);
    warnings.insert(warnings.end(), navigation->warnings.begin(), navigation->warnings.end());
    auto geoid = find_geoid(data_folders(), warnings);
    for (const std::string& warning : warnings)
        messages.warning(warning);
    const GpsTime start = navigation->start;
    const Geodetic place = make_trajectory(scenario.trajectory, start)->at(start).geodetic;
    auto scene = load_scene(scenario, place, CityCache{data_folders().cache});
    if (!scene) return fail(scene.error());
    for (const std::string& warning : scene->warnings)
        messages.warning(warning);
    auto simulation = make_simulation(
        scenario, {std::move(navigation->source), geoid.get(), start, data_folders(), 0, std::move(scene->scene)});
    if (!simulation) return fail(simulation.error());
    return World{std::move(geoid), std::move(*simulation), start};
}

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

// What buildings did to each satellite; nothing where none stand.
std::optional<std::vector<SceneReception>> receptions_of(const Simulation& simulation) {
    const RayTracedScene* city = simulation.city();
    if (city == nullptr) return std::nullopt;
    std::vector<SceneReception> receptions;
    for (const SatellitePaths& found : city->paths())
        receptions.push_back(scene_reception(city->scene(), found, city->antenna()));
    return receptions;
}

std::string sky_svg(const SkyListing& listing, const World& world, const TruthState& truth) {
    SkyPlot plot = sky_plot(listing);
    add_trails(plot, world, truth);
    if (const RayTracedScene* city = world.simulation.city())
        plot.obstruction = sky_mask(city->scene(), city->antenna());
    return sky_plot_svg(plot);
}

int print_tracks(const SkyOptions& options, const World& world) {
    const double step = options.step_s > 0 ? options.step_s : 300;
    const auto tracks =
        satellite_tracks(world.simulation.navigation(), {world.start, Seconds(options.tracks_h * 3600), Seconds(step)});
    if (options.format == "svg")
        fmt::print("{}",
                   track_plot_svg(tracks, fmt::format("Satellite tracks in ECEF over {:g} h from {}", options.tracks_h,
                                                      format_utc(to_utc(world.start, LeapSeconds::announced()), 0))));
    else
        fmt::print("{}", tracks_csv(tracks));
    return 0;
}

int show_sky(const SkyOptions& options) {
    const Messages messages(options.run.verbosity);
    auto scenario = scenario_from(options.run);
    if (!scenario) return messages.error(scenario.error());
    if (options.mask_deg) scenario->sky.elevation_mask = Angle::degrees(*options.mask_deg);
    if (options.tracks_h > 0 && options.format != "csv" && options.format != "svg" && options.format != "text")
        return messages.error({ErrorCode::usage, "--tracks comes as --format csv or svg"});
    auto world = make_world(*scenario, messages);
    if (!world) return messages.error(world.error());
    if (options.tracks_h > 0) return print_tracks(options, *world);

    // A receiver that tracks everything shows the whole sky.
    ReceiverSettings receiver;
    receiver.elevation_mask = scenario->sky.elevation_mask.value_or(receiver.elevation_mask);
    const Trace trace = world->simulation.run(world->start, receiver);
    const auto receptions = receptions_of(world->simulation);
    const SkyListing listing = sky_listing(trace.truth, trace.sky, receiver.elevation_mask,
                                           {&trace.arrivals, &trace.epoch.fix, receptions ? &*receptions : nullptr});
    if (options.format == "svg")
        fmt::print("{}", sky_svg(listing, *world, trace.truth));
    else if (options.format == "json")
        fmt::print("{}", sky_json(listing));
    else
        fmt::print("{}", options.format == "csv" ? sky_csv(std::span(&listing, 1)) : sky_text(listing));
    return 0;
}

}  // namespace

Action add_sky_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("sky", "Which satellites stand where");
    auto options = std::make_shared<SkyOptions>();
    command->add_option("scenario", options->run.scenario, "Scenario file (TOML); without it embedded defaults");
    add_place_options(*command, options->run);
    command->add_option("--model", options->run.model, "Sensor model that decides which satellites are used");
    add_scene_option(*command, options->run);
    command->add_option("--format", options->format, "text, json, csv or svg")
        ->check(CLI::IsMember({"text", "json", "csv", "svg"}));
    command->add_option("--mask", options->mask_deg, "Elevation mask, degrees")->check(CLI::Range(0.0, 90.0));
    command->add_option("--tracks", options->tracks_h, "ECEF tracks of all satellites over so many hours (csv or svg)")
        ->check(CLI::Range(0.01, 24.0 * 14));
    command->add_option("--step", options->step_s, "Seconds between points of a track, default 300")
        ->check(CLI::Range(1.0, 86400.0));
    add_verbosity_options(*command, options->run.verbosity);
    return [options] { return show_sky(*options); };
}

}  // namespace skyloop::host
