#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "commands.hpp"
#include "data_folders.hpp"
#include "run/client/open_client.hpp"
#include "run/emulator/load_track.hpp"
#include "run/emulator/scenario_mistakes.hpp"
#include "run/emulator/wires.hpp"
#include "run_session.hpp"
#include "run_watch.hpp"

namespace skyloop::host {
namespace {

// The recording of a live run has the files of all wires, that of simulate those of scripted clients alone.
bool has_all_wires(const std::filesystem::path& recording, const Scenario& scenario) {
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i) {
        const std::size_t wires = scenario.receivers[i].ports.size();
        const auto folder = i == 0 ? recording : recording / fmt::format("receiver{}", i);
        std::error_code absent;
        if (wires > 0 && !std::filesystem::exists(folder / fmt::format("port{}.in", wires - 1), absent)) return false;
    }
    return true;
}

// The wires keep their numbers, which are those of the recording's files.
void lead_others_nowhere(Scenario& scenario) {
    for (ReceiverEntry& receiver : scenario.receivers) {
        for (std::string& port : receiver.ports) {
            const std::size_t equals = port.find('=');
            const std::size_t uri = equals != std::string::npos && equals < port.find(':') ? equals + 1 : 0;
            if (!client_of_uri(port.substr(uri))) port = port.substr(0, uri) + "file:/dev/null";
        }
        if (receiver.ports.empty()) receiver.ports = {"file:/dev/null"};
    }
}

void plug_in_clients_alone(const RunOptions& options, Scenario& scenario) {
    if (!options.repeat.empty() && has_all_wires(options.repeat, scenario))
        lead_others_nowhere(scenario);
    else
        keep_scripted_clients(scenario);
}

int simulate(const RunOptions& options) {
    const Messages messages(options.verbosity);
    auto scenario = scenario_from(options);
    if (!scenario) return messages.error(scenario.error());
    if (!scenario->run.duration && !ends_with_its_path(*scenario))
        return messages.error({ErrorCode::usage,
                               "simulate needs an end: expected --duration SECONDS, run.duration_s in the scenario, or "
                               "a trajectory with end = \"stop\""});
    // What a scenario tells other programs belongs to a live run, as its pty does.
    if (options.outputs.empty())
        std::erase_if(scenario->outputs, [](const OutputSettings& output) { return output.way != OutputWay::file; });
    catch_stop_signals();
    RunMode mode;
    mode.virtual_time = true;
    mode.now = wall_clock();
    mode.now_steady_ns = steady_clock_ns();
    mode.record = options.record;
    // A scenario's pty belongs to a live run. Its scripted clients live in simulated time, and wires asked for here are
    // opened.
    mode.first_ports_only = !options.ports.empty();
    mode.open_ports = mode.first_ports_only || has_scripted_client(*scenario);
    if (mode.open_ports && !mode.first_ports_only) plug_in_clients_alone(options, *scenario);
    if (!options.repeat.empty()) mode.repeat = options.repeat;
    auto assembly = assemble(*scenario, data_folders(), mode);
    if (!assembly) return messages.error(with_other_mistakes(assembly.error(), *scenario, data_folders(), mode.now));
    if (const auto warning = vehicle_warning(*scenario)) assembly->warnings.push_back(*warning);
    CommandQueue nobody;
    const auto watch = RunWatch::start(*scenario, *assembly, {}, nobody);
    if (!watch) return messages.error(watch.error());
    RunSession session(messages, *assembly);
    return session.run(*scenario, **watch);
}

}  // namespace

Action add_simulate_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("simulate", "The same pipeline as fast as the machine can, on the virtual clock");
    auto options = std::make_shared<RunOptions>();
    add_run_options(*command, *options);
    command->add_option("--out", options->record, "Folder for the recording")->required();
    return [options] { return simulate(*options); };
}

}  // namespace skyloop::host
