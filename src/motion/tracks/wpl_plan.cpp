#include <fmt/format.h>

#include <cmath>

#include "base/core/letter_case.hpp"
#include "detail/mission_items.hpp"
#include "detail/text_track.hpp"

namespace skyloop {
namespace {

constexpr std::string_view wpl_mark = "QGC WPL ";

// Plain text of missions (MAVLink developer guide, File Formats, Mission Plain-Text File Format): a line for each item,
// parted by tabs, or by blanks as some programs write. The item of the index 0 above the sea is home, as Mission
// Planner and ArduPilot count.
class WplReader {
public:
    explicit WplReader(const TrackFile& file) : file_(file) {}
    Result<Track> read();

private:
    Result<void> take_line(std::string_view line, std::size_t number);
    [[nodiscard]] tl::unexpected<Error> refusal(std::size_t line, const std::string& what) const {
        return fail(ErrorCode::input, fmt::format("{}:{}: {}", file_.name, line, one_line_of(what)));
    }

    const TrackFile& file_;
    Mission mission_;
    std::vector<std::string_view> cells_;
};

Result<void> WplReader::take_line(std::string_view line, std::size_t number) {
    constexpr std::size_t columns = 12;
    constexpr double most = 65535;
    split_table_line(line, ' ', cells_);
    if (cells_.size() < columns)
        return refusal(number, fmt::format("{} columns; expected {}: index, current, frame, command, four parameters, "
                                           "latitude, longitude, height, autocontinue",
                                           cells_.size(), columns));
    std::array<double, columns> values{};
    for (std::size_t i = 0; i < columns; ++i) {
        const auto value = text_number(cells_[i]);
        const bool whole = i < 4;
        const bool open = i >= 4 && i < 8 && lower_case(cells_[i]) == "nan";
        if (!value && !open)
            return refusal(number, fmt::format("column {} is '{}'; expected a number", i + 1, cells_[i].substr(0, 40)));
        values.at(i) = value.value_or(0);
        if (whole && (values.at(i) < 0 || values.at(i) > most || values.at(i) != std::floor(values.at(i))))
            return refusal(number, fmt::format("column {} is '{}'; expected a whole number of 0 to {:g}", i + 1,
                                               cells_[i].substr(0, 40), most));
    }
    MissionItem item;
    item.number = static_cast<std::size_t>(values[0]);
    item.frame = static_cast<int>(values[2]);
    item.command = static_cast<int>(values[3]);
    for (std::size_t i = 0; i < item.parameters.size(); ++i)
        item.parameters.at(i) = values.at(4 + i);
    constexpr int waypoint = 16, above_sea = 0;
    if (item.number == 0 && mission_.items.empty() && item.command == waypoint && item.frame == above_sea) {
        if (values[8] != 0 || values[9] != 0) mission_.home = MissionHome{values[8], values[9], values[10]};
        return {};
    }
    mission_.items.push_back(item);
    return {};
}

Result<Track> WplReader::read() {
    TextLines lines(file_.text);
    lines.next();
    const std::string_view version = trimmed_cell(lines.line().substr(wpl_mark.size()));
    if (version != "110" && version != "120")
        return refusal(
            1, fmt::format("a mission of the version '{}'; expected QGC WPL 110 or 120", version.substr(0, 20)));
    mission_.format = fmt::format("QGC WPL {}", version);
    while (lines.next()) {
        const std::string_view line = trimmed_cell(lines.line());
        if (line.empty() || line.starts_with('#')) continue;
        if (const auto taken = take_line(line, lines.number()); !taken) return fail(taken.error());
    }
    return track_of_mission(file_, mission_);
}

}  // namespace

bool is_wpl(const TrackFile& file) {
    TextLines lines(file.text);
    return lines.next() && lines.line().starts_with(wpl_mark);
}

Result<Track> read_wpl(const TrackFile& file) { return WplReader(file).read(); }

}  // namespace skyloop
