#include "run/emulator/assembly.hpp"

#include "detail/idle_entries.hpp"
#include "detail/modern_assembly.hpp"
#include "detail/receiver_assembly.hpp"
#include "detail/recorded_files.hpp"
#include "detail/run_warnings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "base/core/bytes.hpp"
#include "base/core/files.hpp"
#include "receiver/error_model/error_model.hpp"
#include "receiver/error_model/model_effects.hpp"
#include "run/emulator/load_scene.hpp"
#include "run/emulator/load_track.hpp"
#include "run/scenario/timeline_check.hpp"

namespace skyloop::inline run {
namespace {

ErrorModelSettings error_model_settings(const Scenario& scenario, const SimulationSetup& setup) {
    const ModelSettings& model = scenario.model;
    ErrorModelSettings settings;
    settings.kind = *model.sensor_model;
    settings.sensor = {{scenario.sky.elevation_mask.value_or(SelectionParameters().elevation_mask)},
                       receiver_seed(scenario.run, setup.receiver),
                       setup.geoid,
                       LeapSeconds::announced(),
                       setup.geoid_step_deg};
    settings.baseline = model.baseline;
    settings.constant_sigma = model.constant_sigma;
    settings.satellite_count = model.satellite_count;
    settings.refraction = model.refraction;
    return settings;
}

Result<WorldParts> sensor_parts_of(const Scenario& scenario, const SimulationSetup& setup) {
    EffectSettings settings;
    settings.atmosphere = scenario.atmosphere;
    settings.link_budget = scenario.model.link;
    settings.whole_path = scenario.model.whole_path;
    settings.refraction = scenario.model.refraction;
    settings.klobuchar = setup.navigation->klobuchar();
    settings.geoid = setup.geoid;
    if (const std::filesystem::path file = acting_ionosphere_maps(scenario); !file.empty()) {
        auto maps = load_ionosphere_maps(file);
        if (!maps) return fail(maps.error());
        settings.maps = std::move(*maps);
    }
    settings.tec_source_told_at = told_place(scenario, "atmosphere.tec_source", "atmosphere.tec_source");
    settings.run = span_of_tables(scenario, setup.start);
    auto effects = effects_for(*scenario.model.sensor_model, settings);
    if (!effects) return fail(effects.error());
    return WorldParts{std::move(*effects)};
}

bool city_acts(const Scenario& scenario) { return scenario.model.sensor_model || scenario.model.modern.errors; }

// Walls stand before the link budget, which is the last effect of every model.
const RayTracedScene* add_city(std::vector<std::unique_ptr<PropagationEffect>>& effects, const Scenario& scenario,
                               const SimulationSetup& setup) {
    if (!setup.scene || !city_acts(scenario)) return nullptr;
    auto city = std::make_unique<RayTracedScene>(setup.scene, scene_effect_settings(scenario, setup.epochs_per_second));
    const RayTracedScene* added = city.get();
    effects.insert(effects.end() - 1, std::move(city));
    return added;
}

// After the scenario's own walls, so that they may be made to stand where they do not.
void add_obstacles(std::vector<std::unique_ptr<PropagationEffect>>& effects, const SimulationSetup& setup) {
    if (setup.embedding == nullptr || !setup.embedding->obstacles) return;
    if (auto obstacles = setup.embedding->obstacles(setup.receiver))
        effects.insert(effects.end() - 1, std::move(obstacles));
}

// What stands around, and what its user should be told of it.
Result<void> add_scene(const Scenario& scenario, const DataFolders& data, Assembly& assembly) {
    const std::optional<Geodetic> place = scene_start(scenario, assembly.start);
    auto loaded = load_scene(scenario, place, CityCache{data.cache}, assembly.geoid.get());
    if (!loaded) return fail(loaded.error());
    if (loaded->scene && place)
        if (auto doubt = doubt_of_height(*loaded->scene, *place)) loaded->warnings.push_back(std::move(*doubt));
    assembly.scene = std::move(*loaded);
    const std::vector<std::string>& warnings = assembly.scene.warnings;
    assembly.warnings.insert(assembly.warnings.end(), warnings.begin(), warnings.end());
    return {};
}

Result<std::unique_ptr<LiveFeeds>> open_feeds(Scenario& scenario, const RunMode& mode, Assembly& assembly) {
    // A program that leads the run tells the truth itself.
    if (mode.only_checked || mode.embedding != nullptr) {
        if (const auto checked = LiveFeeds::check(scenario); !checked) return fail(checked.error());
        return nullptr;
    }
    auto feeds = LiveFeeds::open(scenario, assembly.geoid.get());
    if (!feeds || !*feeds) return feeds;
    if (mode.virtual_time)
        return fail(ErrorCode::usage,
                    "a live trajectory needs time that passes; expected skyloop run, without --speed max");
    if ((*feeds)->leads() && scenario.run.speed != 1)
        return fail(ErrorCode::usage,
                    fmt::format("{}is {:g}, and {}; expected one of them", told_place(scenario, "run.speed", "--speed"),
                                scenario.run.speed, (*feeds)->keeps_speed()));
    for (const CommandEntry& entry : scenario.commands)
        if (entry.command.verb == CommandVerb::speed && entry.command.source == "scenario" &&
            entry.command.parameters.number("factor") != 1)
            assembly.warnings.push_back(
                fmt::format("[[command]] '{}' will do nothing: {}", entry.when.name, (*feeds)->keeps_speed()));
    for (const std::string& source : (*feeds)->descriptions())
        assembly.details.push_back("live trajectory: " + source);
    return feeds;
}

std::vector<std::string> world_details(const NavigationSource& navigation, const Assembly& assembly) {
    std::vector<std::string> details{
        fmt::format("navigation: {}, {} satellites, {}", navigation.description(), navigation.satellites().size(),
                    navigation.klobuchar() ? "with ionosphere coefficients" : "without ionosphere coefficients"),
        fmt::format("geoid: {}", assembly.geoid ? "EGM96, 15 minutes" : "none")};
    if (!assembly.trajectory.empty()) details.push_back("trajectory: " + assembly.trajectory);
    for (const std::string& found : assembly.track_details)
        details.push_back("track: " + found);
    if (assembly.scene.scene)
        details.push_back(fmt::format("scene: {}{}", assembly.scene.description,
                                      assembly.scene.from_cache ? ", from the cache" : ""));
    return details;
}

std::string receiver_detail(const Station::Parts& parts) {
    const firmware::BoardProfile& board = parts.receiver.board();
    return fmt::format("receiver: {}, {} baud, {} sentences", board.name, first_baud(parts.receiver),
                       board.sentences.size());
}

std::unique_ptr<Pacer> make_pacer(const RunMode& mode, GpsTime start, double speed, const LiveFeeds* feeds) {
    if (feeds != nullptr && feeds->leads()) return std::make_unique<SourcePacer>(start);
    if (mode.embedding != nullptr || mode.virtual_time) return std::make_unique<VirtualPacer>(start);
    // A run that begins now keeps the wall clock's time; what loading took is not to shift it.
    return std::make_unique<RealtimePacer>(start, start == mode.now ? mode.now_steady_ns : steady_clock_ns(), speed);
}

// With the place of its key in the scenario's file, unless an option gave it.
WireEnd told_end(WireEnd end, const ReceiverEntry& entry, std::string_view key) {
    if (const auto place = entry.told_at.find(key); place != entry.told_at.end()) end.told_at = place->second;
    return end;
}

std::vector<WireEnd> ends_of(const std::vector<PlannedStation>& plans, const Scenario& scenario) {
    std::vector<WireEnd> ends;
    for (std::size_t i = 0; i < plans.size(); ++i) {
        const ReceiverEntry& entry = scenario.receivers[i];
        const std::string name = receiver_name(scenario, i);
        for (const WireRequest& wire : plans[i].wires)
            ends.push_back(told_end(end_of_wire(fmt::format("port of '{}'", name), wire.uri), entry, "port"));
        ends.push_back(told_end(end_of_power(fmt::format("power of '{}'", name), entry.power), entry, "power"));
    }
    for (const OutputSettings& output : scenario.outputs)
        ends.push_back(end_of_output(output));
    return ends;
}

SparedFiles spared_files_of(const SharedParts& shared) {
    SparedFiles spared{{}, shared.scenario.receivers.size()};
    for (InputFile& file : input_files(shared.scenario, shared.data, shared.mode.repeat))
        spared.inputs.push_back(std::move(file.path));
    return spared;
}

UsedReceiver used_receiver(const PlannedStation& plan, const Scenario& scenario) {
    const firmware::Receiver& receiver = plan.parts.receiver;
    std::vector<firmware::PortId> wired;
    for (const WireRequest& wire : plan.wires)
        wired.push_back(wire.port);
    return {receiver.board(), receiver.settings(), std::move(wired), !scenario.model.sensor_model};
}

// What the scenario asks of its boards in vain. Fails with `input` for faults of a judged run: a line each.
Result<void> judge_boards(const SharedParts& shared, const std::vector<PlannedStation>& plans, Assembly& assembly) {
    std::vector<UsedReceiver> receivers;
    for (const PlannedStation& plan : plans)
        receivers.push_back(used_receiver(plan, shared.scenario));
    const PlannedRun run{shared.scenario, *shared.navigation, receivers, shared.mode};
    IdleEntries entries = idle_entries(run);
    for (std::vector<std::string>& found :
         std::array{idle_key_warnings(run), std::move(entries.warnings), idle_expectation_warnings(run)})
        std::move(found.begin(), found.end(), std::back_inserter(assembly.warnings));
    if (entries.refused.empty()) return {};
    return fail(ErrorCode::input, fmt::format("{}", fmt::join(entries.refused, "\n")));
}

// All receivers, with their wires and recordings.
Result<std::vector<Station>> make_stations(const SharedParts& shared, Assembly& assembly) {
    std::vector<PlannedStation> plans;
    for (std::size_t i = 0; i < shared.scenario.receivers.size(); ++i) {
        auto plan = plan_station(shared, i, assembly.warnings);
        if (!plan) return fail(plan.error());
        assembly.details.push_back(receiver_detail(plan->parts));
        const firmware::Receiver& receiver = plan->parts.receiver;
        if (auto warning = limit_warning({shared.scenario, i, receiver.board(), receiver.settings().dynamic_model,
                                          assembly.start, assembly.end, shared.geoid}))
            assembly.warnings.push_back(std::move(*warning));
        plans.push_back(std::move(*plan));
    }
    if (const auto judged = judge_boards(shared, plans, assembly); !judged) return fail(judged.error());
    std::vector<WireEnd> ends = ends_of(plans, shared.scenario);
    const SparedFiles spared_files = spared_files_of(shared);
    if (const auto spared = spare_inputs_and_recording(ends, spared_files, shared.mode.record); !spared)
        return fail(spared.error());
    for (std::size_t i = 0; i < plans.size(); ++i) {
        const ReceiverEntry& entry = shared.scenario.receivers[i];
        const std::string owner = fmt::format("state_file of '{}'", receiver_name(shared.scenario, i));
        ends.push_back(told_end(end_of_state(owner, entry.state_file), entry, "state_file"));
    }
    if (const auto apart = check_ends(ends); !apart) return fail(apart.error());
    if (shared.mode.record)
        if (const auto spared = spare_inputs(spared_files, *shared.mode.record); !spared) return fail(spared.error());
    // Before anything is opened that another run may be using, too.
    for (std::size_t i = 0; i < plans.size() && shared.mode.record; ++i)
        if (const auto added = add_recorder(plans[i].parts, shared, i); !added) return fail(added.error());
    for (std::size_t i = 0; i < plans.size(); ++i)
        if (const auto checked = check_state(plans[i].parts, shared, i); !checked) return fail(checked.error());
    for (std::size_t i = 0; i < plans.size() && shared.mode.open_ports; ++i)
        if (i == 0 || !shared.mode.first_ports_only)
            if (const auto plugged = plug_in(plans[i], shared, i); !plugged) return fail(plugged.error());
    std::vector<Station> stations;
    for (PlannedStation& plan : plans)
        stations.emplace_back(std::move(plan.parts));
    return stations;
}

// What satellites send, and where they are.
Result<LoadedNavigation> load_sky(const Scenario& scenario, GpsTime now, const DataFolders& data) {
    auto loaded = load_navigation(scenario, now, data);
    if (!loaded) return loaded;
    if (const auto added = load_precise_truth(scenario, *loaded); !added) return fail(added.error());
    return loaded;
}

Result<void> judge_timeline(const Scenario& scenario, Assembly& assembly) {
    if (const auto checked = check_timeline(scenario, assembly.start); !checked) return fail(checked.error());
    if (!assembly.end) return {};
    for (std::string& warning : timeline_warnings(scenario, assembly.start, *assembly.end))
        assembly.warnings.push_back(std::move(warning));
    return {};
}

}  // namespace

std::string scenario_digest(const Scenario& scenario, const DataFolders& data, GpsTime start, std::uint64_t scene) {
    std::uint64_t digest = fnv1a_64(scenario.source);
    digest = fnv1a_64(fmt::format("start {} seed {}", start.time_since_epoch().count(), scenario.run.seed), digest);
    for (const InputFile& file : input_files(scenario, data))
        if (file.in_digest)
            if (const auto text = read_text_file(file.path)) digest = fnv1a_64(*text, digest);
    if (scene != 0) digest = fnv1a_64(fmt::format("scene {:016x}", scene), digest);
    return fmt::format("{:016x}", digest);
}

std::unique_ptr<Geoid> find_geoid(const DataFolders& data, std::vector<std::string>& warnings) {
    std::string reason = "no data folder";
    for (const auto& folder : data.folders) {
        auto geoid = Geoid::open(folder / "geoids" / "egm96-15.pgm");
        if (geoid) return std::make_unique<Geoid>(std::move(*geoid));
        if (reason == "no data folder") reason = geoid.error().message;
    }
    warnings.push_back(fmt::format("{}; heights above sea level are taken as heights above the ellipsoid", reason));
    return nullptr;
}

namespace {

void warn_of_surroundings(const ModernSettings& modern, std::vector<std::string>& warnings) {
    if (modern.propagation.channel_model.environment)
        warnings.push_back(
            fmt::format("model.modern.surroundings: '{}' adds no obstacles or echoes: the scene describes them",
                        surroundings_names[static_cast<std::size_t>(modern.surroundings)]));
    const auto& stretches = modern.propagation.stretches;
    if (std::any_of(stretches.begin(), stretches.end(),
                    [](const auto& s) { return s.channel.environment.has_value(); }))
        warnings.emplace_back("surroundings: only their covers act: the scene describes obstacles and echoes");
}

}  // namespace

std::vector<std::string> scenario_warnings(const Scenario& scenario, const Geoid* geoid) {
    std::vector<std::string> warnings = scenario.warnings;
    if (!scenario.model.sensor_model)
        warnings.insert(warnings.end(), scenario.model.modern.idle_keys.begin(), scenario.model.modern.idle_keys.end());
    for (std::string& warning : weather_warnings(scenario, geoid))
        warnings.push_back(std::move(warning));
    if (scenario.scene.given() && !city_acts(scenario))
        warnings.emplace_back("scene: errors = \"none\" leaves the buildings out, whose echoes are errors");
    if (scenario.scene.given() && !scenario.model.sensor_model) warn_of_surroundings(scenario.model.modern, warnings);
    return warnings;
}

ReceiverSettings receiver_settings(const Scenario& scenario, const firmware::BoardProfile& board, std::size_t index) {
    const ReceiverEntry& entry = scenario.receivers.at(index);
    ReceiverSettings settings;
    settings.elevation_mask = scenario.sky.elevation_mask.value_or(board.elevation_mask);
    settings.start = entry.start;
    settings.dynamic_model = entry.dynamic_model;
    settings.static_hold_below = entry.static_hold_below;
    for (const Constellation c : entry.constellations.empty() ? board.constellations : entry.constellations) {
        settings.signals.insert({c, first_signal(c)});
        if (!entry.dual_frequency && !board.dual_frequency) continue;
        if (const auto second = second_signal(c, board.second_band)) settings.signals.insert({c, *second});
    }
    return settings;
}

Result<Simulation> make_simulation(const Scenario& scenario, const SimulationSetup& setup) {
    auto world = scenario.model.sensor_model ? sensor_parts_of(scenario, setup) : modern_parts_of(scenario, setup);
    if (!world) return fail(world.error());
    auto path = make_antenna_path(scenario, setup);
    const auto last_place = place_before_start(scenario, setup.receiver, path->at(setup.start));
    FixMaker fix_maker = scenario.model.sensor_model ? FixMaker(make_error_model(error_model_settings(scenario, setup)))
                                                     : FixMaker(measuring_receiver(scenario, setup, last_place));
    const RayTracedScene* city = add_city(world->effects, scenario, setup);
    add_obstacles(world->effects, setup);
    return Simulation({std::move(path), setup.navigation, std::move(world->effects), std::move(fix_maker), city,
                       setup.osnma, setup.precise, std::move(world->sbas)});
}

std::vector<std::filesystem::path> board_folders(const DataFolders& data) {
    std::vector<std::filesystem::path> folders;
    for (const auto& folder : data.folders)
        folders.push_back(folder / "boards");
    return folders;
}

namespace {

// What is known once the orbits are: the start, and which files have them.
void take_navigation(const LoadedNavigation& loaded, Scenario& scenario, Assembly& assembly) {
    assembly.warnings.insert(assembly.warnings.end(), loaded.warnings.begin(), loaded.warnings.end());
    assembly.notes = loaded.notes;
    assembly.start = loaded.start;
    scenario.sky.navigation = loaded.files;
}

}  // namespace

Result<Assembly> assemble(const Scenario& asked, const DataFolders& data, const RunMode& mode) {
    Scenario scenario = asked;
    Assembly assembly;
    auto navigation = load_sky(scenario, mode.now, data);
    if (!navigation) return fail(navigation.error());
    assembly.geoid = find_geoid(data, navigation->warnings);
    assembly.warnings = scenario_warnings(scenario, assembly.geoid.get());
    take_navigation(*navigation, scenario, assembly);
    const auto track = load_track(scenario, assembly.geoid.get(), assembly.start);
    if (!track) return fail(track.error());
    if (track->end && (!scenario.run.duration || *track->end < advanced(assembly.start, *scenario.run.duration)))
        scenario.run.duration = difference(*track->end, assembly.start);
    if (scenario.run.duration) assembly.end = advanced(assembly.start, *scenario.run.duration);
    assembly.warnings.insert(assembly.warnings.end(), track->warnings.begin(), track->warnings.end());
    if (const auto checked = judge_timeline(scenario, assembly); !checked) return fail(checked.error());
    assembly.trajectory = track->description;
    assembly.track_details = track->details;
    auto feeds = open_feeds(scenario, mode, assembly);
    if (!feeds) return fail(feeds.error());
    assembly.place = make_trajectory(trajectory_of(scenario, 0), assembly.start)->at(assembly.start).geodetic;
    if (const auto added = add_scene(scenario, data, assembly); !added) return fail(added.error());
    assembly.digest = scenario_digest(scenario, data, assembly.start, assembly.scene.digest);
    for (std::string& detail : world_details(*navigation->source, assembly))
        assembly.details.push_back(std::move(detail));

    auto stations = make_stations({scenario, data, mode, std::move(navigation->source), assembly.geoid.get(),
                                   assembly.start, assembly.scene.scene, navigation->precise},
                                  assembly);
    if (!stations) return fail(stations.error());
    if (auto warning = warning_of_last_map(scenario)) assembly.warnings.push_back(std::move(*warning));
    assembly.details.push_back(fmt::format("digest: {}", assembly.digest));
    // The pacer comes last, so that the clock starts when everything else is ready.
    assembly.emulator = std::make_unique<Emulator>(
        Emulator::Parts{std::move(*stations), make_pacer(mode, assembly.start, scenario.run.speed, feeds->get()),
                        Director(Director::Parts{scenario.faults, scenario.commands, assembly.start, scenario.run.seed,
                                                 scenario.run.speed, mode.live_commands,
                                                 std::string(*feeds ? (*feeds)->keeps_speed() : "")}),
                        std::move(*feeds)},
        assembly.start);
    return assembly;
}

}  // namespace skyloop::inline run
