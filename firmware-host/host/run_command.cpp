#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "base/core/watchdog_process.hpp"
#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "campaigns/campaign/campaign_run.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "run/client/open_client.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/load_track.hpp"
#include "run/emulator/real_time.hpp"
#include "run/emulator/run_caster.hpp"
#include "run/emulator/wires.hpp"
#include "run/fault/timeline.hpp"
#include "run_session.hpp"
#include "run_watch.hpp"
#include "wire/ntrip/ntrip_address.hpp"

namespace skyloop::host {
namespace {

// With a client's deadlines to keep, the loop goes before programs that have none.
DeadlineGrants keep_deadlines(const Messages& messages) {
    DeadlineGrants grants = prepare_for_deadlines();
    messages.detail(fmt::format("priority of the loop: {}", to_string(grants.priority)));
    messages.detail(fmt::format("memory: {}; timer slack: {} ns", grants.memory_locked ? "locked" : "not locked",
                                grants.timer_slack_ns));
    for (const std::string& sentence : grants.missing)
        messages.detail(sentence);
    return grants;
}

// Before anything starts a thread. @return null where there is nothing to watch over
Result<std::unique_ptr<PowerWatchdog>> watch_power(const Scenario& scenario, const RunMode& mode) {
    std::vector<std::string> wards;
    bool any = false;
    for (const ReceiverEntry& receiver : scenario.receivers) {
        wards.push_back(receiver.power);
        any = any || !receiver.power.empty();
    }
    if (!any || mode.virtual_time) return nullptr;
    return PowerWatchdog::start(wards);
}

// Over the programs that expectations ask; null where there are none, or no process is to be had for it.
std::unique_ptr<OrphanWatchdog> watch_probes(const Scenario& scenario, const RunMode& mode) {
    const auto& expectations = scenario.expectations;
    const auto asks = [](const Expectation& expectation) { return expectation.probe.has_value(); };
    if (mode.virtual_time || std::ranges::none_of(expectations, asks)) return nullptr;
    auto watchdog = OrphanWatchdog::start();
    return watchdog ? std::move(*watchdog) : nullptr;
}

// Scripts wait for these lines to know the tty: they are said even when quiet.
void say_where(const RunSession& session, const std::vector<Station>& stations, const RunWatch& watch) {
    for (const Station& station : stations)
        for (std::size_t i = 0; i < station.wires().size(); ++i)
            say(fmt::format("{}: {}\n", session.port_name(station, i),
                            station.wires()[i].link.transport().description()));
    if (!watch.url().empty()) say(fmt::format("control: {}\n", watch.url()));
    for (std::size_t i = 0; i < watch.outputs().size(); ++i)
        say(fmt::format("output {}: {}\n", i, watch.outputs()[i]->description()));
    if (!watch.caster().empty()) say(fmt::format("caster: {}\n", watch.caster()));
    if (!watch.mavlink().empty()) say(fmt::format("mavlink: {}\n", watch.mavlink()));
}

int run_live(const RunOptions& options) {
    const Messages messages(options.verbosity);
    const auto scenario = scenario_from(options);
    if (!scenario) return messages.error(scenario.error());
    catch_stop_signals();
    RunMode mode;
    mode.virtual_time = std::isinf(scenario->run.speed);
    mode.now = wall_clock();
    mode.now_steady_ns = steady_clock_ns();
    if (!options.record.empty()) mode.record = options.record;
    CommandQueue commands;
    mode.live_commands = &commands;
    if (!options.repeat.empty()) mode.repeat = options.repeat;
    const auto watchdog = watch_power(*scenario, mode);
    if (!watchdog) return messages.error(watchdog.error());
    mode.power_watchdog = watchdog->get();
    const auto orphans = watch_probes(*scenario, mode);
    auto assembly = assemble(*scenario, data_folders(), mode);
    if (!assembly) return messages.error(with_other_mistakes(assembly.error(), *scenario, data_folders(), mode.now));

    const auto waiting = options.mavlink.empty() ? vehicle_warning(*scenario) : std::nullopt;
    if (waiting) assembly->warnings.push_back(*waiting);
    const bool alone = !mode.virtual_time && options.control.empty();
    if (const auto warning = alone ? pause_warning(*scenario) : std::nullopt) assembly->warnings.push_back(*warning);
    if (!mode.virtual_time && options.priority == "auto") assembly->deadlines = keep_deadlines(messages);
    const auto watch =
        RunWatch::start(*scenario, *assembly,
                        {options.control, options.token, options.mavlink, !mode.virtual_time, orphans.get()}, commands);
    if (!watch) return messages.error(watch.error());
    RunSession session(messages, *assembly);
    say_where(session, assembly->emulator->stations(), **watch);
    session.await_feeds();
    if (options.wait_for_client) session.await_clients();
    return session.run(*scenario, **watch);
}

}  // namespace

Action add_run_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("run", "Stream in real time until stopped");
    auto options = std::make_shared<RunOptions>();
    add_run_options(*command, *options);
    options->keys.add(*command, "--speed", "run.speed", {}, ", or max");
    command
        ->add_option("--priority", options->priority,
                     "Of the loop on this machine: auto (real-time where allowed), normal")
        ->check(CLI::IsMember({"auto", "normal"}));
    command->add_flag("--wait-for-client", options->wait_for_client, "Time begins when each port has a client");
    options->keys.add(*command, "--corrections", "receiver.0.corrections");
    options->keys.add(*command, "--caster", "caster.listen");
    command->add_option("--control", options->control,
                        "HTTP control and the live page: [HOST:]PORT, on 127.0.0.1 unless a host is given");
    command->add_option("--token", options->token, "That clients of --control must show; made at random off loopback")
        ->needs("--control");
    command->add_option("--mavlink", options->mavlink,
                        "Speak MAVLink with the vehicle and its ground stations: udp:[HOST:]PORT listens, on 127.0.0.1 "
                        "unless a host is given, udpout:HOST:PORT speaks first");
    command->add_option("--record", options->record, "Keep truth, fixes, satellites and bytes in this folder");
    return [options] { return run_live(*options); };
}

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

