// `skyloop trajectory`, as people and as programs read it.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "base/core/files.hpp"
#include "base/core/json.hpp"
#include "base/core/words.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "messages.hpp"
#include "motion/tracks/read_track.hpp"
#include "motion/trajectory/path_survey.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/load_track.hpp"
#include "run_options.hpp"
#include "study/plot/path_plot.hpp"

namespace skyloop::host {

namespace {

// A path and what is to be told of it.
struct TrajectoryListing {
    std::string name;                  ///< of the file
    std::string kind;                  ///< "track", "waypoints", …
    std::string description;           ///< of a track: its rows and time
    std::vector<std::string> details;  ///< what was found in its file
    std::vector<std::string> notes;    ///< what its user should be told
    std::string vehicle;               ///< name of the class whose limits count; empty: none
    PathSurvey survey;
    std::vector<ExceededLimit> exceeded;
};

// A number and when it was so.
std::string when_text(const PathExtreme& extreme, std::string_view unit) {
    return fmt::format("{:.2f} {} at {:.2f} s", extreme.value, unit, extreme.at_s);
}

Json when_json(const PathExtreme& extreme) { return {{"value", extreme.value}, {"at_s", extreme.at_s}}; }

std::string limit_text(const ExceededLimit& limit) {
    return fmt::format("{} of {}: {} {} at {:.2f} s, limit {} {}", limit.what, limit.of,
                       fmt::format("{:.2f}", limit.found.value), limit.unit, limit.found.at_s,
                       fmt::format("{:g}", std::round(limit.limit * 100) / 100), limit.unit);
}

constexpr double degrees_per_radian = 57.295779513082321;

std::string trajectory_text(const TrajectoryListing& listing) {
    const PathSurvey& s = listing.survey;
    std::string text;
    const auto line = [&](std::string_view name, const std::string& value) {
        fmt::format_to(std::back_inserter(text), "{:<13}{}\n", name, value);
    };
    line("path", listing.description.empty() ? fmt::format("{}, {}", listing.name, listing.kind) : listing.description);
    for (const std::string& detail : listing.details)
        line("", detail);
    line("duration", fmt::format("{:.3f} s", s.duration_s));
    line("extent", fmt::format("{:.1f} m east-west, {:.1f} m north-south, {:.1f} m up", s.east_west_m, s.north_south_m,
                               s.highest.value - s.lowest.value));
    const LongitudeSpan longitudes = longitude_span(s);
    line("", fmt::format("latitude {:.7f} to {:.7f}, longitude {:.7f} to {:.7f}", s.south_west.latitude.deg(),
                         s.north_east.latitude.deg(), longitudes.west_deg, longitudes.east_deg));
    line("length", fmt::format("{:.1f} m", s.length_m));
    line("height", fmt::format("{} to {}, above the ellipsoid", when_text(s.lowest, "m"), when_text(s.highest, "m")));
    line("speed", when_text(s.fastest, "m/s"));
    line("", "over ground " + when_text(s.fastest_over_ground, "m/s"));
    line("climb", when_text(s.climb, "m/s"));
    line("descent", when_text(s.descent, "m/s"));
    line("acceleration", when_text(s.acceleration, "m/s²"));
    line("jerk", when_text(s.jerk, "m/s³"));
    if (s.has_orientation)
        line("turn rate", when_text({s.turn_rate.value * degrees_per_radian, s.turn_rate.at_s}, "°/s"));
    if (s.velocity_steps > 0)
        line("steps", fmt::format("{} of the velocity in no time, the largest {}", s.velocity_steps,
                                  when_text(s.largest_step, "m/s")));
    if (s.jumps > 0) line("jumps", fmt::format("{}, the largest {}", s.jumps, when_text(s.largest_jump, "m")));
    line("limits", listing.exceeded.empty()
                       ? fmt::format("kept: receiver (4 g, 50 000 m, 500 m/s), COCOM (18 288 m, 515 m/s){}",
                                     listing.vehicle.empty() ? "" : ", " + listing.vehicle)
                       : fmt::format("{} exceeded", listing.exceeded.size()));
    for (const ExceededLimit& limit : listing.exceeded)
        line("", limit_text(limit));
    for (const std::string& note : listing.notes)
        line("note", note);
    return text;
}

// One object; every number SI, angles in degrees.
std::string trajectory_json(const TrajectoryListing& listing) {
    const PathSurvey& s = listing.survey;
    Json json{{"file", listing.name}, {"kind", listing.kind}, {"description", listing.description}};
    json["details"] = listing.details;
    json["duration_s"] = s.duration_s;
    const LongitudeSpan longitudes = longitude_span(s);
    json["extent"] = {{"south_deg", s.south_west.latitude.deg()},
                      {"north_deg", s.north_east.latitude.deg()},
                      {"west_deg", longitudes.west_deg},
                      {"east_deg", longitudes.east_deg},
                      {"east_west_m", s.east_west_m},
                      {"north_south_m", s.north_south_m}};
    json["length_m"] = s.length_m;
    for (const auto& [name, extreme] : {std::pair{"lowest_m", &s.lowest},
                                        {"highest_m", &s.highest},
                                        {"speed_mps", &s.fastest},
                                        {"speed_over_ground_mps", &s.fastest_over_ground},
                                        {"climb_mps", &s.climb},
                                        {"descent_mps", &s.descent},
                                        {"acceleration_mps2", &s.acceleration},
                                        {"jerk_mps3", &s.jerk}})
        json[name] = when_json(*extreme);
    if (s.has_orientation)
        json["turn_rate_dps"] = when_json({s.turn_rate.value * degrees_per_radian, s.turn_rate.at_s});
    json["velocity_steps"] = {{"count", s.velocity_steps}, {"largest_mps", when_json(s.largest_step)}};
    json["jumps"] = {{"count", s.jumps}, {"largest_m", when_json(s.largest_jump)}};
    json["exceeded"] = Json::array();
    for (const ExceededLimit& limit : listing.exceeded)
        json["exceeded"].push_back({{"of", limit.of},
                                    {"what", limit.what},
                                    {"unit", limit.unit},
                                    {"limit", limit.limit},
                                    {"value", limit.found.value},
                                    {"at_s", limit.found.at_s}});
    json["notes"] = listing.notes;
    // Names of files may hold what is no UTF-8.
    return json_text(json, 2) + "\n";
}

struct TrajectoryOptions {
    std::string file, vehicle, format = "text";
    std::vector<std::string> settings;
    std::string smooth;  // empty: as the file says
    std::optional<double> rate_hz, duration_s, gap_s, speed_mps;
    std::string origin;  // empty: as the file says
    Verbosity verbosity;
};

// A path ready to be asked.
struct OpenedPath {
    std::unique_ptr<Trajectory> path;
    PathSpan span;
    TrajectoryListing listing;
};

Result<std::optional<VehicleClass>> chosen_vehicle(const std::string& name) {
    if (name.empty()) return std::optional<VehicleClass>();
    const auto names = track_vehicle_names();
    if (std::find(names.begin(), names.end(), name) != names.end()) return vehicle_class_named(name);
    return fail(ErrorCode::usage, fmt::format("--vehicle {}: expected one of {}{}", name, fmt::join(names, " "),
                                              did_you_mean(name, names)));
}

// A .toml file holds a trajectory, alone or in a whole scenario; any other is a track.
Result<Scenario> scenario_of(const TrajectoryOptions& options) {
    const std::filesystem::path file = options.file;
    if (file.extension() == ".toml") return scenario_with(options.file, options.settings);
    if (!options.settings.empty())
        return fail(ErrorCode::usage, fmt::format("--set is for scenarios; {} is a track", options.file));
    Scenario scenario;
    FileSettings track;
    track.path = file;
    scenario.trajectory = track;
    return scenario;
}

// What the command line says of a track.
Result<void> apply_track_options(const TrajectoryOptions& options, std::optional<VehicleClass> vehicle,
                                 Scenario& scenario) {
    auto* file = std::get_if<FileSettings>(&scenario.trajectory);
    const std::string_view of_tracks = !options.smooth.empty()   ? "--smooth"
                                       : options.gap_s           ? "--gap"
                                       : options.speed_mps       ? "--speed"
                                       : !options.origin.empty() ? "--origin"
                                                                 : "";
    if (!file && !of_tracks.empty())
        return fail(ErrorCode::usage,
                    fmt::format("{} is for tracks; {} holds a path of another kind", of_tracks, options.file));
    if (!file) return {};
    if (vehicle) file->vehicle = vehicle;
    if (options.gap_s) file->gap = Seconds(*options.gap_s);
    if (options.speed_mps) file->route_speed = MetresPerSecond(*options.speed_mps);
    if (!options.origin.empty()) {
        const auto place = parse_place(options.origin, "--origin");
        if (!place) return fail(place.error());
        file->origin = *place;
    }
    if (options.smooth == "none") file->smoothing = Smoothing::none;
    if (options.smooth == "noise") file->smoothing = Smoothing::noise;
    if (options.smooth == "sensor") file->smoothing = Smoothing::sensor;
    return {};
}

// Of the paths that end or repeat by themselves.
std::optional<Seconds> natural_length(const TrajectorySettings& way, const Trajectory& path) {
    if (const auto* waypoints = dynamic_cast<const Waypoints*>(&path)) return waypoints->duration();
    if (const auto* circle = std::get_if<CircleSettings>(&way); circle && circle->shape.speed.value() != 0)
        return Seconds(2 * std::numbers::pi * circle->shape.radius.value() / std::abs(circle->shape.speed.value()));
    if (const auto* generated = std::get_if<GeneratedSettings>(&way);
        generated && std::isfinite(generated->shape->duration()))
        return generated->path.start_delay + Seconds(generated->shape->duration());
    if (std::holds_alternative<FixedSettings>(way)) return Seconds(1);
    return std::nullopt;
}

Seconds length_to_look_at(const TrajectoryOptions& options, const Scenario& scenario, const LoadedTrack& track,
                          OpenedPath& opened) {
    constexpr Seconds unless_told(600);
    if (options.duration_s) return Seconds(*options.duration_s);
    if (track.path_end) return difference(*track.path_end, opened.span.from);
    if (const auto length = natural_length(scenario.trajectory, *opened.path)) return *length;
    if (scenario.run.duration) return *scenario.run.duration;
    opened.listing.notes.push_back(
        fmt::format("the path has no end of its own: its first {:g} s, or --duration", unless_told.value()));
    return unless_told;
}

bool same_places(const Track& a, const Track& b) {
    return std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                      [](const TrackRow& x, const TrackRow& y) { return x.position.vector() == y.position.vector(); });
}

// Which files have local metres is known to their readers alone: without the origin these say something else, or
// nothing.
bool origin_matters(const FileSettings& file, const Geoid* geoid) {
    const auto text = read_text_file(file.path);
    if (!text) return true;
    const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(text->data()), text->size());
    const auto with = read_track(bytes, file.path.string(), {geoid, file.origin});
    const auto without = read_track(bytes, file.path.string(), {geoid, std::nullopt});
    return !with || !without || !same_places(*with, *without);
}

