#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <thread>

#include "base/core/process.hpp"
#include "base/core/threads.hpp"
#include "detail/vehicle_run.hpp"

namespace skyloop::inline campaigns {
namespace {

// The words as a shell parts and unquotes them (IEEE Std 1003.1, Shell Command Language, 2.2 and 2.3), without those
// behind a >.
std::vector<std::string> words_read_in(std::string_view command) {
    std::vector<std::string> words;
    std::string word;
    bool written = false;
    char quote = 0;
    const auto end_word = [&] {
        if (word.empty()) return;
        if (!written) words.push_back(word);
        written = false;
        word.clear();
    };
    for (std::size_t i = 0; i < command.size(); ++i) {
        const char c = command[i];
        if (quote != 0 && c == quote) {
            quote = 0;
        } else if (quote == 0 && (c == '\'' || c == '"')) {
            quote = c;
        } else if (quote != '\'' && c == '\\' && i + 1 < command.size()) {
            word += command[++i];
        } else if (quote == 0 && std::string_view(" \t\n;&|()<>").find(c) != std::string_view::npos) {
            end_word();
            if (c == '>') written = true;
        } else {
            word += c;
        }
    }
    end_word();
    return words;
}

bool is_program(const std::filesystem::path& file) {
    constexpr std::array<std::string_view, 3> endings{".py", ".sh", ".lua"};
    using std::filesystem::perms;
    std::error_code none;
    const auto status = std::filesystem::status(file, none);
    if (!std::filesystem::is_regular_file(status)) return false;
    if ((status.permissions() & (perms::owner_exec | perms::group_exec | perms::others_exec)) != perms::none)
        return true;
    if (std::find(endings.begin(), endings.end(), file.extension().string()) != endings.end()) return true;
    std::array<char, 2> first{};
    std::ifstream(file, std::ios::binary).read(first.data(), first.size());
    return first == std::array<char, 2>{'#', '!'};
}

}  // namespace

std::vector<std::string> programs_of_command(std::string_view command) {
    std::vector<std::string> programs = words_read_in(command);
    std::erase_if(programs,
                  [](const std::string& word) { return word.find('/') == std::string::npos || !is_program(word); });
    return programs;
}

namespace {

std::string with_places_filled(std::string text, const std::vector<std::pair<std::string, std::string>>& places) {
    for (const auto& [place, value] : places)
        for (std::size_t at = text.find(place); at != std::string::npos; at = text.find(place, at + value.size()))
            text.replace(at, place.size(), value);
    return text;
}

ProcessRequest request_of(const CampaignVehicle& vehicle, const PlannedRun& run, const std::string& pty,
                          Seconds timeout) {
    ProcessRequest request;
    request.command = {"/bin/sh", "-c",
                       with_places_filled(vehicle.command, {{"{pty}", pty},
                                                            {"{seed}", fmt::format("{}", run.seed)},
                                                            {"{number}", fmt::format("{}", run.number)}})};
    request.environment = {"SKYLOOP_PTY=" + pty, fmt::format("SKYLOOP_SEED={}", run.seed),
                           fmt::format("SKYLOOP_RUN={}", run.number)};
    request.timeout = timeout;
    request.output_limit = std::size_t{1} << 20;  // the last line of its errors is told
    return request;
}

// What the program said last; nothing where not all of it was kept.
std::string last_words(const ProcessOutcome& outcome) {
    constexpr std::size_t longest = 200;
    if (outcome.output_cut) return {};
    const std::string_view errors = outcome.errors;
    const std::size_t end = errors.find_last_not_of(" \t\r\n");
    if (end == std::string_view::npos) return {};
    const std::size_t before = errors.find_last_of("\r\n", end);
    const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
    std::string line(errors.substr(begin, std::min(end + 1 - begin, longest)));
    for (char& c : line)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    return line;
}

// What a shell says of a program that it cannot find or run (IEEE Std 1003.1, Shell Command Language, 2.8.2).
bool was_not_run(const ProcessOutcome& outcome) {
    constexpr int not_executable = 126, not_found = 127;
    return !outcome.timed_out && (outcome.exit_code == not_executable || outcome.exit_code == not_found);
}

}  // namespace

Result<Verdict> vehicle_verdict(const ProcessOutcome& outcome, Seconds timeout) {
    Verdict verdict{"vehicle", "exit code 0", Outcome::failed, {}, {}};
    if (outcome.timed_out) {
        verdict.evidence = fmt::format("did not end within {:g} s", timeout.value());
    } else if (outcome.exit_code) {
        if (*outcome.exit_code == 0) verdict.outcome = Outcome::passed;
        verdict.evidence = fmt::format("ended with exit code {}", *outcome.exit_code);
    } else {
        verdict.evidence = fmt::format("ended by signal {}", outcome.signal.value_or(0));
    }
    const std::string words = verdict.outcome == Outcome::passed ? std::string() : last_words(outcome);
    if (!words.empty()) verdict.evidence += ": " + words;
    if (was_not_run(outcome)) return fail(ErrorCode::outside, "vehicle: was not run: it " + verdict.evidence);
    return verdict;
}

Result<Verdict> run_with_vehicle(Assembly& assembly, const CampaignVehicle& vehicle, const PlannedRun& run,
                                 const VehicleWatch& watch) {
    Emulator& emulator = *assembly.emulator;
    const std::string description = emulator.wires().front().link.transport().description();
    const std::string pty = description.substr(0, description.rfind(" ("));
    constexpr Seconds grace{10};
    const Seconds length = assembly.end ? difference(*assembly.end, assembly.start) : Seconds(0);
    const Seconds timeout = vehicle.timeout > Seconds(0) ? vehicle.timeout : length + grace;
    ProcessRequest request = request_of(vehicle, run, pty, timeout);
    request.cancelled = [&watch] { return watch.stop.load(); };
    request.group = watch.process_group;
    std::atomic<bool> over = false;
    Result<ProcessOutcome> outcome = fail(ErrorCode::outside, "vehicle: was not started");
    std::thread beside;
    with_signals_held_back([&] {
        beside = std::thread([&] {
            outcome = run_process(request);
            over = true;
        });
    });
    emulator.run_until(assembly.end.value_or(GpsTime::max()), over);
    beside.join();
    if (!outcome) return fail(ErrorCode::outside, "vehicle: " + outcome.error().message);
    if (outcome->cancelled) return fail(ErrorCode::outside, "stopped before its end");
    return vehicle_verdict(*outcome, timeout);
}

}  // namespace skyloop::inline campaigns