namespace {

void print_receiver(const ReceiverEntry& entry, const Station& station, bool of_several) {
    const firmware::Receiver& receiver = station.receiver();
    fmt::print("receiver    {}{} at {} baud, {:g} Hz\n", of_several ? station.name() + ": " : "", receiver.board().name,
               first_baud(receiver), 1e9 / static_cast<double>(receiver.settings().navigation_period.count()));
    for (const std::string& port : entry.ports)
        fmt::print("port        {}\n", port);
    if (!entry.corrections.empty()) fmt::print("corrections {}\n", without_secrets(entry.corrections));
    if (!entry.power.empty()) fmt::print("power       {}\n", entry.power);
}

// Without an end, what the first hour brings.
void print_timeline(const Scenario& scenario, const Assembly& assembly) {
    const std::vector<TimelineEntry> entries = timeline_of(scenario);
    const Seconds span = scenario.run.duration.value_or(Seconds(3600));
    if (!entries.empty()) fmt::print("timeline\n");
    const TimelineSpan run{assembly.start, advanced(assembly.start, span), scenario.run.seed};
    for (const std::string& line : timeline_text(entries, run))
        fmt::print("  {}\n", line);
    for (const Expectation& expectation : scenario.expectations)
        fmt::print("expect      {}\n", on_a_terminal(expectation.title()));
}

void print_plan(const Scenario& scenario, const Assembly& assembly) {
    const Emulator& emulator = *assembly.emulator;
    fmt::print("scenario    {}\n", scenario.name);
    fmt::print("navigation  {}\n", emulator.simulation().navigation().description());
    if (const auto span = emulator.simulation().navigation().span())
        fmt::print("            orbits from {} to {}\n", utc_text(span->first), utc_text(span->last));
    fmt::print("start       {}\n", utc_text(assembly.start));
    fmt::print("end         {}\n", assembly.end ? utc_text(*assembly.end) : "when stopped");
    fmt::print("model       {}\n", model_name(scenario.model));
    if (!assembly.trajectory.empty()) fmt::print("trajectory  {}\n", assembly.trajectory);
    for (const std::string& found : assembly.track_details)
        fmt::print("            {}\n", found);
    if (assembly.scene.scene) fmt::print("scene       {}\n", assembly.scene.description);
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i)
        print_receiver(scenario.receivers[i], emulator.stations()[i], scenario.receivers.size() > 1);
    for (const OutputSettings& output : scenario.outputs)
        fmt::print("output      {}\n", output.uri);
    if (!scenario.caster.listen.empty()) fmt::print("caster      {}\n", scenario.caster.listen);
    fmt::print("seed        {}\n", scenario.run.seed);
    print_timeline(scenario, assembly);
}

int check(const RunOptions& options) {
    const Messages messages(options.verbosity);
    const auto scenario = scenario_from(options);
    if (!scenario) return messages.error(scenario.error());
    if (const auto columns = result_columns(*scenario, {}); !columns) return messages.error(columns.error());
    RunMode mode;
    mode.now = wall_clock();
    mode.now_steady_ns = steady_clock_ns();
    mode.virtual_time = true;
    mode.open_ports = false;
    mode.only_checked = true;
    auto assembly = assemble(*scenario, data_folders(), mode);
    if (!assembly) return messages.error(with_other_mistakes(assembly.error(), *scenario, data_folders(), mode.now));
    if (const auto caster = RunCaster::check(*scenario, *assembly, {data_folders(), SKYLOOP_VERSION}); !caster)
        return messages.error(caster.error());
    for (const auto& warning : {vehicle_warning(*scenario), pause_warning(*scenario)})
        if (warning) assembly->warnings.push_back(*warning);
    messages.warnings(assembly->warnings);
    if (!options.verbosity.quiet) print_plan(*scenario, *assembly);
    return 0;
}

}  // namespace

Action add_check_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("check", "Read everything that a run would read, say what is wrong, run nothing");
    auto options = std::make_shared<RunOptions>();
    add_run_options(*command, *options);
    return [options] { return check(*options); };
}

}  // namespace skyloop::host
