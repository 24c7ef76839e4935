#include "run_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/core/files.hpp"
#include "base/core/json.hpp"
#include "data_folders.hpp"
#include "file_streams.hpp"
#include "run/control/command_json.hpp"
#include "run/control/status_json.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/real_time.hpp"
#include "run/fault/timeline.hpp"
#include "run/verdict/reports.hpp"

namespace skyloop::host {
namespace {

constexpr const char* log_name = "commands.jsonl";

Json line_at(GpsTime now, GpsTime start) {
    return {{"gps_ns", now.time_since_epoch().count()}, {"time_s", difference(now, start).value()}};
}

void write_line(OutputFile& file, const Json& line) {
    file.write(json_text(line) + "\n");
    // A line is rare, and what a killed run leaves behind should hold it.
    file.flush();
}

// One line of the log; nothing for what is no live command.
Result<std::optional<CommandEntry>> live_command(std::string_view text) {
    const Json line = Json::parse(text, nullptr, false);
    if (!line.is_object()) return fail(ErrorCode::input, "is no JSON object");
    if (line.value("event", "") != "command" || line.value("source", "") == "scenario") return std::nullopt;
    if (!line.contains("gps_ns") || !line["gps_ns"].is_number_integer() || !line.contains("request"))
        return fail(ErrorCode::input, "expected gps_ns and request");
    auto command = command_from_json(line["request"].dump(), "repeated");
    if (!command) return fail(command.error());
    CommandEntry entry;
    entry.when.once = true;
    entry.when.at_time = GpsTime(Nanoseconds(line["gps_ns"].get<std::int64_t>()));
    entry.command = std::move(*command);
    return entry;
}

Result<void> add_live_commands(const std::filesystem::path& path, Scenario& scenario) {
    const auto text = read_text_file(path);
    if (!text) return fail(text.error());
    std::size_t number = 0;
    for (std::size_t at = 0; at < text->size();) {
        const std::size_t end = text->find('\n', at);
        // A run that was killed may have left half a line behind.
        if (end == std::string::npos) break;
        ++number;
        auto entry = live_command(std::string_view(*text).substr(at, end - at));
        at = end + 1;
        if (!entry)
            return fail(ErrorCode::input, fmt::format("{}:{}: {}", path.string(), number, entry.error().message));
        if (!*entry) continue;
        (*entry)->when.name = fmt::format("repeated {}", number);
        scenario.commands.push_back(std::move(**entry));
    }
    return {};
}

}  // namespace

Result<RunLog> RunLog::create(const std::filesystem::path& folder, GpsTime start) {
    auto file = OutputFile::create(folder / log_name);
    if (!file) return fail(file.error());
    return RunLog(std::move(*file), start);
}

void RunLog::on_fault(const FaultSeen& seen) {
    Json line = line_at(seen.now, start_);
    line["event"] = seen.begins ? "fault_begins" : "fault_ends";
    line["name"] = seen.name;
    line["kind"] = seen.kind;
    line["occurrence"] = seen.occurrence;
    write_line(file_, line);
}

void RunLog::on_command(const CommandSeen& seen) {
    Json line = line_at(seen.now, start_);
    line["event"] = "command";
    line["name"] = seen.name;
    line["source"] = seen.command.source;
    if (!seen.ignored.empty()) line["ignored"] = seen.ignored;
    line["request"] = Json::parse(command_json(seen.command));
    write_line(file_, line);
}

void RunLog::on_belief(const BeliefSeen& seen) {
    Json line = line_at(seen.now, start_);
    line["event"] = seen.trusts ? "client_trusts" : "client_distrusts";
    line["station"] = seen.station;
    line["wire"] = seen.wire;
    line["reason"] = seen.reason;
    write_line(file_, line);
}

Result<void> repeat_run(const std::filesystem::path& folder, Scenario& scenario) {
    const std::filesystem::path path = folder / "run.json";
    const auto text = read_text_file(path);
    if (!text) return fail(text.error());
    const Json summary = Json::parse(*text, nullptr, false);
    if (!summary.is_object() || !summary.contains("start_gps_ns") || !summary["start_gps_ns"].is_number_integer())
        return fail(ErrorCode::input, fmt::format("{}: expected start_gps_ns", path.string()));
    if (std::error_code unknown; !std::filesystem::exists(folder / log_name, unknown) && !unknown)
        return fail(ErrorCode::input,
                    fmt::format("{}: has no {}, as a run that another program led (skyloop.h); expected a recording of "
                                "skyloop run or simulate; skyloop replay plays this one",
                                folder.string(), log_name));
    scenario.run.start = GpsTime(Nanoseconds(summary["start_gps_ns"].get<std::int64_t>()));
    return add_live_commands(folder / log_name, scenario);
}

namespace {

constexpr int expectations_not_met = 3;
constexpr std::size_t most_planned_events = 10'000;  // that are looked at: what comes every millisecond comes for ever

// What displays show of them. @param going_on the run: what is undecided is pending
std::vector<VerdictStatus> verdict_states(const std::vector<Verdict>& verdicts, bool going_on) {
    std::vector<VerdictStatus> states;
    for (const Verdict& verdict : verdicts) {
        const bool pending = going_on && verdict.outcome == Outcome::undecided;
        states.push_back({verdict.name, verdict.expected,
                          pending ? "pending" : std::string(outcome_name(verdict.outcome)), verdict.evidence});
    }
    return states;
}

// A port or an output writes to standard output, where a sentence would be garbage among its bytes.
bool fills_standard_output(const Scenario& scenario, const Emulator& emulator) {
    for (const Station& station : emulator.stations())
        for (const Wire& wire : station.wires())
            if (wire.link.transport().description() == "standard output") return true;
    return std::any_of(scenario.outputs.begin(), scenario.outputs.end(), [](const OutputSettings& output) {
        return output.way == OutputWay::file && output.path == "-";
    });
}

}  // namespace

Result<std::unique_ptr<RunWatch>> RunWatch::start(const Scenario& scenario, Assembly& assembly,
                                                  const WatchOptions& options, CommandQueue& commands) {
    std::unique_ptr<RunWatch> watch(new RunWatch(scenario, assembly));
    watch->appoint_judge(options);
    if (const auto opened = watch->open_control(options, commands); !opened) return fail(opened.error());
    if (const auto opened = watch->open_mavlink(options.mavlink, commands); !opened) return fail(opened.error());
    if (const auto opened = watch->open_outputs(options.live); !opened) return fail(opened.error());
    if (const auto opened = watch->open_caster(options.live); !opened) return fail(opened.error());
    // After everything that may be refused: it empties the files of a former run.
    if (const auto begun = watch->begin(); !begun) return fail(begun.error());
    return watch;
}

Result<void> RunWatch::begin() {
    Emulator& emulator = *assembly_.emulator;
    if (const auto begun = emulator.begin(); !begun) return begun;
    for (const auto& output : outputs_)
        output->begin();
    if (emulator.recorder() == nullptr) return {};
    // Before anybody is waited for: a run that is killed then has been recorded, too.
    emulator.recorder()->record_summary(run_summary(scenario_, assembly_, SKYLOOP_VERSION, SummaryOf::beginning));
    auto log = RunLog::create(emulator.recorder()->folder(), assembly_.start);
    if (!log) return fail(log.error());
    log_.emplace(std::move(*log));
    emulator.add_observer(&*log_);
    return {};
}

void RunWatch::appoint_judge(const WatchOptions& options) {
    if (scenario_.expectations.empty()) return;
    Emulator& emulator = *assembly_.emulator;
    judge_ = std::make_unique<Judge>(scenario_.expectations,
                                     JudgedRun{assembly_.start, receiver_names(emulator), options.live,
                                               probe_environment(emulator), options.orphans});
    emulator.add_observer(judge_.get());
}

std::vector<TimelineBar> RunWatch::planned_bars() const {
    std::vector<TimelineBar> bars;
    for (const FaultEntry& fault : scenario_.faults) {
        TimelineBar bar;
        bar.name = fault.when.name;
        bar.kind = fault.kind;
        bars.push_back(std::move(bar));
    }
    for (const CommandEntry& command : scenario_.commands) {
        TimelineBar bar;
        bar.name = command.when.name;
        bar.kind = command_name(command.command.verb);
        bar.command = true;
        bars.push_back(std::move(bar));
    }
    // What is known of their times before the run.
    const GpsTime end = assembly_.end.value_or(advanced(assembly_.start, Seconds(3600)));
    const std::vector<TimelineEvent> events =
        planned_events(timeline_of(scenario_), {assembly_.start, end, scenario_.run.seed}, most_planned_events);
    for (const TimelineEvent& event : events)
        if (event.occurrence == 1) (event.begins ? bars[event.entry].begins : bars[event.entry].ends) = event.time;
    return bars;
}

Result<void> RunWatch::open_control(const WatchOptions& options, CommandQueue& commands) {
    if (options.control.empty()) return {};
    auto where = parse_control_address(options.control);
    if (!where) return fail(where.error());
    where->token = options.token;
    Emulator& emulator = *assembly_.emulator;
    StatusSources sources;
    sources.pace = [&emulator, live = options.live] {
        return PaceStatus{emulator.paused(), emulator.director().speed(), !live};
    };
    sources.strength = [&emulator](std::string_view fault, int occurrence, GpsTime now) {
        return emulator.director().strength(fault, occurrence, now, emulator.stations());
    };
    if (judge_)
        sources.verdicts = [this] { return verdict_states(verdicts_ ? *verdicts_ : judge_->so_far(), !verdicts_); };
    sources.caster = [this]() -> std::optional<CasterStatus> {
        if (!caster_) return std::nullopt;
        const NtripCasterCounts c = caster_->counts();
        return CasterStatus{caster_->description(), c.clients, c.served, c.refused, c.slow};
    };
    StatusSetup setup{scenario_.name, assembly_.start, assembly_.end, planned_bars()};
    setup.every_epoch = options.live || (emulator.feeds() != nullptr && emulator.feeds()->leads());
    board_ = std::make_unique<StatusBoard>(std::move(setup), &emulator.stations(), sources);
    emulator.add_observer(board_.get());
    emulator.on_look([this](GpsTime now) { board_->look(now); });
    const std::string scene = assembly_.scene.scene ? scene_json(*assembly_.scene.scene) : std::string();
    auto server = ControlServer::start(
        *where, {commands, *board_, scene, SKYLOOP_VERSION, receiver_names(emulator), !scenario_.model.sensor_model});
    if (!server) return fail(server.error());
    server_ = std::move(*server);
    return {};
}

Result<void> RunWatch::open_mavlink(const std::string& address, CommandQueue& commands) {
    if (address.empty()) return {};
    const auto where = parse_mavlink_address(address);
    if (!where) return fail(where.error());
    MavlinkParts parts{receiver_names(*assembly_.emulator),
                       [&commands](Command command) { return commands.push(std::move(command)); }, background_thread};
    auto endpoint = MavlinkEndpoint::start(*where, std::move(parts));
    if (!endpoint) return fail(endpoint.error());
    mavlink_ = std::move(*endpoint);
    return {};
}

Result<void> RunWatch::open_outputs(bool live) {
    Emulator& emulator = *assembly_.emulator;
    for (const OutputSettings& settings : scenario_.outputs) {
        OutputParts parts;
        parts.receivers = receiver_names(emulator);
        parts.due_ns = [&emulator](GpsTime time) { return emulator.pacer().due_at(time); };
        parts.sources = {&emulator.simulation().navigation(), SKYLOOP_VERSION};
        parts.waits_for_readers = !live;
        auto output = RunOutput::open(settings, std::move(parts));
        if (!output) return fail(output.error());
        outputs_.push_back(std::move(*output));
        emulator.add_observer(outputs_.back().get());
    }
    return {};
}

// What others are told belongs to a live run.
Result<void> RunWatch::open_caster(bool live) {
    if (scenario_.caster.listen.empty() || !live) return {};
    auto caster = RunCaster::start(scenario_, assembly_, {data_folders(), SKYLOOP_VERSION});
    if (!caster) return fail(caster.error());
    caster_ = std::move(*caster);
    if (std::string warning = caster_->warning(); !warning.empty()) assembly_.warnings.push_back(std::move(warning));
    return {};
}

std::vector<std::string> RunWatch::take_news() {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < outputs_.size(); ++i)
        for (const std::string& news : outputs_[i]->take_news())
            all.push_back(fmt::format("output {}: {}", i, news));
    return all;
}

