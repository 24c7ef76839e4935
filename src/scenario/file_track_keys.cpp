#include "trajectory_kinds.hpp"

#include <array>

namespace skyloop {

void read_file_track(TableReader& table, const std::filesystem::path& folder, TrajectorySettings& trajectory) {
    static constexpr std::array<std::string_view, 2> clocks{"run", "recorded"};
    FileSettings file;
    file.heading = read_heading(table);
    std::string path;
    table.text("path", path);
    table.needs_one_of({"path"}, "kind \"file\" has no path; expected path = \"track.csv\"");
    file.path = folder / path;
    file.keeps_time = table.choice("time", clocks, clocks[0]).value_or(0) == 1;
    table.quantity("gap_s", file.gap, {1e-3, 1e7});
    file.origin = table.place("origin");
    trajectory = file;
}

}  // namespace skyloop
