// [[receiver]] and [[output]].
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "detail/scenario_keys.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "run/scenario/board_files.hpp"

namespace skyloop::inline run {
namespace {

void add_once(std::vector<firmware::NmeaSentence>& sentences, firmware::NmeaSentence sentence) {
    if (std::find(sentences.begin(), sentences.end(), sentence) == sentences.end()) sentences.push_back(sentence);
}

using Phrases = std::vector<std::string>;

// Beside a key, once it has been read: what of it comes to nothing at a board.
void judge(TableReader& receiver, std::string_view key, ReceiverEntry& entry, decltype(KeyJudge::idle) idle) {
    if (!receiver.recording() && receiver.has(key)) entry.judges.push_back({receiver.told_at(key), idle});
}

// Of a key of which all or nothing comes.
template <const ReceiverNeed& need>
Phrases without(const UsedReceiver& receiver, const ReceiverEntry&, const Scenario&) {
    return need.met(receiver) ? Phrases() : Phrases{std::string(need.lack)};
}

Phrases unsent_sentences(const UsedReceiver& receiver, const ReceiverEntry& entry, const Scenario&) {
    Phrases idle;
    for (const firmware::NmeaSentence sentence : entry.sentences) {
        const std::string_view name = firmware::nmea_sentence_names[static_cast<std::size_t>(sentence)];
        if (!sends_periodically(receiver, firmware::find_output_message(name)->id))
            idle.push_back(fmt::format("never sends {}", name));
    }
    return idle;
}

Phrases unsent_rates(const UsedReceiver& receiver, const ReceiverEntry& entry, const Scenario&) {
    Phrases idle;
    for (const auto& [item, value] : entry.config)
        for (const firmware::OutputMessage& message : firmware::output_messages()) {
            const bool is_rate = item >= message.i2c_key && item < message.i2c_key + firmware::ublox_port_count;
            if (is_rate && value > 0 && !sends_periodically(receiver, message.id))
                idle.push_back(
                    fmt::format("has {} and never sends {}", firmware::find_config_key(item)->name, message.name));
        }
    return idle;
}

Phrases unreceived_systems(const UsedReceiver& receiver, const ReceiverEntry& entry, const Scenario&) {
    Phrases idle;
    for (const Constellation constellation : entry.constellations)
        if (!can_track(receiver.board, constellation))
            idle.push_back(fmt::format("does not receive {}", constellation_name(constellation)));
    return idle;
}

Phrases unreceived_band(const UsedReceiver& receiver, const ReceiverEntry& entry, const Scenario&) {
    if (!entry.dual_frequency || has_second_band(receiver.board)) return {};
    return {
        "receives one band: the second signals are measured and recorded all the same, and no message of it "
        "reports them"};
}

// Without limits of its own nothing but the filter of a measured solution goes by the model.
Phrases unheeded_model(const UsedReceiver& receiver, const ReceiverEntry&, const Scenario& scenario) {
    if (receiver.board.dynamic_limits || receiver.measures) return {};
    return {fmt::format("has no limits by dynamic_model, and model.name = \"{}\" has no filter",
                        model_name(scenario.model))};
}

// A sensor model measures nothing.
Phrases unmeasured_antenna(const UsedReceiver& receiver, const ReceiverEntry&, const Scenario& scenario) {
    if (receiver.measures) return {};
    return {fmt::format("measures nothing with model.name = \"{}\"", model_name(scenario.model))};
}

Phrases shortened_hold(const UsedReceiver&, const ReceiverEntry& entry, const Scenario&) {
    constexpr double most_mps = 2.55;  // CFG-MOT-GNSSSPEED_THRS, U1, cm/s
    if (entry.static_hold_below.value() <= most_mps) return {};
    return {fmt::format("holds a position below {:g} m/s at most", most_mps)};
}

// The vector of a pair is reported, or goes to another program.
Phrases unreported_pair(const UsedReceiver& receiver, const ReceiverEntry& entry, const Scenario& scenario) {
    if (!entry.base || !scenario.outputs.empty()) return {};
    return without<heading_report>(receiver, entry, scenario);
}

void read_output_keys(TableReader& receiver, ReceiverEntry& entry, const std::filesystem::path& folder) {
    receiver.text("board", entry.board, "a profile of `skyloop boards`, or the path of a board file (`.toml`)");
    if (is_board_path(entry.board)) entry.board = (folder / entry.board).string();
    receiver.text_or_texts("port", entry.ports,
                           {"ports: pty[:LINK], serial:DEVICE[@BAUD], usb:VID:PID, hid:VID:PID, usbip:[HOST:]PORT, "
                            "tcp:[HOST:]PORT[@BAUD], tcp-connect:HOST:PORT[@BAUD], rfc2217:[HOST:]PORT, file:PATH, -, "
                            "client:NAME; NAME= before it says which port",
                            "a pty"});
    receiver.text("corrections", entry.corrections,
                  {"a caster whose corrections the receiver hears in a live run: "
                   "ntrip://[USER:PASSWORD@]HOST[:PORT]/MOUNT or ntrips://…; NAME= before it says at which port "
                   "(docs/ntrip.md)",
                   "none"});
    receiver.where(!entry.corrections.empty(), "with corrections", [&] {
        receiver.integer("corrections_position_s", entry.corrections_position_s, {0, 3600},
                         "every how many seconds the caster is told the receiver's position (GGA); 0: never");
    });
    receiver.text("power", entry.power,
                  {"the actuator that the fault power_cut switches in a live run: relay:VID:PID/N gpio:VID:PID/N "
                   "hub:PORT_PATH line:DEVICE/rts line:DEVICE/dtr command:CUT|RESTORE (docs/actuators.md)",
                   "none"});
    for (const char* key : {"board", "port", "corrections", "power", "config", "state_file", "rate_hz", "baud",
                            "constellations", "dual_frequency"})
        entry.told_at[key] = receiver.told_at(key);
    receiver.number("rate_hz", entry.rate_hz, {0.01, 100}, {"navigation rate at the factory", "the board's"});
    receiver.integer("baud", entry.baud, {300, 4e6}, {"bit/s of UART1 at the factory", "the board's"});
    judge(receiver, "baud", entry, without<wired_uart1>);
    if (const auto sentences = receiver.choices("sentences", firmware::nmea_sentence_names,
                                                {"NMEA sentences at the factory, each every epoch", "the board's"}))
        for (const std::size_t index : *sentences)
            add_once(entry.sentences, static_cast<firmware::NmeaSentence>(index));
    judge(receiver, "sentences", entry, unsent_sentences);
}

void read_navigation_keys(TableReader& receiver, ReceiverEntry& entry) {
    receiver.named_values(
        "config", "configuration items that its user has saved in it, by their names, such as `CFG-RATE-MEAS = 100`",
        [&](TableReader& config) { entry.config = read_config_items(config); });
    judge(receiver, "config", entry, unsent_rates);
    read_constellation_list(receiver, "constellations", entry.constellations,
                            {"systems that it tracks from the factory on", "the board's"});
    judge(receiver, "constellations", entry, unreceived_systems);
    receiver.boolean("dual_frequency", entry.dual_frequency,
                     "it tracks the second signal of each system too; false leaves it to the board");
    judge(receiver, "dual_frequency", entry, unreceived_band);
    receiver.word("start", {{"hot", StartKind::hot}, {"warm", StartKind::warm}, {"cold", StartKind::cold}}, entry.start,
                  "what it knows at the start: everything; time, place and almanac; nothing");
    receiver.word("dynamic_model",
                  {{"portable", DynamicModel::portable},
                   {"stationary", DynamicModel::stationary},
                   {"pedestrian", DynamicModel::pedestrian},
                   {"automotive", DynamicModel::automotive},
                   {"sea", DynamicModel::sea},
                   {"airborne-1g", DynamicModel::airborne_1g},
                   {"airborne-2g", DynamicModel::airborne_2g},
                   {"airborne-4g", DynamicModel::airborne_4g}},
                  entry.dynamic_model,
                  "how it expects to move; a u-blox board withholds a fix beyond its limits of height and speed");
    judge(receiver, "dynamic_model", entry, unheeded_model);
    read_export_limits(
        receiver, entry.export_limits,
        {"a fix above 18 288 m and above 515 m/s is withheld: never, beyond both, beyond one of them", "the board's"});
    receiver.quantity("latency_s", entry.latency, {0, 2},
                      {"from the epoch to the first byte of its messages", "the board's"});
    receiver.quantity("static_hold_mps", entry.static_hold_below, {0, 100},
                      "slower than this, the position is held; 0: never");
    judge(receiver, "static_hold_mps", entry, shortened_hold);
}

void read_place_and_power_keys(TableReader& receiver, ReceiverEntry& entry, const std::filesystem::path& folder) {
    receiver.boolean("power_up", entry.power_up,
                     "it is switched on at the start of the run; false: it has been on for long");
    receiver.file_path("state_file", folder, entry.state_file,
                       {"keeps what the receiver saves for the next run", "none"});
    judge(receiver, "state_file", entry, without<command_input>);
    receiver.text(
        "antenna_type", entry.antenna_type,
        {"antenna and radome as sky.antennas names them, such as `TRM59800.00 NONE`: the place is that of its "
         "reference point",
         "a point that is its phase centre"});
    entry.told_at["antenna_type"] = receiver.told_at("antenna_type");
    judge(receiver, "antenna_type", entry, unmeasured_antenna);
    constexpr double longest_arm_m = 1000;
    if (const auto offset = receiver.numbers(
            "antenna_offset_m", 3, "from the point that follows the trajectory to the antenna: forward, right, down",
            entry.antenna_offset)) {
        std::copy(offset->begin(), offset->end(), entry.antenna_offset.begin());
        if (std::any_of(offset->begin(), offset->end(), [](double part) { return !(std::abs(part) <= longest_arm_m); }))
            receiver.mistake("antenna_offset_m", fmt::format("is [{0:g}]; expected numbers from -{1:g} to {1:g}",
                                                             fmt::join(*offset, ", "), longest_arm_m));
    }
}

// A name stands for the table in messages and in `base`.
void read_name(TableReader& receiver, Scenario& scenario) {
    ReceiverEntry& entry = scenario.receivers.back();
    receiver.text("name", entry.name, {"what messages and `base` call it", "receiver0, receiver1, …"});
    if (receiver.has("name") && entry.name.empty()) receiver.mistake("name", "is empty; expected a name");
    const std::size_t own = scenario.receivers.size() - 1;
    for (std::size_t i = 0; i < own; ++i)
        if (receiver_name(scenario, i) == receiver_name(scenario, own))
            receiver.mistake_here(
                fmt::format("is the second receiver called '{}'; expected another name", receiver_name(scenario, own)));
}

// Another receiver of the scenario; nothing, and perhaps a mistake, for none. @param names of all receivers
std::optional<std::size_t> read_other_receiver(TableReader& receiver, std::string_view key, std::string_view meaning,
                                               std::span<const std::string> names, const Scenario& scenario) {
    std::string name;
    receiver.text(key, name, {meaning, "none"});
    if (name.empty() || !names_receiver(receiver, key, name, names)) return std::nullopt;
    const auto index = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    if (index + 1 != scenario.receivers.size()) return index;
    receiver.mistake(key, fmt::format("'{}' is this receiver itself; expected another one", name));
    return std::nullopt;
}

void read_base(TableReader& receiver, std::span<const std::string> names, Scenario& scenario) {
    ReceiverEntry& entry = scenario.receivers.back();
    entry.base = read_other_receiver(receiver, "base", "name of the receiver that carries the base antenna of a pair",
                                     names, scenario);
    if (entry.base) judge(receiver, "base", entry, unreported_pair);
    entry.corrections_from = read_other_receiver(
        receiver, "corrections_from", "name of the receiver whose RTCM 3 output this one takes in", names, scenario);
}

// @return where the output goes; an unchanged one, and a mistake, for a text that is no output
OutputSettings read_target(TableReader& table) {
    table.needs_one_of({"to"}, "says nowhere; expected to = \"gps-input:127.0.0.1:14550\"");
    std::string uri;
    table.text("to", uri,
               {"gps-input:HOST:PORT, hil-gps:HOST:PORT, msp-tcp:[HOST:]PORT, msp-tcp-to:HOST:PORT, "
                "json-udp:HOST:PORT, json-tcp:[HOST:]PORT, json-file:PATH, rtcm-tcp:[HOST:]PORT, rtcm-udp:HOST:PORT, "
                "rtcm-file:PATH",
                "none"});
    if (table.recording() || !table.has("to")) return {};
    auto settings = parse_output_uri(uri);
    if (settings) return std::move(*settings);
    table.mistake("to", settings.error().message);
    return {};
}

void read_receiver_of(TableReader& table, const Scenario& scenario, OutputSettings& output) {
    table.text("receiver", output.receiver,
               {"name of the receiver whose solution is sent", "all to json, the first to others"});
    if (!output.receiver.empty()) names_receiver(table, "receiver", output.receiver, receiver_names(scenario));
}

void read_rtcm_keys(TableReader& table, OutputSettings& output) {
    constexpr NumberRange stations{0, 4095}, kinds{4, 7}, seconds{1, 3600}, seconds_or_none{0, 3600};
    table.integer("station", output.station, stations, "RTCM: number of the base station");
    table.integer("msm", output.msm, kinds, "RTCM: kind of the observations' messages, 7 is MSM7");
    table.integer("every_s", output.every_s, seconds, "RTCM: between messages of the place, antenna and receiver");
    table.integer("ephemerides_s", output.ephemerides_s, seconds_or_none,
                  "RTCM: between the records of satellites; 0 sends none");
}

void refuse_foreign_keys(TableReader& table, const OutputSettings& output) {
    if (table.recording() || output.uri.empty()) return;
    for (const std::string_view key :
         {"system", "component", "id", "eph", "station", "msm", "every_s", "ephemerides_s"})
        if (const std::string foreign = foreign_option(output.format, key); table.has(key) && !foreign.empty())
            table.mistake(key, foreign);
}

}  // namespace

std::string default_receiver_name(std::size_t index) { return fmt::format("receiver{}", index); }

std::string receiver_name(const Scenario& scenario, std::size_t index) {
    const std::string& name = scenario.receivers.at(index).name;
    return name.empty() ? default_receiver_name(index) : name;
}

std::vector<std::string> receiver_names(const Scenario& scenario) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i)
        names.push_back(receiver_name(scenario, i));
    return names;
}