bool RunWatch::serves() const {
    const Emulator& emulator = *assembly_.emulator;
    const bool led = emulator.feeds() != nullptr && emulator.feeds()->leads();
    return led || server_ || caster_ || mavlink_ || judge_ || emulator.stations().front().recorder() != nullptr ||
           std::any_of(outputs_.begin(), outputs_.end(), [](const auto& output) { return output->failure().empty(); });
}

void RunWatch::finish_outputs() {
    for (const auto& output : outputs_) {
        output->finish();
        assembly_.outputs.push_back({output->description(), output->counts()});
    }
    if (caster_) assembly_.caster = CasterSummary{caster_->description(), caster_->counts()};
}

int RunWatch::finish(const Messages& messages, RunEnd end) {
    const GpsTime now = assembly_.emulator->now();
    if (judge_) verdicts_ = judge_->finish(now, end);
    if (board_) board_->publish_now(now);
    int code = 0;
    if (verdicts_) code = report(messages, *verdicts_);
    server_.reset();
    mavlink_.reset();
    if (log_ && log_->failure()) code = messages.error(*log_->failure());
    return code;
}

int RunWatch::report(const Messages& messages, const std::vector<Verdict>& verdicts) const {
    const Emulator& emulator = *assembly_.emulator;
    ReportedRun run{
        scenario_.name, scenario_.run.seed, assembly_.start, difference(emulator.now(), assembly_.start), {}};
    const Recorder* recorder = emulator.stations().front().recorder();
    if (recorder != nullptr) run.evidence = {"fixes.csv", "port0.out", "port0.in", "commands.jsonl"};
    fmt::print(fills_standard_output(scenario_, emulator) ? stderr : stdout, "{}", verdict_text(verdicts, run));
    int code = is_success(verdicts) ? 0 : expectations_not_met;
    if (recorder == nullptr) return code;
    for (const auto& [name, text] :
         {std::pair{"verdicts.json", verdict_json(verdicts, run)}, {"junit.xml", junit_xml(verdicts, run)}})
        if (const auto written = write_whole_file(recorder->folder() / name, text); !written)
            code = messages.error(written.error());
    return code;
}

}  // namespace skyloop::host