// Of what the command line says of a loaded track, what nothing came of.
Result<void> check_track_options(const TrajectoryOptions& options, const FileSettings& file, const Geoid* geoid) {
    if (options.speed_mps && !file.route)
        return fail(
            ErrorCode::usage,
            fmt::format("--speed: {} has times, which say how fast it goes; expected a file without", options.file));
    if (!options.origin.empty() && !origin_matters(file, geoid))
        return fail(ErrorCode::usage,
                    fmt::format("--origin: {} says itself where its places lie; expected a file of local metres",
                                options.file));
    return {};
}

Result<OpenedPath> open_path(const TrajectoryOptions& options) {
    const auto vehicle = chosen_vehicle(options.vehicle);
    if (!vehicle) return fail(vehicle.error());
    auto scenario = scenario_of(options);
    if (!scenario) return fail(scenario.error());
    if (const auto applied = apply_track_options(options, *vehicle, *scenario); !applied) return fail(applied.error());
    OpenedPath opened;
    TrajectoryListing& listing = opened.listing;
    listing.name = options.file;
    listing.notes = scenario->warnings;
    const auto geoid = find_geoid(data_folders(), listing.notes);
    // The path alone, wherever the run would begin: a track that keeps its time begins with its first row.
    opened.span.from = scenario->run.start.value_or(to_gps_time(2300, 0));
    auto* file = std::get_if<FileSettings>(&scenario->trajectory);
    if (file) file->keeps_time = false;
    scenario->receivers.resize(1);
    scenario->receivers[0].trajectory.reset();
    const auto track = load_track(*scenario, geoid.get(), opened.span.from);
    if (!track) return fail(track.error());
    if (file)
        if (const auto fits = check_track_options(options, *file, geoid.get()); !fits) return fail(fits.error());
    listing.kind = !file ? "path of a scenario" : file->route ? "route" : "track";
    listing.description = track->description;
    listing.details = track->details;
    listing.notes.insert(listing.notes.end(), track->warnings.begin(), track->warnings.end());
    opened.path = make_trajectory(scenario->trajectory, opened.span.from);
    opened.span.length = length_to_look_at(options, *scenario, *track, opened);
    auto limits_of = *vehicle ? *vehicle : file ? file->vehicle : std::nullopt;
    if (file && file->route) limits_of = file->route->vehicle;
    if (limits_of) listing.vehicle = traits_of(*limits_of).name;
    listing.survey = survey_path(*opened.path, opened.span);
    listing.exceeded = exceeded_limits(listing.survey, limits_of);
    return opened;
}

