#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "base/core/files.hpp"
#include "base/time/utc_time.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "file_streams.hpp"
#include "messages.hpp"
#include "receiver/observed/log_events.hpp"
#include "run/emulator/assembly.hpp"
#include "run_options.hpp"

namespace skyloop::host {
namespace {

struct ScenarioFromOptions {
    std::string log, out = ".";
    std::size_t receiver = 0;
    double drop_db = 6, satellite_drop_db = 10, least_s = 3, satellite_least_s = 5;
    Verbosity verbosity;
};

void print_summary(const ObservedLog& log, const LogEvents& events, const LogScenario& made) {
    static constexpr std::string_view names[] = {"outages",    "silences",        "changes of the type of fix",
                                                 "C/N0 drops", "weak satellites", "lost satellites"};
    fmt::print("log         {}, {}{}\n", log.name, log.format, log.receiver.empty() ? "" : ", " + log.receiver);
    fmt::print("epochs      {} from {} to {}, every {:g} s, {} with a place\n", log.epochs.size(),
               utc_text(log.epochs.front().time, 3), utc_text(log.epochs.back().time, 3),
               to_seconds(events.period).value(), made.places);
    for (std::size_t kind = 0; kind < std::size(names); ++kind) {
        std::size_t count = 0;
        double seconds = 0;
        for (const LogEvent& event : events.events) {
            if (static_cast<std::size_t>(event.kind) != kind) continue;
            ++count;
            seconds += to_seconds(event.lasts).value();
        }
        if (count > 0) fmt::print("faults      {} {}, {:g} s together\n", count, names[kind], seconds);
    }
    if (events.events.empty()) fmt::print("faults      none: nothing went wrong in it\n");
}

int make_scenario(const ScenarioFromOptions& options) {
    const Messages messages(options.verbosity);
    constexpr std::size_t largest = std::size_t{1} << 30;
    const auto text = read_text_file(options.log, largest);
    if (!text) return messages.error(text.error());
    std::vector<std::string> warnings;
    const auto geoid = find_geoid(data_folders(), warnings);
    const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(text->data()), text->size());
    const auto log = read_observed(bytes, options.log, {geoid.get(), options.receiver});
    if (!log) return messages.error(log.error());
    EventLimits limits;
    limits.drop_db = options.drop_db;
    limits.satellite_drop_db = options.satellite_drop_db;
    limits.least = Seconds(options.least_s);
    limits.satellite_least = Seconds(options.satellite_least_s);
    const LogEvents events = find_events(*log, limits);
    const auto made = scenario_of_log(*log, events);
    if (!made) return messages.error(made.error());
    for (const auto* notes : {&log->notes, &events.notes})
        for (const std::string& note : *notes)
            messages.warning(log->name + ": " + note);
    const std::filesystem::path folder = options.out;
    std::vector<std::filesystem::path> files{folder / "scenario.toml"};
    if (!made->track.empty()) files.push_back(folder / "track.csv");
    if (const auto room = check_made_by("scenario-from", files); !room) return messages.error(room.error());
    if (const auto made_folder = make_folder(folder); !made_folder) return messages.error(made_folder.error());
    if (!made->track.empty())
        if (const auto done = write_whole_file(folder / "track.csv", made->track); !done)
            return messages.error(done.error());
    if (const auto done = write_whole_file(folder / "scenario.toml", made->scenario); !done)
        return messages.error(done.error());
    if (!options.verbosity.quiet) print_summary(*log, events, *made);
    if (!options.verbosity.quiet) fmt::print("written     {}\n", (folder / "scenario.toml").string());
    return 0;
}

}  // namespace

Action add_scenario_from_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("scenario-from", "Turn a receiver's log into a scenario that is like it");
    auto options = std::make_shared<ScenarioFromOptions>();
    command
        ->add_option("LOG", options->log,
                     "UBX, SBF, NMEA, PX4 ULog, ArduPilot DataFlash or RTKLIB .pos; packed (.gz, .zip, …) or not")
        ->required();
    command->add_option("--out", options->out, "Folder for scenario.toml and track.csv; default: this one");
    command->add_option("--gps", options->receiver, "Which receiver of an autopilot's log, from 0")
        ->check(CLI::Range(0, 9));
    command->add_option("--drop-db", options->drop_db, "From how many dB on a drop of all C/N0 counts; default 6")
        ->check(CLI::Range(1.0, 60.0));
    command
        ->add_option("--satellite-drop-db", options->satellite_drop_db,
                     "From how many dB on a drop of one satellite counts; default 10")
        ->check(CLI::Range(1.0, 60.0));
    command->add_option("--least", options->least_s, "Seconds that a drop of all lasts; default 3")
        ->check(CLI::Range(0.0, 1e6));
    command
        ->add_option("--satellite-least", options->satellite_least_s,
                     "Seconds that one satellite is weak or away; default 5")
        ->check(CLI::Range(0.0, 1e6));
    add_verbosity_options(*command, options->verbosity);
    return [options] { return make_scenario(*options); };
}

}  // namespace skyloop::host
