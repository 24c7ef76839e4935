#include "run_options.hpp"
#include "data_folders.hpp"
#include "run_session.hpp"
#include "run_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <system_error>

#include "base/core/files.hpp"
#include "base/core/words.hpp"
#include "run/emulator/assembly.hpp"
#include "run/scenario/board_files.hpp"
#include "run/scenario/key_catalogue.hpp"
#include "run/scenario/scenario_file.hpp"
#include "wire/transport/open_transport.hpp"

namespace skyloop::host {
namespace {

// An option's path is relative to the working folder, a key's to the scenario.
std::string path_text(const std::string& path, const std::string& scenario) {
    const bool elsewhere =
        std::filesystem::path(scenario).has_parent_path() && !path.empty() && path != demo_scene_name;
    return quoted_value(elsewhere ? std::filesystem::absolute(path).string() : path).toml;
}

bool names_toml(const std::string& trajectory) { return std::filesystem::path(trajectory).extension() == ".toml"; }

// --at and --trajectory, which take the place of the whole table.
Result<void> add_trajectory_change(const RunOptions& options, std::vector<ScenarioChange>& changes) {
    if (!options.at.empty() && !options.trajectory.empty())
        return fail(ErrorCode::usage, "--at and --trajectory both say where the antenna is; expected one of them");
    if (!options.at.empty()) {
        const auto place = parse_place(options.at);
        if (!place) return fail(place.error());
        std::string numbers;  // as TOML writes them
        for (std::size_t from = 0, to = 0; to < options.at.size(); from = to + 1) {
            to = std::min(options.at.find(',', from), options.at.size());
            double number = 0;
            std::from_chars(options.at.data() + from, options.at.data() + to, number);
            numbers += campaign_value(number).toml + ", ";
        }
        changes.push_back(change_of("--at", "trajectory", fmt::format("{{ kind = \"fixed\", at = [{}] }}", numbers)));
    }
    if (!options.trajectory.empty() && !names_toml(options.trajectory))
        changes.push_back(change_of(
            "--trajectory", "trajectory",
            fmt::format("{{ kind = \"file\", path = {} }}", path_text(options.trajectory, options.scenario))));
    return {};
}

Result<std::vector<ScenarioChange>> changes_of(const std::vector<std::string>& settings) {
    std::vector<ScenarioChange> changes;
    for (const std::string& setting : settings) {
        auto change = parse_change(setting);
        if (!change) return fail(change.error().code, "--set " + change.error().message);
        change->option = "--set " + change->key;
        changes.push_back(std::move(*change));
    }
    return changes;
}

// The options are rows laid over the scenario, after those of --set.
Result<std::vector<ScenarioChange>> changes_of(const RunOptions& options) {
    auto changes = changes_of(options.settings);
    if (!changes) return changes;
    if (const auto added = add_trajectory_change(options, *changes); !added) return fail(added.error());
    const auto add = [&](std::string_view option, std::string_view key, bool given, const std::string& toml) {
        if (given) changes->push_back(change_of(option, key, toml));
    };
    std::string files, outputs;
    for (const std::string& file : options.nav)
        files +=
            (file == automatic_navigation_word ? quoted_value(file).toml : path_text(file, options.scenario)) + ", ";
    for (const std::string& uri : options.outputs)
        outputs += fmt::format("{{ to = {} }}, ", quoted_value(uri).toml);
    add("--nav", "sky.navigation", !options.nav.empty(), "[" + files + "]");
    add("--scene", "scene.buildings", !options.scene.empty(), path_text(options.scene, options.scenario));
    add("--board", "receiver.0.board", !options.board.empty(),
        is_board_path(options.board) ? path_text(options.board, options.scenario) : quoted_value(options.board).toml);
    add("--port", "receiver.0.port", !options.ports.empty(), toml_list(options.ports));
    add("--state", "receiver.0.state_file", !options.state.empty(), path_text(options.state, options.scenario));
    add("--output", "output", !options.outputs.empty(), "[" + outputs + "]");
    for (ScenarioChange& change : options.keys.changes())
        if (change.value.toml != "\"max\"") changes->push_back(std::move(change));
    return changes;
}

Result<Scenario> scenario_with_changes(const std::string& file, std::span<const ScenarioChange> changes) {
    if (file.empty() && changes.empty()) return Scenario();
    for (const ScenarioChange& change : changes)
        for (std::string_view rest = change.value.toml; !rest.empty(); rest.remove_prefix(utf8_length(rest)))
            if (utf8_length(rest) == 0) return fail(ErrorCode::usage, change.option + ": is no text in UTF-8");
    ScenarioReading reading =
        file.empty() ? read_with_mistakes("", Scenario().name, changes) : read_file_with_mistakes(file, changes);
    if (!reading.mistakes) return std::move(reading.scenario);
    if (!file.empty() && reading.scenario.source.empty()) return fail(*reading.mistakes);
    Error mistakes = with_other_mistakes(*reading.mistakes, reading.scenario, data_folders(), wall_clock());
    return fail(ErrorCode::input, std::move(mistakes.message));
}

// @param playback of the track, --loop and others: changes of the file that has the trajectory
Result<Scenario> scenario_of_options(const RunOptions& options, std::vector<ScenarioChange> changes,
                                     const std::vector<ScenarioChange>& playback) {
    const bool own_file = names_toml(options.trajectory);
    if (!own_file) changes.insert(changes.end(), playback.begin(), playback.end());
    auto scenario = scenario_with_changes(options.scenario, changes);
    if (!scenario || !own_file) return scenario;
    auto trajectory = read_trajectory_file(options.trajectory, scenario->warnings, playback);
    if (!trajectory) return fail(trajectory.error());
    scenario->trajectory = std::move(*trajectory);
    scenario->trajectory_file = options.trajectory;
    // For the digest: the file's name alone does not say what it holds.
    if (const auto text = read_text_file(options.trajectory)) scenario->source += "\n" + *text;
    return scenario;
}

// A repeated run begins when the recorded one did: what it received has its instants from then on. --start may be
// there, as all that changed that run.
Result<void> apply_repeat(const RunOptions& options, Scenario& scenario) {
    if (options.repeat.empty()) return {};
    const auto start = scenario.run.start;
    if (const auto repeated = repeat_run(options.repeat, scenario); !repeated) return repeated;
    if (!options.keys.given("--start") || !start || start == scenario.run.start) return {};
    return fail(ErrorCode::usage,
                fmt::format("--start {}: the run of --repeat {} began at another time; expected that, or no --start",
                            options.keys.typed("--start"), options.repeat));
}

// A receiver that an output names must be there, even where the option took the place of others.
Result<void> check_outputs(const Scenario& scenario) {
    const std::vector<std::string> names = receiver_names(scenario);
    for (const OutputSettings& output : scenario.outputs)
        if (const auto chosen = told_receivers(output, names); !chosen) return fail(chosen.error());
    return {};
}

// Each run empties the files of its recording as it begins.
Result<void> check_repeat(const RunOptions& options) {
    if (options.repeat.empty() || options.record.empty()) return {};
    std::error_code absent;
    if (!std::filesystem::equivalent(options.repeat, options.record, absent)) return {};
    return fail(
        ErrorCode::usage,
        fmt::format("--repeat {}: the run would write its own recording over that; expected another folder than {}",
                    options.repeat, options.record));
}

// The options that decide what a run computes, one per line.
std::string options_text(const RunOptions& o) {
    std::string text;
    for (const auto& [name, value] :
         {std::pair{"at", o.at}, {"trajectory", o.trajectory}, {"scene", o.scene}, {"board", o.board}})
        if (!value.empty()) text += fmt::format("\n--{} {}", name, value);
    text += o.keys.computing();
    if (o.seed) text += fmt::format("\n--seed {}", *o.seed);
    return text;
}

}  // namespace

void add_verbosity_options(CLI::App& command, Verbosity& verbosity) {
    command.add_flag("--quiet", verbosity.quiet, "Warnings and errors only");
    command.add_flag("--verbose", verbosity.verbose, "More about what is done");
    command.add_flag("--log-json", verbosity.json, "Messages as JSON, an object a line");
}

void add_setting_option(CLI::App& command, std::vector<std::string>& settings) {
    command
        .add_option("--set", settings,
                    "A key of the scenario, such as receiver.0.rate_hz=5: KEY=VALUE, a value as in TOML or a word; "
                    "repeatable")
        ->allow_extra_args(false);
}

Result<Scenario> scenario_with(const std::string& file, const std::vector<std::string>& settings) {
    const auto changes = changes_of(settings);
    if (!changes) return fail(changes.error());
    return scenario_with_changes(file, *changes);
}

void add_place_options(CLI::App& command, RunOptions& options) {
    command.add_option("--at", options.at,
                       "Stand still there: LAT,LON[,HEIGHT] in degrees and metres above the ellipsoid");
    command
        .add_option("--nav", options.nav,
                    "RINEX navigation file or almanac, repeatable; or auto: the file of fetch-nav's cache; "
                    "without it a nominal sky")
        ->allow_extra_args(false);
    options.keys.add_flag(command, "--rebase-nav", "sky.rebase_navigation", "true",
                          "Move the navigation data to the start time, keeping its time of day");
    options.keys.add(command, "--start", "run.start");
}

void add_scene_option(CLI::App& command, RunOptions& options) {
    command.add_option(
        "--scene", options.scene,
        "Buildings: .obj .ply .gltf .glb .geojson .json .osm .pbf .gml .xml, a folder, .zip or .tar.gz; or demo");
}

void add_run_options(CLI::App& command, RunOptions& options) {
    command.add_option("SCENARIO", options.scenario, "Scenario file (TOML); without it embedded defaults");
    add_setting_option(command, options.settings);
    add_place_options(command, options);
    command.add_option("--trajectory", options.trajectory,
                       "A .toml file with a [trajectory], or a track: .csv, .gpx, …");
    options.keys.add_flag(command, "--loop", "trajectory.end", "\"loop\"", "Repeat the track when it ends");
    options.keys.add(command, "--time-scale", "trajectory.time_scale");
    options.keys.add(command, "--skip", "trajectory.skip_s");
    options.keys.add(command, "--duration", "run.duration_s");
    options.keys.add(command, "--model", "model.name");
    add_scene_option(command, options);
    command.add_option("--board", options.board, key_help(scenario_key("receiver.0.board")));
    options.keys.add(command, "--rate", "receiver.0.rate_hz");
    command
        .add_option("--port", options.ports,
                    fmt::format("Where the bytes go: {} - client:NAME; NAME=… is the board's port of that name, such "
                                "as uart2=pty; repeatable",
                                fmt::join(port_shapes(), " ")))
        ->allow_extra_args(false);
    command
        .add_option(
            "--output", options.outputs,
            "Send the solution to other programs as well: gps-input:HOST:PORT hil-gps:HOST:PORT msp-tcp:[HOST:]PORT "
            "msp-tcp-to:HOST:PORT json-udp:HOST:PORT json-tcp:[HOST:]PORT json-file:PATH "
            "rtcm-tcp:[HOST:]PORT rtcm-udp:HOST:PORT rtcm-file:PATH, then ,KEY=VALUE; repeatable")
        ->allow_extra_args(false);
    options.keys.add(command, "--power", "receiver.0.power");
    command.add_option("--state", options.state, key_help(scenario_key("receiver.0.state_file")));
    command.add_option("--repeat", options.repeat,
                       "A recording: its start, its clients' bytes and its live commands happen again");
    command.add_option("--seed", options.seed, "Default 1; the same scenario, seed and inputs give the same bytes");
    add_verbosity_options(command, options.verbosity);
}

Result<Geodetic> parse_place(const std::string& text, std::string_view option) {
    double values[3] = {0, 0, 0};
    const char* at = text.data();
    const char* end = at + text.size();
    int count = 0;
    for (; count < 3; ++count) {
        const auto [rest, error] = std::from_chars(at, end, values[count]);
        if (error != std::errc() || !std::isfinite(values[count])) break;
        at = rest;
        if (at == end) break;
        if (*at != ',') break;
        ++at;
    }
    const std::string asked = fmt::format("{} {}: ", option, text);
    if (at != end || count < 1 || count > 2 || text.empty() || text.back() == ',')
        return fail(ErrorCode::usage,
                    asked + "expected LAT,LON or LAT,LON,HEIGHT in degrees and metres, such as 46.4775,30.7326,77");
    const auto place = place_from_degrees(values[0], values[1], values[2]);
    if (!place) return fail(ErrorCode::usage, asked + place.error());
    return *place;
}

Result<Geodetic> parse_reference(const std::string& text) {
    auto place = parse_place(text, "--reference");
    if (place && std::ranges::count(text, ',') < 2)
        return fail(
            ErrorCode::usage,
            fmt::format("--reference {}: expected LAT,LON,HEIGHT, the height above the ellipsoid in metres", text));
    return place;
}

std::optional<std::string> vehicle_warning(const Scenario& scenario) {
    for (const CommandEntry& command : scenario.commands)
        if (command.command.verb == CommandVerb::vehicle_state) return std::nullopt;
    std::vector<std::string> waiting;
    for (const TimelineEntry& entry : timeline_of(scenario))
        if (entry.when && entry.when->needs_vehicle()) waiting.push_back("'" + entry.name + "'");
    if (waiting.empty()) return std::nullopt;
    return fmt::format(
        "{} will not begin: the vehicle's state is not known; expected skyloop run --mavlink, or commands "
        "vehicle_state",
        fmt::join(waiting, ", "));
}

std::optional<std::string> pause_warning(const Scenario& scenario) {
    std::vector<std::string> stopping;
    for (const CommandEntry& entry : scenario.commands)
        if (entry.command.verb == CommandVerb::pause || entry.command.verb == CommandVerb::step)
            stopping.push_back("'" + entry.when.name + "'");
    if (stopping.empty()) return std::nullopt;
    return fmt::format(
        "[[command]] {} stops time in skyloop run, and no entry with a later time comes then: a client of --control "
        "has "
        "to resume it",
        fmt::join(stopping, ", "));
}

Result<Scenario> scenario_from(const RunOptions& options) {
    if (const auto kept = check_repeat(options); !kept) return fail(kept.error());
    auto changes = changes_of(options);
    if (!changes) return fail(changes.error());
    const auto of_track = [](const ScenarioChange& change) {
        return !change.option.starts_with("--set") && change.key.starts_with("trajectory.");
    };
    const auto middle = std::stable_partition(changes->begin(), changes->end(), std::not_fn(of_track));
    const std::vector<ScenarioChange> playback(middle, changes->end());
    changes->erase(middle, changes->end());
    auto scenario = scenario_of_options(options, *changes, {});
    if (scenario && !playback.empty() && !std::holds_alternative<FileSettings>(scenario->trajectory))
        return fail(ErrorCode::usage,
                    fmt::format("{}: expected --trajectory TRACK, or a trajectory of kind \"file\" in the scenario",
                                playback.front().option));
    if (scenario && !playback.empty()) scenario = scenario_of_options(options, *changes, playback);
    if (!scenario) return scenario;
    if (options.keys.typed("--speed") == "max") {
        scenario->told_at.erase("run.speed");
        scenario->run.speed = std::numeric_limits<double>::infinity();
    }
    if (options.seed) scenario->run.seed = *options.seed;
    scenario->source += options_text(options);
    for (const auto& done : {apply_repeat(options, *scenario), check_outputs(*scenario)})
        if (!done) return fail(done.error());
    return scenario;
}

}  // namespace skyloop::host
