#include <fmt/format.h>

#include <cstdio>

#include "base/core/terminal_text.hpp"
#include "base/time/utc_time.hpp"
#include "campaigns/campaign/campaign_run.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "run/emulator/scenario_mistakes.hpp"
#include "run/fault/planned_events.hpp"
#include "run_session.hpp"

namespace skyloop::host {
namespace {

std::string utc_text(GpsTime time) { return format_utc(to_utc(time, LeapSeconds::announced()), 0); }

void print_receiver(const ReceiverEntry& entry, const Station& station, bool of_several) {
    const firmware::Receiver& receiver = station.receiver();
    fmt::print("receiver    {}{} at {} baud, {:g} Hz\n", of_several ? station.name() + ": " : "", receiver.board().name,
               first_baud(receiver), 1e9 / static_cast<double>(receiver.settings().navigation_period.count()));
    for (const std::string& port : entry.ports)
        fmt::print("port        {}\n", port);
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
    for (const auto& warning : {vehicle_warning(*scenario), pause_warning(*scenario)})
        if (warning) assembly->warnings.push_back(*warning);
    for (const std::string& warning : assembly->warnings)
        messages.warning(warning);
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
