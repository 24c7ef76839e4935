#include <fmt/format.h>

#include <cmath>

#include "base/core/json.hpp"
#include "base/core/words.hpp"
#include "detail/mission_items.hpp"
#include "detail/text_track.hpp"

namespace skyloop::inline motion {
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

namespace {

const JsonData& plan_member(const JsonData& object, const char* key) {
    static const JsonData nothing;
    if (!object.is_object()) return nothing;
    const auto found = object.find(key);
    return found == object.end() ? nothing : *found;
}

std::optional<double> plan_number(const JsonData& value) {
    if (!value.is_number()) return std::nullopt;
    const double number = value.get<double>();
    return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

// Whole numbers of MAVLink; nothing for others.
std::optional<int> plan_whole(const JsonData& value) {
    const auto number = plan_number(value);
    constexpr double most = 65535;
    if (!number || *number != std::floor(*number) || *number < 0 || *number > most) return std::nullopt;
    return static_cast<int>(*number);
}

// QGroundControl's plan files (QGroundControl developer guide, Plan File Format; version 1 with missions of version 1
// and 2).
class PlanReader {
public:
    explicit PlanReader(const TrackFile& file) : file_(file) {}
    Result<Track> read();

private:
    [[nodiscard]] tl::unexpected<Error> refusal(const std::string& what) const {
        return fail(ErrorCode::input, fmt::format("{}: {}", file_.name, one_line_of(what)));
    }
    void take_head(const JsonData& mission);
    Result<void> take_item(const JsonData& item);
    Result<void> take_simple(const JsonData& item);
    Result<void> take_complex(const JsonData& item);
    Result<void> take_landing(const JsonData& item, const std::string& kind);
    static std::optional<std::array<double, 3>> three(const JsonData& place);

    const TrackFile& file_;
    Mission mission_;
    std::size_t number_ = 0;
};

std::optional<std::array<double, 3>> PlanReader::three(const JsonData& place) {
    if (!place.is_array() || place.size() < 3) return std::nullopt;
    std::array<double, 3> numbers{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto number = plan_number(place[i]);
        if (!number) return std::nullopt;
        numbers.at(i) = *number;
    }
    return numbers;
}

void PlanReader::take_head(const JsonData& mission) {
    if (const auto home = three(plan_member(mission, "plannedHomePosition")))
        mission_.home = MissionHome{(*home)[0], (*home)[1], (*home)[2]};
    const auto type = plan_whole(plan_member(mission, "vehicleType"));
    if (type) mission_.vehicle = vehicle_of_mav_type(*type);
    const bool vtol = type && is_vtol_mav_type(*type);
    if (vtol)
        mission_.notes.push_back(
            fmt::format("vehicleType {}, a VTOL: flown as a multirotor at its cruiseSpeed; vehicle "
                        "= \"plane\" flies it as a plane, which goes nowhere straight up",
                        *type));
    constexpr int generic = 0;
    if (type && *type != generic && !mission_.vehicle)
        mission_.notes.push_back(
            fmt::format("vehicleType {} is not known: the vehicle and its speed are not those of "
                        "the plan",
                        *type));
    const bool hovers = mission_.vehicle == VehicleClass::multirotor && !vtol;
    const auto speed = plan_number(plan_member(mission, hovers ? "hoverSpeed" : "cruiseSpeed"));
    constexpr double least_mps = 0.01, most_mps = 12000;
    if (mission_.vehicle && speed && *speed >= least_mps && *speed <= most_mps) mission_.speed_mps = *speed;
}

Result<void> PlanReader::take_simple(const JsonData& item) {
    const auto command = plan_whole(plan_member(item, "command")), frame = plan_whole(plan_member(item, "frame"));
    if (!command || !frame)
        return refusal(
            fmt::format("item {}: a SimpleItem without a command and a frame; expected whole numbers of 0 to "
                        "65535",
                        number_));
    MissionItem taken;
    taken.number = number_;
    taken.command = *command;
    taken.frame = *frame;
    const JsonData &params = plan_member(item, "params"), &place = plan_member(item, "coordinate");
    for (const JsonData* numbers : {&params, &place})
        for (const JsonData& value : *numbers)
            if (numbers->is_array() && value.is_string())
                return refusal(fmt::format("item {}: '{}' in its params; expected a number or null", number_,
                                           value.get<std::string>().substr(0, 40)));
    if (params.is_array()) {
        for (std::size_t i = 0; i < std::min(params.size(), taken.parameters.size()); ++i)
            taken.parameters.at(i) = plan_number(params[i]);
    } else if (place.is_array()) {
        for (std::size_t i = 0; i < 4; ++i)
            taken.parameters.at(i) = plan_number(plan_member(item, fmt::format("param{}", i + 1).c_str()));
        for (std::size_t i = 0; i < std::min<std::size_t>(place.size(), 3); ++i)
            taken.parameters.at(4 + i) = plan_number(place[i]);
    } else {
        return refusal(fmt::format("item {}: a SimpleItem without params; expected seven numbers", number_));
    }
    mission_.items.push_back(taken);
    return {};
}

// Where a landing begins and where it ends.
Result<void> PlanReader::take_landing(const JsonData& item, const std::string& kind) {
    const JsonData& newer = plan_member(item, "landingApproachCoordinate");
    const auto begins = three(newer.is_array() ? newer : plan_member(item, "loiterCoordinate"));
    const auto ends = three(plan_member(item, "landCoordinate"));
    if (!begins || !ends)
        return refusal(
            fmt::format("item {}: a {} without its places; expected landingApproachCoordinate and "
                        "landCoordinate",
                        number_, kind));
    const JsonData& relative = plan_member(item, "altitudesAreRelative");
    const int frame = relative.is_boolean() && !relative.get<bool>() ? 0 : 3;
    constexpr int waypoint = 16, land = 21;
    for (const auto& [command, place] : {std::pair(waypoint, *begins), std::pair(land, *ends)}) {
        MissionItem made;
        made.number = number_;
        made.command = command;
        made.frame = frame;
        for (std::size_t i = 0; i < 3; ++i)
            made.parameters.at(4 + i) = place.at(i);
        mission_.items.push_back(made);
    }
    return {};
}

// Surveys and corridors hold the items that they were laid out as.
Result<void> PlanReader::take_complex(const JsonData& item) {
    const JsonData& type = plan_member(item, "complexItemType");
    const std::string kind = type.is_string() ? type.get<std::string>().substr(0, 40) : "ComplexItem";
    if (kind == "fwLandingPattern" || kind == "vtolLandingPattern") return take_landing(item, kind);
    const JsonData& items = plan_member(plan_member(item, "TransectStyleComplexItem"), "Items");
    if (!items.is_array()) {
        mission_.notes.push_back(one_line_of(fmt::format("item {} is not followed: a {}", number_, kind)));
        return {};
    }
    for (const JsonData& part : items)
        if (const auto taken = take_simple(part); !taken) return taken;
    return {};
}

Result<void> PlanReader::take_item(const JsonData& item) {
    ++number_;
    const JsonData& type = plan_member(item, "type");
    const std::string kind = type.is_string() ? type.get<std::string>() : "";
    if (kind == "SimpleItem" || kind == "missionItem") return take_simple(item);
    if (kind == "ComplexItem") return take_complex(item);
    return refusal(
        fmt::format("item {} is of the type '{}'; expected SimpleItem or ComplexItem", number_, kind.substr(0, 40)));
}

Result<Track> PlanReader::read() {
    constexpr std::size_t largest = 64 << 20;
    if (file_.text.size() > largest)
        return refusal(fmt::format("a plan of {} bytes; expected at most {}", file_.text.size(), largest));
    const auto plan = JsonData::parse(file_.text, nullptr, false);
    if (plan.is_discarded()) return refusal("no sound JSON; expected a plan of QGroundControl");
    const JsonData &mission = plan_member(plan, "mission"), &items = plan_member(mission, "items");
    if (!items.is_array()) return refusal("a plan without mission.items; expected a mission with its items");
    mission_.format = "QGroundControl plan";
    take_head(mission);
    for (const JsonData& item : items)
        if (const auto taken = take_item(item); !taken) return fail(taken.error());
    return track_of_mission(file_, mission_);
}

}  // namespace

bool is_qgc_plan(const TrackFile& file) {
    constexpr std::size_t looked_at = 1 << 20;
    const std::string_view text = file.text.substr(0, looked_at);
    if (!trimmed_cell(text.substr(0, 64)).starts_with('{')) return false;
    return lower_case(file.name).ends_with(".plan") ||
           (text.find("\"fileType\"") != std::string_view::npos && text.find("\"Plan\"") != std::string_view::npos);
}

Result<Track> read_qgc_plan(const TrackFile& file) { return PlanReader(file).read(); }

}  // namespace skyloop::inline motion
