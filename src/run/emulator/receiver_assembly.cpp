#include "detail/receiver_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "base/core/bytes.hpp"
#include "base/core/files.hpp"
#include "detail/recorded_files.hpp"
#include "detail/recording_formats.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "run/client/open_client.hpp"
#include "run/scenario/board_files.hpp"
#include "wire/actuator/actuator_uri.hpp"
#include "wire/transport/open_transport.hpp"

namespace skyloop::inline run {
namespace {

Result<firmware::BoardProfile> board_of(const ReceiverEntry& entry, const DataFolders& data) {
    auto board = find_board(entry.board, board_folders(data));
    if (!board) return fail(board.error());
    if (const auto speed = speed_of_wires(entry); speed || entry.baud) board->baud = speed ? *speed : *entry.baud;
    if (entry.export_limits) board->export_limits = *entry.export_limits;
    if (entry.latency) board->solution_latency = *entry.latency;
    if (!entry.constellations.empty()) board->constellations = entry.constellations;
    if (!entry.sentences.empty()) board->sentences.clear();
    for (const firmware::NmeaSentence sentence : entry.sentences)
        board->sentences.push_back({sentence, 1});
    return board;
}

// What a sentence about a key begins with: its place in the scenario's file; nothing where none has it.
std::string place_of(std::string_view key, const ToldPlaces& places) {
    const auto place = places.find(key);
    return place == places.end() ? std::string() : place->second;
}

void warn_of_untracked(const Scenario& scenario, const firmware::BoardProfile& board, const ReceiverSettings& settings,
                       std::vector<std::string>& warnings) {
    if (scenario.model.sensor_model) return;
    for (const Constellation c : scenario.sky.constellations)
        if (!settings.tracks(c, first_signal(c)))
            warnings.push_back(fmt::format(
                "{}{} does not track {}, which sky.constellations names; receiver.constellations tells it to",
                place_of("sky.constellations", scenario.told_at), board.name, constellation_name(c)));
}

void warn_of_rate(const ReceiverEntry& entry, const firmware::Receiver& receiver, std::vector<std::string>& warnings) {
    const firmware::BoardProfile& board = receiver.board();
    const double asked = *entry.rate_hz;
    const std::string place = place_of("rate_hz", entry.told_at);
    if (asked > board.max_rate_hz)
        warnings.push_back(fmt::format("{}{:g} Hz is more than {} can do; it runs at {:g} Hz", place, asked, board.name,
                                       board.max_rate_hz));
    const double actual = 1e9 / static_cast<double>(receiver.settings().navigation_period.count());
    if (asked < 0.99 * actual)
        warnings.push_back(
            fmt::format("{}{:g} Hz is less than a receiver can do; it runs at {:.4g} Hz", place, asked, actual));
}

void warn_of_missing_usb(const std::vector<WireRequest>& wires, const firmware::BoardProfile& board,
                         const ReceiverEntry& entry, std::vector<std::string>& warnings) {
    for (const WireRequest& wire : wires) {
        if (!wire.uri.starts_with("usbip:") || (wire.port == firmware::PortId::usb && board.usb)) continue;
        warnings.push_back(fmt::format(
            "{}{}: {}; it shows {} behind a generic serial adapter, {}", place_of("port", entry.told_at), wire.uri,
            board.usb ? "this is not the board's USB port" : board.name + " has no USB of its own",
            firmware::port_names[static_cast<std::size_t>(wire.port)], to_string(UsbFace{}.ids)));
    }
}

// Of a slot that has no record yet, as in the file of a single station, the channel of the first one in the day ahead.
std::optional<int> glonass_channel(const NavigationSource& navigation, SatelliteId slot, GpsTime start) {
    constexpr std::chrono::minutes spacing{15};  // half the validity of a record
    for (GpsTime time = start; time <= start + std::chrono::days(1); time += spacing) {
        const auto record = navigation.ephemeris(slot, time);
        if (record) return std::get<GlonassEphemeris>(*record).frequency_channel;
    }
    return std::nullopt;
}

RinexRecordingSetup rinex_setup(const Station::Parts& parts, GpsTime start) {
    const ReceiverSettings& settings = parts.receiver.settings();
    const NavigationSource& navigation = parts.simulation.navigation();
    RinexRecordingSetup setup;
    setup.observations.approximate_position = parts.simulation.truth_at(start).position;
    setup.observations.interval = to_seconds(settings.navigation_period);
    setup.observations.first_epoch = start;
    setup.observations.receiver = parts.receiver.board().name;
    for (const SatelliteId satellite : navigation.satellites()) {
        const Constellation c = satellite.constellation;
        if (!setup.observations.signals.contains(c))
            for (const Signal signal : emulated_signals(c))
                if (settings.tracks(c, signal)) setup.observations.signals[c].push_back(signal);
        if (c != Constellation::glonass) continue;
        if (const auto channel = glonass_channel(navigation, satellite, start))
            setup.observations.glonass_channels[satellite.number] = *channel;
    }
    setup.navigation.ionosphere = navigation.ionosphere();
    setup.navigation.leap_seconds = LeapSeconds::announced().offset(start);
    setup.navigation.date = start;
    return setup;
}

Result<std::vector<HeardBytes>> repeated_input(const std::filesystem::path& folder, std::size_t index,
                                               const std::vector<WireRequest>& wires,
                                               const firmware::BoardProfile& board) {
    std::vector<firmware::PortId> ports;
    for (const WireRequest& wire : wires)
        ports.push_back(wire.port);
    if (ports.empty()) ports.push_back(default_port(board));
    return read_repeated_input(recording_of(folder, index), ports);
}

// What a key of the scenario's file is refused for, with its place there.
Error at_key(std::string_view key, Error error, const ReceiverEntry& entry) {
    error.message = place_of(key, entry.told_at) + error.message;
    return error;
}

// The keys of the scenario that change what the board begins with, judged as the board's file is.
Result<void> check_options(const firmware::BoardProfile& board, const firmware::ReceiverOptions& options,
                           const ReceiverEntry& entry) {
    const auto refused = firmware::refused_options(board, options);
    if (!refused) return {};
    std::string_view key = entry.constellations.empty() ? "dual_frequency" : "constellations";
    if (refused->item) key = *refused->item == firmware::key::uart1_baudrate ? "baud" : "rate_hz";
    return fail(at_key(key, {ErrorCode::usage, refused->reason}, entry));
}

// What is known of the actuator before it is opened.
Result<void> check_power(const SharedParts& shared, std::size_t index, std::vector<std::string>& warnings) {
    const std::vector<ReceiverEntry>& receivers = shared.scenario.receivers;
    const std::string& power = receivers[index].power;
    if (power.empty()) return {};
    const auto refused = [&](Error error) { return fail(at_key("power", std::move(error), receivers[index])); };
    const auto known = parse_actuator_uri(power);
    if (!known) return refused(known.error());
    for (std::size_t i = 0; i < index; ++i) {
        const auto other = parse_actuator_uri(receivers[i].power);
        if (!other || !may_be_one_switch(*known, *other)) continue;
        const bool same = receivers[i].power == power;
        return refused({ErrorCode::usage, fmt::format("power '{}' {} that of {} too{}; expected an actuator of its own",
                                                      power, same ? "is" : "may be", receiver_name(shared.scenario, i),
                                                      same ? "" : fmt::format(", '{}'", receivers[i].power))});
    }
    if (shared.mode.virtual_time)
        warnings.push_back(fmt::format(
            "{}{}: skyloop run switches it, at the clock's pace; in virtual time nothing does",
            receivers[index].told_at.contains("power") ? place_of("power", receivers[index].told_at) : "power ",
            power));
    return {};
}

// A place in the scenario's file tells which receiver it is, or that it is of all.
Error of_named_receiver(Error error, const Scenario& scenario, std::size_t index) {
    const bool placed = error.message.starts_with(scenario.name + ":");
    return placed ? error : of_receiver(std::move(error), scenario, index);
}

// Opened, and the power on.
Result<std::unique_ptr<PowerSwitch>> power_of(const std::string& uri, const SharedParts& shared, std::size_t index) {
    auto power = PowerSwitch::start({uri, [uri] { return open_actuator(uri); }, shared.mode.power_watchdog, index});
    if (!power) return fail(power.error().code, fmt::format("power {}: {}", uri, power.error().message));
    return power;
}

Result<Link> open_wire(const WireRequest& wire, const firmware::Receiver& receiver, const SharedParts& shared,
                       std::size_t index) {
    const PortSpeed speed = port_speed(receiver, wire.port);
    if (const Embedding* const leads = shared.mode.embedding; leads != nullptr && leads->open_wire)
        if (auto led = leads->open_wire(index, wire)) return Link(std::move(led), speed, InputPace::at_once);
    const auto client = client_of_uri(wire.uri);
    const UsbFace face = usb_face(receiver.board(), wire.port);
    auto transport = client ? open_client(*client) : open_transport(wire.uri, face, shared.can_buses.get());
    if (!transport) return fail(transport.error());
    return Link(std::move(*transport), speed, InputPace::line);
}

Result<void> plug_in_corrections(PlannedStation& station, const WireRequest& wire, const SharedParts& shared,
                                 std::size_t index) {
    const PortSpeed speed = port_speed(station.parts.receiver, wire.port);
    std::vector<Wire>& wires = station.parts.wires;
    // In a repeated run the recording stands for the caster.
    if (shared.mode.repeat) {
        auto nobody = open_transport("file:/dev/null");
        if (!nobody) return fail(nobody.error());
        wires.push_back({wire.port, Link(std::move(*nobody), speed, InputPace::at_once), true});
        return {};
    }
    auto address = parse_ntrip_uri(wire.uri);
    if (!address) return fail(address.error());
    const ReceiverEntry& entry = shared.scenario.receivers.at(index);
    auto caster = std::make_unique<CorrectionsWire>(NtripClientSettings{
        std::move(*address), std::chrono::seconds(entry.corrections_position_s), station.parts.seed});
    CorrectionsWire* const end = caster.get();
    wires.push_back({wire.port, Link(std::move(caster), speed, InputPace::at_once), true, end});
    return {};
}

SimulationSetup simulation_setup(const SharedParts& shared, std::size_t index, const firmware::Receiver& receiver) {
    return {shared.navigation,
            shared.geoid,
            shared.start,
            shared.data,
            index,
            shared.scene,
            shared.mode.embedding,
            1e9 / static_cast<double>(receiver.settings().navigation_period.count()),
            receiver.board().timing.warm_start,
            receiver.board().modern,
            receiver.board().geoid_step_deg,
            shared.gas_losses,
            shared.osnma,
            shared.precise};
}

void remember_place(const SharedParts& shared, std::size_t index, const Simulation& simulation,
                    firmware::Receiver& receiver) {
    const auto place = place_before_start(shared.scenario, index, simulation.truth_at(shared.start));
    if (!place) return;
    const double step = receiver.board().geoid_step_deg;
    const Metres undulation =
        shared.geoid != nullptr ? shared.geoid->undulation(place->latitude, place->longitude, step) : Metres(0);
    receiver.remember(*place, undulation);
}

// Their times are those of the world outside. A recording has them already, with its own.
Result<void> check_corrections(const ReceiverEntry& entry, const RunMode& mode) {
    const bool live = !mode.virtual_time && mode.embedding == nullptr;
    if (entry.corrections.empty() || live || mode.only_checked || mode.repeat) return {};
    return fail(at_key(
        "corrections",
        {ErrorCode::usage, "corrections of a caster need time that passes; expected skyloop run, without --speed max"},
        entry));
}

void warn_of_deaf_port(const std::vector<WireRequest>& wires, const firmware::BoardProfile& board,
                       const ReceiverEntry& entry, std::vector<std::string>& warnings) {
    const bool brought = std::any_of(wires.begin(), wires.end(), [](const WireRequest& w) { return w.corrections; });
    if (brought && !firmware::abilities(board).corrections)
        warnings.push_back(fmt::format("{}{} takes no corrections: nothing comes of those of a caster",
                                       place_of("corrections", entry.told_at), board.name));
}

// What the keys of a receiver name.
struct NamedParts {
    firmware::BoardProfile board;
    std::vector<WireRequest> wires;
    std::optional<StateFile> state;
};

// Each is tried, whatever the others are: a mistake a line.
Result<NamedParts> named_parts(const SharedParts& shared, std::size_t index, std::vector<std::string>& warnings) {
    const ReceiverEntry& entry = shared.scenario.receivers.at(index);
    std::optional<Error> wrong;
    const auto note = [&](const Error& error) {
        if (wrong)
            wrong->message += "\n" + error.message;
        else
            wrong = error;
    };
    NamedParts parts;
    auto board = board_of(entry, shared.data);
    if (!board) note(at_key("board", board.error(), entry));
    firmware::BoardProfile any;
    any.ports = {firmware::PortId::i2c, firmware::PortId::uart1, firmware::PortId::uart2,
                 firmware::PortId::usb, firmware::PortId::spi,   firmware::PortId::uart3};
    auto wires = wires_of(entry, board ? *board : any);
    if (!wires) note(at_key("port", wires.error(), entry));
    const auto corrections = corrections_of(entry, board ? *board : any);
    if (!corrections) note(at_key("corrections", corrections.error(), entry));
    if (const auto known = check_corrections(entry, shared.mode); !known) note(known.error());
    if (const auto known = check_power(shared, index, warnings); !known) note(known.error());
    if (!entry.state_file.empty()) {
        auto opened = StateFile::open(entry.state_file);
        if (opened)
            parts.state = std::move(*opened);
        else
            note(at_key("state_file", opened.error(), entry));
    }
    if (wrong) return fail(*wrong);
    parts.board = std::move(*board);
    parts.wires = std::move(*wires);
    if (*corrections) parts.wires.push_back(**corrections);
    return parts;
}

// Somebody takes its corrections, or will by mistake.
bool is_overheard(const Scenario& scenario, std::size_t index) {
    const auto by = [&](const ReceiverEntry& other) { return other.corrections_from == index; };
    const auto named = [&](const FaultEntry& fault) {
        return fault.kind == "wrong_mount_point" &&
               fault.parameters.text("of_receiver") == receiver_name(scenario, index);
    };
    return std::ranges::any_of(scenario.receivers, by) || std::ranges::any_of(scenario.faults, named);
}

Result<PlannedStation> planned(const SharedParts& shared, std::size_t index, std::vector<std::string>& warnings) {
    const Scenario& scenario = shared.scenario;
    const ReceiverEntry& entry = scenario.receivers.at(index);
    auto named = named_parts(shared, index, warnings);
    if (!named) return fail(named.error());
    auto& [board, wires, state] = *named;
    const firmware::ReceiverOptions options{entry.rate_hz.value_or(0), receiver_settings(scenario, board, index),
                                            receiver_seed(scenario.run, index), entry.power_up, index};
    warn_of_missing_usb(wires, board, entry, warnings);
    warn_of_deaf_port(wires, board, entry, warnings);
    warn_of_untracked(scenario, board, options.settings, warnings);
    if (const auto checked = check_options(board, options, entry); !checked) return fail(checked.error());
    firmware::Receiver receiver(std::move(board), options);
    if (entry.rate_hz) warn_of_rate(entry, receiver, warnings);
    if (const auto configured = receiver.configure(entry.config); !configured)
        return fail(at_key("config", configured.error(), entry));
    if (state && !state->text().empty())
        if (auto restored = receiver.restore(state->text(), state->path().string()); !restored)
            return fail(restored.error());
    auto simulation = make_simulation(scenario, simulation_setup(shared, index, receiver));
    if (!simulation) return fail(simulation.error());
    remember_place(shared, index, *simulation, receiver);
    Station::Parts parts{std::move(*simulation), std::move(receiver), {}, {}};
    parts.name = receiver_name(scenario, index);
    parts.seed = receiver_seed(scenario.run, index);
    parts.state = std::move(state);
    parts.base = entry.base;
    parts.corrections_from = entry.corrections_from;
    parts.overheard = is_overheard(scenario, index);
    if (shared.mode.repeat) {
        auto heard = repeated_input(*shared.mode.repeat, index, wires, parts.receiver.board());
        if (!heard) return fail(heard.error());
        parts.repeated = std::move(*heard);
    }
    if (entry.base) parts.moving_base.emplace(receiver_seed(scenario.run, index));
    return PlannedStation{std::move(parts), std::move(wires)};
}

}  // namespace

std::uint64_t receiver_seed(const RunSettings& run, std::size_t index) {
    const std::uint64_t seed = run.seed_of_receivers();
    return index == 0 ? seed : fnv1a_64(fmt::format("seed {} receiver {}", seed, index));
}

Error of_receiver(Error error, const Scenario& scenario, std::size_t index) {
    if (scenario.receivers.size() > 1)
        error.message = fmt::format("receiver '{}': {}", receiver_name(scenario, index), error.message);
    return error;
}

Result<PlannedStation> plan_station(const SharedParts& shared, std::size_t index, std::vector<std::string>& warnings) {
    std::vector<std::string> own;
    auto station = planned(shared, index, own);
    for (const std::string& warning : own)
        warnings.push_back(of_named_receiver({ErrorCode::usage, warning}, shared.scenario, index).message);
    if (!station) return fail(of_named_receiver(station.error(), shared.scenario, index));
    return station;
}

Result<void> plug_in(PlannedStation& station, const SharedParts& shared, std::size_t index) {
    for (const WireRequest& wire : station.wires) {
        if (wire.corrections) {
            const auto plugged = plug_in_corrections(station, wire, shared, index);
            if (!plugged) return fail(of_receiver(plugged.error(), shared.scenario, index));
            continue;
        }
        auto link = open_wire(wire, station.parts.receiver, shared, index);
        if (!link) return fail(of_receiver(link.error(), shared.scenario, index));
        if (shared.mode.virtual_time) link->transport().allow_waiting();
        // The recording stands for a scripted client, which still says what it believes.
        if (shared.mode.repeat && client_of_uri(wire.uri)) station.parts.mute_wires.insert(station.parts.wires.size());
        station.parts.wires.push_back({wire.port, std::move(*link)});
    }
    const std::string& uri = shared.scenario.receivers.at(index).power;
    if (uri.empty() || shared.mode.virtual_time) return {};
    auto power = power_of(uri, shared, index);
    if (!power) return fail(of_receiver(power.error(), shared.scenario, index));
    station.parts.power = std::move(*power);
    return {};
}

Result<void> check_state(const Station::Parts& parts, const SharedParts& shared, std::size_t index) {
    const auto replaceable = parts.state ? check_replaceable(parts.state->path()) : Result<void>();
    if (replaceable) return {};
    const Error refused = at_key("state_file", replaceable.error(), shared.scenario.receivers.at(index));
    return fail(of_named_receiver(refused, shared.scenario, index));
}

Result<void> add_recorder(Station::Parts& parts, const SharedParts& shared, std::size_t index) {
    auto recorder = Recorder::claim(recording_of(*shared.mode.record, index));
    if (!recorder) return fail(recorder.error());
    if (parts.simulation.measures()) recorder->add_rinex(rinex_setup(parts, shared.start));
    recorder->add_files(osnma_files(shared.osnma.get()));
    parts.recorder = std::move(*recorder);
    return {};
}

}  // namespace skyloop::inline run