bool names_receiver(TableReader& table, std::string_view key, const std::string& name,
                    std::span<const std::string> receivers) {
    if (std::find(receivers.begin(), receivers.end(), name) != receivers.end()) return true;
    table.mistake(
        key, fmt::format("'{}' is no receiver of this scenario; expected one of {}", name, fmt::join(receivers, ", ")));
    return false;
}

const TrajectorySettings& trajectory_of(const Scenario& scenario, std::size_t index) {
    const std::optional<TrajectorySettings>& own = scenario.receivers.at(index).trajectory;
    return own ? *own : scenario.trajectory;
}

void read_receivers(TableReader& top, Scenario& scenario, const TrajectoryContext& context) {
    // A rover may stand before its base, so the names are read before the rest.
    std::vector<std::string> names;
    top.look_at_tables("receiver", [&](const toml::table& table) {
        const auto name = table["name"].value<std::string>().value_or("");
        names.push_back(name.empty() ? default_receiver_name(names.size()) : name);
    });
    std::size_t count = 0;
    top.tables("receiver", {"the receivers on the vehicle", "one, an ublox-m8 on a pty"}, [&](TableReader& receiver) {
        if (count++ > 0) scenario.receivers.emplace_back();
        read_name(receiver, scenario);
        ReceiverEntry& entry = scenario.receivers.back();
        read_output_keys(receiver, entry, context.folder);
        read_navigation_keys(receiver, entry);
        read_place_and_power_keys(receiver, entry, context.folder);
        entry.trajectory =
            read_trajectory_keys(receiver, {"where the vehicle is that this receiver rides on", "the scenario's"},
                                 context, scenario.warnings);
        read_base(receiver, names, scenario);
    });
}

