#include "run_log.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/core/text_file.hpp"
#include "run/control/command_json.hpp"

namespace skyloop::host {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* log_name = "commands.jsonl";

Json line_at(GpsTime now, GpsTime start) {
    return {{"gps_ns", now.time_since_epoch().count()}, {"time_s", difference(now, start).value()}};
}

void write_line(OutputFile& file, const Json& line) {
    file.write(line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
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

}  // namespace skyloop::host