Result<std::string> path_output(const TrajectoryOptions& options, const OpenedPath& opened) {
    if (options.format == "json") return trajectory_json(opened.listing);
    if (options.format == "text") return trajectory_text(opened.listing);
    // A picture needs no more samples than it has pixels to show them.
    constexpr double samples_of_picture = 1400;
    const double rate =
        options.format == "csv"
            ? options.rate_hz.value_or(1)
            : options.rate_hz.value_or(std::min(100.0, samples_of_picture / opened.span.length.value()));
    const auto samples = sample_path(*opened.path, opened.span, Hertz(rate));
    if (!samples) return fail(samples.error());
    if (options.format == "csv") return path_csv(*samples);
    return path_plot_svg(*samples, std::filesystem::path(options.file).filename().string());
}

int trajectory(const TrajectoryOptions& options) {
    const Messages messages(options.verbosity);
    if (options.format == "text" || options.format == "json")
        if (options.rate_hz) return messages.error({ErrorCode::usage, "--rate is for --format csv and svg"});
    const auto opened = open_path(options);
    if (!opened) return messages.error(opened.error());
    const auto text = path_output(options, *opened);
    if (!text) return messages.error(text.error());
    if (options.format == "csv" || options.format == "svg")
        for (const std::string& note : opened->listing.notes)
            messages.warning(note);
    fmt::print("{}", *text);
    return 0;
}

}  // namespace

