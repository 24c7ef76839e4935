#include "run_options.hpp"
#include "data_folders.hpp"
#include "run_log.hpp"
#include "run_session.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>

#include "base/core/spelling.hpp"
#include "base/core/text_file.hpp"
#include "base/time/utc_time.hpp"
#include "run/emulator/scenario_mistakes.hpp"
#include "run/scenario/scenario_changes.hpp"
#include "run/scenario/scenario_file.hpp"
#include "wire/transport/open_transport.hpp"

namespace skyloop::host {
namespace {

Result<void> apply_place(const RunOptions& options, Scenario& scenario) {
    if (!options.at.empty() && !options.trajectory.empty())
        return fail(ErrorCode::usage, "--at and --trajectory both say where the antenna is; expected one of them");
    if (!options.at.empty()) {
        const auto place = parse_place(options.at);
        if (!place) return fail(place.error());
        scenario.trajectory = FixedSettings{*place};
    }
    if (options.trajectory.empty()) return {};
    const std::filesystem::path file = options.trajectory;
    if (file.extension() != ".toml") {
        FileSettings track;
        track.path = file;
        scenario.trajectory = track;
        return {};
    }
    auto trajectory = read_trajectory_file(file, scenario.warnings);
    if (!trajectory) return fail(trajectory.error());
    scenario.trajectory = std::move(*trajectory);
    scenario.trajectory_file = file;
    // For the digest: the file's name alone does not say what it holds.
    if (const auto text = read_text_file(file)) scenario.source += "\n" + *text;
    return {};
}

// --loop, --time-scale and --skip of a recorded track.
Result<void> apply_playback(const RunOptions& options, Scenario& scenario) {
    const std::string_view given = options.loop         ? "--loop"
                                   : options.time_scale ? "--time-scale"
                                   : options.skip_s     ? "--skip"
                                                        : "";
    if (given.empty()) return {};
    auto* file = std::get_if<FileSettings>(&scenario.trajectory);
    if (!file)
        return fail(ErrorCode::usage, fmt::format("{}: expected --trajectory TRACK, or a trajectory of kind \"file\" "
                                                  "in the scenario",
                                                  given));
    if (options.loop) file->playback.end = EndOfPath::loop;
    if (options.time_scale && !(*options.time_scale >= 1e-3 && *options.time_scale <= 1e3))
        return fail(ErrorCode::usage, fmt::format("--time-scale {}: expected 0.001 to 1000", *options.time_scale));
    if (options.skip_s && !(*options.skip_s >= 0 && *options.skip_s <= 1e9))
        return fail(ErrorCode::usage, fmt::format("--skip {}: expected seconds, 0 to 1e9", *options.skip_s));
    file->playback.time_scale = options.time_scale.value_or(file->playback.time_scale);
    if (options.skip_s) file->playback.skip = Seconds(*options.skip_s);
    return {};
}

// A repeated run begins when the recorded one did: what it heard and was told has its instants from then on. The option
// may be there, as all that changed that run.
Result<void> apply_start(const RunOptions& options, RunSettings& run) {
    if (options.start.empty()) return {};
    std::optional<GpsTime> start;
    if (options.start != "now") {
        const auto utc = parse_instant(options.start);
        if (!utc) return fail(ErrorCode::usage, "--start: " + utc.error().message + ", or now");
        start = to_gps_time(*utc, LeapSeconds::announced());
    }
    if (options.repeat.empty()) {
        run.start = start;
        run.start_now = !start;
    } else if (start && start != run.start) {
        return fail(
            ErrorCode::usage,
            fmt::format("--start {}: the run of --repeat {} began at another time; expected that, or no --start",
                        options.start, options.repeat));
    }
    return {};
}

Result<void> apply_time(const RunOptions& options, Scenario& scenario) {
    if (const auto applied = apply_start(options, scenario.run); !applied) return applied;
    if (options.duration) {
        if (!(*options.duration > 0 && *options.duration <= longest_run_s))
            return fail(ErrorCode::usage, fmt::format("--duration {}: expected a number above 0, up to {}",
                                                      *options.duration, longest_run_s));
        scenario.run.duration = Seconds(*options.duration);
    }
    return {};
}

Result<void> apply_model(const RunOptions& options, Scenario& scenario) {
    if (options.model.empty()) return {};
    if (choose_model(scenario.model, options.model)) return {};
    return fail(ErrorCode::usage,
                fmt::format("--model {}: unknown; expected one of {}{}", options.model, fmt::join(model_names(), " "),
                            did_you_mean(options.model, model_names())));
}

Result<void> apply_receiver(const RunOptions& options, Scenario& scenario) {
    ReceiverEntry& first = scenario.receivers.front();
    const std::array<std::pair<const char*, bool>, 4> given{{{"board", !options.board.empty()},
                                                             {"port", !options.ports.empty()},
                                                             {"power", !options.power.empty()},
                                                             {"state_file", !options.state.empty()}}};
    for (const auto& [key, by_option] : given)
        if (by_option) first.told_at.erase(key);
    if (!options.board.empty()) first.board = options.board;
    if (!options.ports.empty()) first.ports = options.ports;
    if (!options.state.empty()) first.state_file = options.state;
    if (!options.power.empty()) first.power = options.power;
    if (options.rate) {
        if (!(*options.rate >= 0.01 && *options.rate <= 100))
            return fail(ErrorCode::usage, fmt::format("--rate {}: expected 0.01 to 100 Hz", *options.rate));
        first.rate_hz = options.rate;
        first.told_at.erase("rate_hz");
    }
    return {};
}

Result<void> apply_outputs(const RunOptions& options, Scenario& scenario) {
    if (!options.outputs.empty()) scenario.outputs.clear();
    for (const std::string& uri : options.outputs) {
        auto output = parse_output_uri(uri);
        if (!output) return fail(ErrorCode::usage, "--output: " + output.error().message);
        scenario.outputs.push_back(std::move(*output));
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i)
        names.push_back(receiver_name(scenario, i));
    for (const OutputSettings& output : scenario.outputs)
        if (const auto chosen = told_receivers(output, names); !chosen) return fail(chosen.error());
    return {};
}

Result<void> apply_speed(const RunOptions& options, Scenario& scenario) {
    if (options.speed.empty()) return {};
    scenario.told_at.erase("run.speed");
    if (options.speed == "max") {
        scenario.run.speed = std::numeric_limits<double>::infinity();
        return {};
    }
    double speed = 0;
    const char* end = options.speed.data() + options.speed.size();
    const auto [rest, error] = std::from_chars(options.speed.data(), end, speed);
    if (error != std::errc() || rest != end || !(speed >= 1e-3 && speed <= 1e6))
        return fail(
            ErrorCode::usage,
            fmt::format("--speed {}: expected simulated seconds per second, 0.001 to 1000000, or max", options.speed));
    scenario.run.speed = speed;
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

// The options that decide what a run computes, one a line.
std::string options_text(const RunOptions& o) {
    std::string text;
    for (const auto& [name, value] : {std::pair{"at", o.at},
                                      {"trajectory", o.trajectory},
                                      {"start", o.start},
                                      {"model", o.model},
                                      {"scene", o.scene},
                                      {"board", o.board}})
        if (!value.empty()) text += fmt::format("\n--{} {}", name, value);
    if (o.rebase_nav) text += "\n--rebase-nav";
    if (o.loop) text += "\n--loop";
    if (o.time_scale) text += fmt::format("\n--time-scale {}", *o.time_scale);
    if (o.skip_s) text += fmt::format("\n--skip {}", *o.skip_s);
    if (o.duration) text += fmt::format("\n--duration {}", *o.duration);
    if (o.rate) text += fmt::format("\n--rate {}", *o.rate);
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
    std::vector<ScenarioChange> changes;
    for (const std::string& setting : settings) {
        auto change = parse_change(setting);
        if (!change) return fail(change.error().code, "--set " + change.error().message);
        changes.push_back(std::move(*change));
    }
    if (file.empty() && changes.empty()) return Scenario();
    ScenarioReading reading =
        file.empty() ? read_with_mistakes("", "--set", changes) : read_file_with_mistakes(file, changes);
    if (!reading.mistakes) return std::move(reading.scenario);
    if (reading.scenario.source.empty()) return fail(*reading.mistakes);
    Error mistakes = with_other_mistakes(*reading.mistakes, reading.scenario, data_folders(), wall_clock());
    return fail(ErrorCode::input, std::move(mistakes.message));
}

void add_place_options(CLI::App& command, RunOptions& options) {
    command.add_option("--at", options.at,
                       "Stand still there: LAT,LON[,HEIGHT] in degrees and metres above the ellipsoid");
    command
        .add_option("--nav", options.nav,
                    "RINEX navigation file or almanac; repeatable; without it a nominal constellation")
        ->allow_extra_args(false);
    command.add_flag("--rebase-nav", options.rebase_nav,
                     "Move the navigation data to the start time, keeping its time of day");
    command.add_option("--start", options.start,
                       "ISO 8601 in UTC, or now; default now, with --nav when four satellites first have orbits");
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
    command.add_flag("--loop", options.loop, "The track begins anew at its end");
    command.add_option("--time-scale", options.time_scale, "Seconds of the track in one second of the run");
    command.add_option("--skip", options.skip_s, "Seconds of the track that are left out at its beginning");
    command.add_option("--duration", options.duration, "Seconds");
    command.add_option("--model", options.model, fmt::format("{}; default modern", fmt::join(model_names(), " ")));
    add_scene_option(command, options);
    command.add_option("--board", options.board, "Receiver profile, default ublox-m8; see skyloop boards");
    command.add_option("--rate", options.rate, "Navigation rate at start, Hz");
    command
        .add_option("--port", options.ports,
                    fmt::format("Where the bytes go: {} - client:NAME; NAME=… is the board's port of that name, such "
                                "as uart2=pty; repeatable",
                                fmt::join(port_shapes(), " ")))
        ->allow_extra_args(false);
    command
        .add_option("--output", options.outputs,
                    "What is told beside the ports: gps-input:HOST:PORT hil-gps:HOST:PORT msp-tcp:[HOST:]PORT "
                    "msp-tcp-to:HOST:PORT json-udp:HOST:PORT json-tcp:[HOST:]PORT json-file:PATH, then ,KEY=VALUE; "
                    "repeatable")
        ->allow_extra_args(false);
    command.add_option("--power", options.power,
                       "What the fault power_cut switches in a live run: relay:VID:PID/N gpio:VID:PID/N hub:PORT_PATH "
                       "line:DEVICE/rts line:DEVICE/dtr command:CUT|RESTORE");
    command.add_option("--state", options.state, "File that keeps what the receiver saves beyond the run");
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
    auto read = scenario_with(options.scenario, options.settings);
    if (!read) return fail(read.error());
    Scenario scenario = std::move(*read);
    if (!options.nav.empty()) {
        scenario.sky.navigation.assign(options.nav.begin(), options.nav.end());
        scenario.told_at.erase("sky.navigation");
    }
    if (options.rebase_nav) {
        scenario.sky.rebase_navigation = true;
        scenario.told_at.erase("sky.rebase_navigation");
    }
    if (!options.scene.empty()) {
        scenario.scene.buildings = {options.scene};
        scenario.told_at.erase("scene.buildings");
    }
    if (options.seed) scenario.run.seed = *options.seed;
    if (!options.repeat.empty())
        if (const auto repeated = repeat_run(options.repeat, scenario); !repeated) return fail(repeated.error());
    scenario.source += options_text(options);
    for (const auto& apply :
         {apply_place, apply_playback, apply_time, apply_model, apply_receiver, apply_outputs, apply_speed})
        if (const auto applied = apply(options, scenario); !applied) return fail(applied.error());
    return scenario;
}

}  // namespace skyloop::host
