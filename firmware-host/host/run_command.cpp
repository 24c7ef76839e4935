#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/core/say.hpp"
#include "base/core/watchdog_process.hpp"
#include "base/time/utc_time.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "run/emulator/deadline_grants.hpp"
#include "run/emulator/scenario_mistakes.hpp"
#include "run_session.hpp"
#include "run_watch.hpp"

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
    if (mode.virtual_time || std::none_of(expectations.begin(), expectations.end(), asks)) return nullptr;
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

}  // namespace skyloop::host
