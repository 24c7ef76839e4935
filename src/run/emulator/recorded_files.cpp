#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/core/files.hpp"
#include "base/core/json.hpp"
#include "detail/recorded_files.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/run_files.hpp"
#include "run/scenario/board_files.hpp"

namespace skyloop::inline run {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view once_a_recording[] = {"fixes.csv",      "satellites.csv", "observations.rnx",
                                                 "navigation.rnx", "commands.jsonl", "verdicts.json",
                                                 "junit.xml",      "run.json"};
constexpr std::string_view once_a_port[] = {".out", ".in", ".times", ".in_times"};

}  // namespace

fs::path recording_of(const fs::path& folder, std::size_t receiver) {
    return receiver == 0 ? folder : folder / fmt::format("receiver{}", receiver);
}

bool is_recorded_name(std::string_view name) {
    if (std::find(std::begin(once_a_recording), std::end(once_a_recording), name) != std::end(once_a_recording))
        return true;
    if (!name.starts_with("port")) return false;
    const std::size_t end = std::min(name.find_first_not_of("0123456789", 4), name.size());
    return end > 4 &&
           std::find(std::begin(once_a_port), std::end(once_a_port), name.substr(end)) != std::end(once_a_port);
}

bool holds_recording(const fs::path& folder) {
    std::error_code absent;
    if (!fs::exists(folder / "run.json", absent)) return false;
    const auto text = read_text_file(folder / "run.json");
    const auto summary = text ? JsonData::parse(*text, nullptr, false) : JsonData();
    return summary.is_object() && summary.contains("program") && summary["program"] == "skyloop";
}

void remove_recordings_from(const fs::path& folder, std::size_t receiver) {
    std::error_code reason;
    for (; fs::is_directory(recording_of(folder, receiver), reason); ++receiver) {
        const auto claimed = ClaimedFolder::claim(recording_of(folder, receiver));
        if (!claimed) continue;  // another run records there
        std::vector<fs::path> files;
        for (const fs::directory_entry& there : fs::directory_iterator(claimed->path(), reason))
            if (is_recorded_name(there.path().filename().string())) files.push_back(there.path());
        for (const fs::path& file : files)
            fs::remove(file, reason);
        fs::remove(claimed->path(), reason);  // refused by the system where there is anything else
    }
}

Result<void> spare_inputs_and_recording(const std::vector<WireEnd>& ends, const SparedFiles& spared_files,
                                        const std::optional<fs::path>& folder) {
    const auto recorded = [&](const fs::path& place) {
        for (std::size_t i = 0; folder && i < spared_files.receivers; ++i)
            if (fs::absolute(recording_of(*folder, i)).lexically_normal() / place.filename() == place) return true;
        return false;
    };
    for (const WireEnd& end : ends) {
        if (end.place.empty() || end.place == "-") continue;
        const std::string writer = fmt::format("{}{} '{}'", end.told_at, end.owner, end.uri);
        if (const auto spared = check_spares(writer, end.place, spared_files.inputs); !spared) return spared;
        if (is_recorded_name(fs::path(end.place).filename().string()) && recorded(end.place))
            return fail(ErrorCode::usage,
                        fmt::format("{}: this file belongs to the recording; expected another place", writer));
    }
    return {};
}

Result<void> spare_inputs(const SparedFiles& spared_files, const fs::path& folder) {
    std::error_code absent;
    for (std::size_t i = 0; i < spared_files.receivers; ++i)
        for (const fs::directory_entry& there : fs::directory_iterator(recording_of(folder, i), absent)) {
            if (!is_recorded_name(there.path().filename().string())) continue;
            for (const fs::path& input : spared_files.inputs)
                if (fs::equivalent(there.path(), input, absent))
                    return fail(
                        ErrorCode::usage,
                        fmt::format("{}: the run reads this file, and its recording would take the place of it; "
                                    "expected another folder than {}",
                                    input.string(), folder.string()));
        }
    return {};
}

namespace {

void add_track_file(const TrajectorySettings& way, std::vector<InputFile>& files) {
    if (const auto* file = std::get_if<FileSettings>(&way)) files.push_back({file->path});
}

void add_world_files(const Scenario& scenario, std::vector<InputFile>& files) {
    const PreciseFiles& precise = scenario.sky.precise;
    for (const auto* paths : {&scenario.sky.navigation, &precise.orbits, &precise.clocks, &precise.biases})
        for (const auto& file : *paths)
            files.push_back({file});
    if (!precise.antennas.empty()) files.push_back({precise.antennas});
    if (const auto& maps = scenario.model.modern.ionosphere_maps; !maps.empty()) files.push_back({maps});
    if (!scenario.tec_maps.empty()) files.push_back({scenario.tec_maps});
    for (const auto& table : scenario.model.modern.tables)
        files.push_back({table});
    for (const auto& file : scenario.scene.buildings)
        files.push_back({file, false});
    if (!scenario.scene.terrain.empty()) files.push_back({scenario.scene.terrain, false});
}

void add_receiver_files(const Scenario& scenario, const DataFolders& data, std::vector<InputFile>& files) {
    std::set<std::string_view> boards;
    for (const ReceiverEntry& receiver : scenario.receivers) {
        if (receiver.trajectory) add_track_file(*receiver.trajectory, files);
        if (!receiver.state_file.empty()) files.push_back({receiver.state_file});
        if (!boards.insert(receiver.board).second) continue;
        // Its own, whether it can be read or not, and those of the boards that it extends.
        const auto folders = board_folders(data);
        if (const auto file = find_board_file(receiver.board, folders)) files.push_back({*file});
        if (const auto board = find_board(receiver.board, folders))
            for (const std::string& parent : std::span(board->files).subspan(1))
                files.push_back({parent});
    }
}

// Of a recording what --repeat reads of it.
bool is_repeated_name(std::string_view name) {
    return name == "run.json" || name == "commands.jsonl" ||
           (is_recorded_name(name) && (name.ends_with(".in") || name.ends_with(".in_times")));
}

void add_repeated_files(const std::filesystem::path& folder, std::size_t receivers, std::vector<InputFile>& files) {
    std::error_code absent;
    for (std::size_t i = 0; i < receivers; ++i)
        for (const auto& there : std::filesystem::directory_iterator(recording_of(folder, i), absent))
            if (is_repeated_name(there.path().filename().string())) files.push_back({there.path(), false});
}

}  // namespace

std::vector<InputFile> input_files(const Scenario& scenario, const DataFolders& data,
                                   const std::optional<std::filesystem::path>& repeat) {
    std::vector<InputFile> files{{scenario.name, false}};
    if (!scenario.trajectory_file.empty()) files.push_back({scenario.trajectory_file, false});
    add_track_file(scenario.trajectory, files);
    add_world_files(scenario, files);
    add_receiver_files(scenario, data, files);
    if (repeat) add_repeated_files(*repeat, scenario.receivers.size(), files);
    return files;
}

}  // namespace skyloop::inline run
