#include "detail/input_files.hpp"

#include <set>
#include <string>
#include <string_view>
#include <system_error>

#include "detail/recorded_files.hpp"
#include "run/emulator/assembly.hpp"
#include "run/scenario/board_file.hpp"

namespace skyloop {
namespace {

void add_track_file(const TrajectorySettings& way, std::vector<InputFile>& files) {
    if (const auto* file = std::get_if<FileSettings>(&way)) files.push_back({file->path});
}

void add_world_files(const Scenario& scenario, std::vector<InputFile>& files) {
    for (const auto& file : scenario.sky.navigation)
        files.push_back({file});
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
        if (const auto board = find_board_file(receiver.board, board_folders(data))) files.push_back({*board});
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

}  // namespace skyloop
