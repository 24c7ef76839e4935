#include "detail/fault_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "run/fault/selected_signals.hpp"

namespace skyloop {
namespace {

struct RunOfFaults {
    const Scenario& scenario;
    const NavigationSource& navigation;
    std::span<const Station> stations;
    bool virtual_time = false;
};

bool model_has_ionosphere(const ModelSettings& model) {
    return !model.sensor_model || model.sensor_model == ErrorModelKind::baseline ||
           model.sensor_model == ErrorModelKind::whole_path;
}

// Sensor models know the first signal of each system, whatever the receiver tracks.
bool meets(const FaultEntry& fault, const SatelliteId satellite, const Station& station, bool sensor_model) {
    const Constellation system = satellite.constellation;
    if (sensor_model) return is_for(fault.parameters, satellite, first_signal(system));
    const ReceiverSettings& settings = station.receiver().settings();
    const auto signals = emulated_signals(system);
    return std::any_of(signals.begin(), signals.end(), [&](Signal signal) {
        return settings.tracks(system, signal) && is_for(fault.parameters, satellite, signal);
    });
}

bool meets_any(const FaultEntry& fault, const RunOfFaults& run) {
    const std::vector<SatelliteId> satellites = run.navigation.satellites();
    const bool sensor_model = run.scenario.model.sensor_model.has_value();
    return std::any_of(fault.receivers.begin(), fault.receivers.end(), [&](std::size_t receiver) {
        return std::any_of(satellites.begin(), satellites.end(), [&](SatelliteId satellite) {
            return meets(fault, satellite, run.stations[receiver], sensor_model);
        });
    });
}

bool has_pair(const FaultEntry& fault, const Scenario& scenario) {
    return std::any_of(fault.receivers.begin(), fault.receivers.end(),
                       [&](std::size_t receiver) { return scenario.receivers.at(receiver).base.has_value(); });
}

bool is_live_only(const Command& command) {
    const CommandKind* kind = find_command_kind(command_name(command.verb));
    return kind != nullptr && kind->live_only;
}

// Why nothing will be seen of a fault; empty: something will.
std::string why_idle(const FaultEntry& fault, const RunOfFaults& run) {
    const ModelSettings& model = run.scenario.model;
    if (fault.kind == "clock_drift" && run.virtual_time)
        return "skyloop run shows it, against the clock; in virtual time nothing does";
    if ((fault.kind == "heading_lost" || fault.kind == "heading_flipped") && !has_pair(fault, run.scenario))
        return "its receiver has no base antenna; expected 'base' of a [[receiver]]";
    if (fault.kind == "multipath_burst" && !model.sensor_model && !model.modern.errors)
        return "errors = \"none\" leaves echoes out";
    if (fault.kind == "ionospheric_storm" && !model_has_ionosphere(model))
        return fmt::format("model.name = \"{}\" has no ionosphere", model_name(model));
    if (!meets_any(fault, run)) return "no receiver tracks what it is for, as the run starts";
    return {};
}

}  // namespace

std::vector<std::string> idle_fault_warnings(const Scenario& scenario, const NavigationSource& navigation,
                                             std::span<const Station> stations, bool virtual_time) {
    std::vector<std::string> warnings;
    for (const FaultEntry& fault : scenario.faults)
        if (const std::string why = why_idle(fault, {scenario, navigation, stations, virtual_time}); !why.empty())
            warnings.push_back(fmt::format("[[fault]] '{}' will show nothing: {}", fault.when.name, why));
    for (const CommandEntry& command : scenario.commands)
        if (virtual_time && command.command.source == "scenario" && is_live_only(command.command))
            warnings.push_back(
                fmt::format("[[command]] '{}' will do nothing: skyloop run does it, against the clock; in virtual time "
                            "nothing does",
                            command.when.name));
    return warnings;
}

}  // namespace skyloop