void read_outputs(TableReader& top, Scenario& scenario) {
    constexpr NumberRange named{1, 255}, counted{0, 255};
    top.tables(
        "output", {"what is sent to other programs beside the receivers' ports (docs/outputs.md)", "none"},
        [&](TableReader& table) {
            OutputSettings output = read_target(table);
            read_receiver_of(table, scenario, output);
            table.word("when",
                       {{output_moment_names[0], OutputMoment::report}, {output_moment_names[1], OutputMoment::epoch}},
                       output.when,
                       {"when the receiver's own messages of an epoch begin to leave, or as soon as it is solved",
                        "report; of json epoch"});
            table.integer("system", output.system, named, "MAVLink: number of the system that sends");
            table.integer("component", output.component, named, "MAVLink: number of the component that sends");
            table.integer("id", output.id, counted,
                          "which receiver of the vehicle this is: gps_id of GPS_INPUT, id of HIL_GPS, instance of MSP");
            table.word("eph",
                       {{hil_gps_accuracy_names[0], HilGpsAccuracy::px4_cm},
                        {hil_gps_accuracy_names[1], HilGpsAccuracy::dop100}},
                       output.eph,
                       "what eph and epv of HIL_GPS hold: accuracies in centimetres for PX4, or DOP times 100");
            read_rtcm_keys(table, output);
            refuse_foreign_keys(table, output);
            scenario.outputs.push_back(std::move(output));
        });
}

}  // namespace skyloop::inline run
