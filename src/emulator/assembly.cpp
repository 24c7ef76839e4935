#include "skyloop/emulator/assembly.hpp"

#include "modern_assembly.hpp"
#include "rinex_recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "skyloop/base/digest.hpp"
#include "skyloop/base/spelling.hpp"
#include "skyloop/base/text_file.hpp"
#include "skyloop/error_model/make_error_model.hpp"
#include "skyloop/error_model/model_effects.hpp"
#include "skyloop/scenario/board_file.hpp"
#include "skyloop/transport/open_transport.hpp"

namespace skyloop {
namespace {

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
// Clang 14 does not yet deduce it for aggregates.
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

ErrorModelSettings error_model_settings(const Scenario& scenario, const Geoid* geoid) {
    const ModelSettings& model = scenario.model;
    ErrorModelSettings settings;
    settings.kind = *model.sensor_model;
    settings.sensor = {{scenario.sky.elevation_mask.value_or(SelectionParameters().elevation_mask)},
                       scenario.run.seed,
                       geoid,
                       LeapSeconds::announced()};
    settings.baseline = model.baseline;
    settings.constant_sigma = model.constant_sigma;
    settings.satellite_count = model.satellite_count;
    settings.refraction = model.refraction;
    return settings;
}

EffectSettings effect_settings(const Scenario& scenario, const NavigationSource& navigation, const Geoid* geoid) {
    EffectSettings settings;
    settings.atmosphere = scenario.atmosphere;
    settings.link_budget = scenario.model.link;
    settings.whole_path = scenario.model.whole_path;
    settings.refraction = scenario.model.refraction;
    settings.klobuchar = navigation.klobuchar();
    settings.geoid = geoid;
    return settings;
}

Result<firmware::Receiver> make_receiver(const Scenario& scenario, const DataFolders& data,
                                         std::vector<std::string>& warnings) {
    const ReceiverEntry& entry = scenario.receiver;
    auto board = find_board(entry.board, board_folders(data));
    if (!board) return fail(board.error());
    if (entry.baud) board->baud = *entry.baud;
    if (!entry.constellations.empty()) board->constellations = entry.constellations;
    if (!entry.sentences.empty()) board->sentences.clear();
    for (const firmware::NmeaSentence sentence : entry.sentences)
        board->sentences.push_back({sentence, 1});
    const double rate = entry.rate_hz.value_or(board->default_rate_hz);
    if (rate > board->max_rate_hz)
        warnings.push_back(
            fmt::format("{:g} Hz is more than {} can do; it runs at {:g} Hz", rate, board->name, board->max_rate_hz));
    ReceiverSettings settings = receiver_settings(scenario, *board);
    for (const Constellation c : scenario.sky.constellations)
        if (!scenario.model.sensor_model && !settings.tracks(c, first_signal(c)))
            warnings.push_back(
                fmt::format("{} does not track {}, which sky.constellations names; receiver.constellations tells it to",
                            board->name, constellation_name(c)));
    firmware::Receiver receiver(std::move(*board), rate, std::move(settings));
    const double actual = 1e9 / static_cast<double>(receiver.settings().navigation_period.count());
    if (rate < 0.99 * actual)
        warnings.push_back(fmt::format("{:g} Hz is less than a receiver can do; it runs at {:.4g} Hz", rate, actual));
    return receiver;
}

std::vector<std::string> run_details(const NavigationSource& navigation, const firmware::Receiver& receiver,
                                     const Assembly& assembly) {
    return {fmt::format("navigation: {}, {} satellites, {}", navigation.description(), navigation.satellites().size(),
                        navigation.klobuchar() ? "with ionosphere coefficients" : "without ionosphere coefficients"),
            fmt::format("geoid: {}", assembly.geoid ? "EGM96, 15 minutes" : "none"),
            fmt::format("receiver: {}, {} baud, {} sentences", receiver.board().name, receiver.baud(),
                        receiver.board().sentences.size()),
            fmt::format("digest: {}", assembly.digest)};
}

RinexRecordingSetup rinex_setup(const Emulator::Parts& parts, GpsTime start) {
    const ReceiverSettings& settings = parts.receiver.settings();
    const NavigationSource& navigation = parts.simulation.navigation();
    RinexRecordingSetup setup;
    setup.observations.approximate_position = parts.simulation.truth_at(start).position;
    setup.observations.interval = Seconds(static_cast<double>(settings.navigation_period.count()) * 1e-9);
    setup.observations.first_epoch = start;
    setup.observations.receiver = parts.receiver.board().name;
    for (const SatelliteId satellite : navigation.satellites()) {
        const Constellation c = satellite.constellation;
        if (!setup.observations.signals.contains(c))
            for (const Signal signal : emulated_signals(c))
                if (settings.tracks(c, signal)) setup.observations.signals[c].push_back(signal);
        const auto record = navigation.ephemeris(satellite, start);
        if (const auto* glonass = record ? std::get_if<GlonassEphemeris>(&*record) : nullptr)
            setup.observations.glonass_channels[satellite.number] = glonass->frequency_channel;
    }
    setup.navigation.ionosphere = navigation.ionosphere();
    setup.navigation.leap_seconds = LeapSeconds::announced().offset(start);
    setup.navigation.date = start;
    return setup;
}

Result<Recorder> make_recorder(const std::filesystem::path& folder, const Emulator::Parts& parts, GpsTime start) {
    auto recorder = Recorder::create(folder);
    if (!recorder || !parts.simulation.measures()) return recorder;
    if (const auto added = recorder->add_rinex(rinex_setup(parts, start)); !added) return fail(added.error());
    return recorder;
}

Result<std::vector<Link>> open_links(const ReceiverEntry& entry, std::uint32_t baud, bool virtual_time) {
    std::vector<Link> links;
    const std::vector<std::string> uris = entry.ports.empty() ? std::vector<std::string>{"pty"} : entry.ports;
    for (const std::string& uri : uris) {
        auto transport = open_transport(uri);
        if (!transport) return fail(transport.error());
        if (virtual_time) (*transport)->allow_waiting();
        links.emplace_back(std::move(*transport), baud);
    }
    return links;
}

}  // namespace

std::string scenario_digest(const Scenario& scenario, GpsTime start) {
    std::uint64_t digest = fnv1a_64(scenario.source);
    digest = fnv1a_64(fmt::format("start {} seed {}", start.time_since_epoch().count(), scenario.run.seed), digest);
    for (const auto& file : scenario.sky.navigation)
        if (const auto text = read_text_file(file)) digest = fnv1a_64(*text, digest);
    return fmt::format("{:016x}", digest);
}

std::unique_ptr<Trajectory> make_trajectory(const TrajectorySettings& settings, GpsTime start) {
    return std::visit(Overloaded{
                          [](const FixedSettings& fixed) -> std::unique_ptr<Trajectory> {
                              return std::make_unique<FixedPoint>(fixed.at);
                          },
                          [&](const WaypointSettings& path) -> std::unique_ptr<Trajectory> {
                              return std::make_unique<Waypoints>(start, path.corners);
                          },
                          [&](const CircleSettings& circle) -> std::unique_ptr<Trajectory> {
                              return std::make_unique<Circle>(start, circle.shape);
                          },
                      },
                      settings);
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

std::vector<std::string> scenario_warnings(const Scenario& scenario) {
    std::vector<std::string> warnings = scenario.warnings;
    if (!scenario.model.sensor_model && !scenario.sensor_model_keys.empty())
        warnings.push_back(
            fmt::format("atmosphere.{}: of the sensor models; the modern model takes clouds and rain from [atmosphere] "
                        "and the rest from [model.modern]",
                        fmt::join(scenario.sensor_model_keys, ", atmosphere.")));
    return warnings;
}

ReceiverSettings receiver_settings(const Scenario& scenario, const firmware::BoardProfile& board) {
    const ReceiverEntry& entry = scenario.receiver;
    ReceiverSettings settings;
    settings.elevation_mask = scenario.sky.elevation_mask.value_or(board.elevation_mask);
    settings.start = entry.start;
    settings.dynamic_model = entry.dynamic_model;
    settings.static_hold_below = entry.static_hold_below;
    for (const Constellation c : entry.constellations.empty() ? board.constellations : entry.constellations) {
        const auto signals = emulated_signals(c);
        settings.signals.insert({c, signals[0]});
        if (entry.dual_frequency && signals.size() > 1) settings.signals.insert({c, signals[1]});
    }
    return settings;
}

Result<Simulation> make_simulation(const Scenario& scenario, std::unique_ptr<NavigationSource> navigation,
                                   const Geoid* geoid, GpsTime start, const DataFolders& data) {
    auto effects = scenario.model.sensor_model
                       ? effects_for(*scenario.model.sensor_model, effect_settings(scenario, *navigation, geoid))
                       : modern_effects_of(scenario, *navigation, {geoid, start, data});
    if (!effects) return fail(effects.error());
    FixMaker fix_maker = scenario.model.sensor_model ? FixMaker(make_error_model(error_model_settings(scenario, geoid)))
                                                     : FixMaker(measuring_receiver(scenario, *navigation, geoid));
    return Simulation({make_trajectory(scenario.trajectory, start), std::move(navigation), std::move(*effects),
                       std::move(fix_maker)});
}

std::vector<std::filesystem::path> board_folders(const DataFolders& data) {
    std::vector<std::filesystem::path> folders;
    for (const auto& folder : data.folders)
        folders.push_back(folder / "boards");
    return folders;
}

Result<void> check_port_names(const Scenario& scenario) {
    for (const std::string& uri : scenario.receiver.ports)
        if (const auto port = parse_port_uri(uri); !port) return fail(port.error());
    return {};
}

Result<Assembly> assemble(const Scenario& scenario, const DataFolders& data, const RunMode& mode) {
    Assembly assembly;
    assembly.warnings = scenario_warnings(scenario);
    auto navigation = load_navigation(scenario, mode.now);
    if (!navigation) return fail(navigation.error());
    assembly.warnings.insert(assembly.warnings.end(), navigation->warnings.begin(), navigation->warnings.end());
    assembly.geoid = find_geoid(data, assembly.warnings);
    assembly.start = navigation->start;
    if (scenario.run.duration) assembly.end = advanced(assembly.start, *scenario.run.duration);
    assembly.digest = scenario_digest(scenario, assembly.start);

    auto simulation =
        make_simulation(scenario, std::move(navigation->source), assembly.geoid.get(), assembly.start, data);
    if (!simulation) return fail(simulation.error());
    auto receiver = make_receiver(scenario, data, assembly.warnings);
    if (!receiver) return fail(receiver.error());
    assembly.details = run_details(simulation->navigation(), *receiver, assembly);
    Emulator::Parts parts{std::move(*simulation), std::move(*receiver), {}, nullptr, std::nullopt};
    if (mode.open_ports) {
        auto links = open_links(scenario.receiver, parts.receiver.baud(), mode.virtual_time);
        if (!links) return fail(links.error());
        parts.links = std::move(*links);
    }
    // After everything that may be refused: it empties the files of a former recording.
    if (mode.record) {
        auto recorder = make_recorder(*mode.record, parts, assembly.start);
        if (!recorder) return fail(recorder.error());
        parts.recorder = std::move(*recorder);
    }
    // Last, so that the clock starts when everything else is ready.
    if (mode.virtual_time)
        parts.pacer = std::make_unique<VirtualPacer>(assembly.start);
    else
        parts.pacer = std::make_unique<RealtimePacer>(
            // A run that begins now keeps the wall clock's time; what loading took is not to shift it.
            assembly.start, assembly.start == mode.now ? mode.now_steady_ns : steady_clock_ns(), scenario.run.speed);
    assembly.emulator = std::make_unique<Emulator>(std::move(parts), assembly.start);
    return assembly;
}

}  // namespace skyloop
