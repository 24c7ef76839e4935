#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "detail/scenario_keys.hpp"

namespace skyloop {
namespace {

// @return where the output goes; an unchanged one, and a mistake, for a text that is no output
OutputSettings read_target(TableReader& table) {
    table.needs_one_of({"to"}, "says nowhere; expected to = \"gps-input:127.0.0.1:14550\"");
    std::string uri;
    table.text("to", uri,
               {"gps-input:HOST:PORT, hil-gps:HOST:PORT, msp-tcp:[HOST:]PORT, msp-tcp-to:HOST:PORT, "
                "json-udp:HOST:PORT, json-tcp:[HOST:]PORT, json-file:PATH",
                "none"});
    if (table.recording() || !table.has("to")) return {};
    auto settings = parse_output_uri(uri);
    if (settings) return std::move(*settings);
    table.mistake("to", settings.error().message);
    return {};
}

void read_receiver_of(TableReader& table, const Scenario& scenario, OutputSettings& output) {
    table.text("receiver", output.receiver, {"name of the receiver that is told", "all to json, the first to others"});
    if (output.receiver.empty()) return;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i)
        names.push_back(receiver_name(scenario, i));
    if (std::find(names.begin(), names.end(), output.receiver) == names.end())
        table.mistake("receiver", fmt::format("'{}' is no receiver of this scenario; expected one of {}",
                                              output.receiver, fmt::join(names, ", ")));
}

void refuse_foreign_keys(TableReader& table, const OutputSettings& output) {
    if (table.recording() || output.uri.empty()) return;
    for (const std::string_view key : {"system", "component", "id", "eph"})
        if (const std::string foreign = foreign_option(output.format, key); table.has(key) && !foreign.empty())
            table.mistake(key, foreign);
}

}  // namespace

void read_outputs(TableReader& top, Scenario& scenario) {
    constexpr NumberRange named{1, 255}, counted{0, 255};
    top.tables(
        "output", {"what is told to other programs beside the receivers' wires (docs/outputs.md)", "none"},
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
            refuse_foreign_keys(table, output);
            scenario.outputs.push_back(std::move(output));
        });
}

}  // namespace skyloop