Action add_trajectory_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "trajectory", "Say what a track or another path asks for: extent, speeds, accelerations, limits; or draw it");
    auto options = std::make_shared<TrajectoryOptions>();
    command->add_option("FILE", options->file, "A track, or a .toml with a [trajectory], alone or in a scenario")
        ->required();
    add_setting_option(*command, options->settings);
    command->add_option("--vehicle", options->vehicle,
                        "Whose limits count, and how a track without attitudes stands: fixed pedestrian car rover boat "
                        "plane multirotor");
    command->add_option("--format", options->format, "text json csv svg; default text")
        ->check(CLI::IsMember({"text", "json", "csv", "svg"}));
    command->add_option("--rate", options->rate_hz, "Samples of csv and svg, Hz; default 1 in csv")
        ->check(CLI::Range(1e-4, 1e4));
    command->add_option("--duration", options->duration_s, "Seconds to look at; default the whole path")
        ->check(CLI::Range(1e-3, 1e8));
    declare_as_key(*command->add_option("--smooth", options->smooth), "trajectory.smooth");
    declare_as_key(*command->add_option("--gap", options->gap_s), "trajectory.gap_s");
    declare_as_key(*command->add_option("--speed", options->speed_mps), "trajectory.speed_mps", "file");
    command->add_option("--origin", options->origin, "LATITUDE,LONGITUDE[,HEIGHT] of local metres: degrees, m");
    add_verbosity_options(*command, options->verbosity);
    return [options] { return trajectory(*options); };
}

}  // namespace skyloop::host
