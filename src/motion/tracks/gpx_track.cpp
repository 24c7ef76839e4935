#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/core/words.hpp"
#include "base/core/written_place.hpp"
#include "detail/text_track.hpp"
#include "detail/xml_tree.hpp"

namespace skyloop::inline motion {
namespace {

// GPX 1.0 and 1.1 (topografix.com/GPX/1/0 and 1/1): places above mean sea level by custom, times in UTC; speed and
// course directly in a point in 1.0, in extensions in 1.1 (FEEDS.md 1.3).
class GpxReader {
public:
    explicit GpxReader(const TrackFile& file) : file_(file), track_(file, "GPX", "track points") {}
    Result<Track> read();

private:
    Result<void> take_track(const pugi::xml_node& track);
    Result<void> take_point(const pugi::xml_node& point);
    Result<void> take_places_of_routes();
    Result<void> take_places(const pugi::xml_node& holder, std::string_view name);
    Result<void> take_time(std::string_view text, TextRow& row);
    Result<void> take_place(const pugi::xml_node& point, TextRow& row);
    void take_motion(const pugi::xml_node& point, TextRow& row);
    [[nodiscard]] std::optional<double> number_in(const pugi::xml_node& point, std::string_view name) const;
    Result<std::optional<double>> child_number(const pugi::xml_node& point, std::string_view name);
    void add_notes();

    const TrackFile& file_;
    XmlTree tree_;
    TextTrack track_;
    bool segment_begins_ = false;
    std::size_t without_zone_ = 0, route_points_ = 0, waypoints_ = 0, senseless_motion_ = 0;
};

Result<Track> GpxReader::read() {
    auto tree = XmlTree::of(file_);
    if (!tree) return fail(tree.error());
    tree_ = std::move(*tree);
    track_.set_format(fmt::format("GPX {:.10}", tree_.root().attribute("version").value()));
    for (const pugi::xml_node& part : tree_.root().children()) {
        const std::string_view name = xml_name(part);
        if (name == "wpt") ++waypoints_;
        for (const pugi::xml_node& point : part.children())
            if (name == "rte" && xml_name(point) == "rtept") ++route_points_;
        if (name != "trk") continue;
        if (const auto taken = take_track(part); !taken) return fail(taken.error());
    }
    if (track_.rows() == 0) {
        if (const auto taken = take_places_of_routes(); !taken) return fail(taken.error());
    } else if (route_points_ + waypoints_ > 0) {
        track_.note(fmt::format("its routes, of {} points, and its {} waypoints are not part of the path",
                                route_points_, waypoints_));
    }
    add_notes();
    return track_.finish("<trkpt>, <rtept> or <wpt> with lat and lon");
}

// Of several routes the one with most points; without any, the waypoints as they stand.
Result<void> GpxReader::take_places_of_routes() {
    const pugi::xml_node root = tree_.root();
    if (route_points_ == 0) {
        track_.note(fmt::format("its {} waypoints are taken as a route, in the order of the file", waypoints_));
        return take_places(root, "wpt");
    }
    pugi::xml_node longest;
    std::size_t most = 0, routes = 0;
    for (const pugi::xml_node& part : root.children()) {
        if (xml_name(part) != "rte") continue;
        ++routes;
        const auto points = static_cast<std::size_t>(
            std::count_if(part.begin(), part.end(), [](const pugi::xml_node& p) { return xml_name(p) == "rtept"; }));
        if (points > most) most = points, longest = part;
    }
    if (routes > 1)
        track_.note(fmt::format("of its {} routes the one with most points is taken, '{}'", routes,
                                xml_content(xml_child(longest, "name")).substr(0, 60)));
    if (waypoints_ > 0) track_.note(fmt::format("its {} waypoints are not part of the path", waypoints_));
    return take_places(longest, "rtept");
}

// Times of theirs are those at which they were stored.
Result<void> GpxReader::take_places(const pugi::xml_node& holder, std::string_view name) {
    for (const pugi::xml_node& point : holder.children()) {
        if (xml_name(point) != name) continue;
        TextRow row;
        row.line = tree_.line_of(point);
        if (const auto placed = take_place(point, row); !placed) return placed;
        if (const auto added = track_.add_untimed(row, "have no time"); !added) return added;
    }
    return {};
}

Result<void> GpxReader::take_track(const pugi::xml_node& track) {
    track_.begin_part(xml_content(xml_child(track, "name")));
    for (const pugi::xml_node& segment : track.children()) {
        if (xml_name(segment) != "trkseg") continue;
        segment_begins_ = true;
        for (const pugi::xml_node& point : segment.children()) {
            if (xml_name(point) != "trkpt") continue;
            if (const auto taken = take_point(point); !taken) return taken;
        }
    }
    return {};
}

Result<void> GpxReader::take_point(const pugi::xml_node& point) {
    TextRow row;
    row.line = tree_.line_of(point);
    const std::string time = xml_content(xml_child(point, "time"));
    const std::string_view plain = trimmed_cell(time);
    if (!plain.empty())
        if (const auto timed = take_time(plain, row); !timed) return timed;
    if (const auto placed = take_place(point, row); !placed) return placed;
    if (plain.empty()) return track_.add_untimed(row, "have no time");
    if (!row.timed) return track_.add_untimed(row, "have a time before 1980-01-06 or after 2199", plain);
    take_motion(point, row);
    row.jump = std::exchange(segment_begins_, false);
    return track_.add(row);
}

// Times out of range are none.
Result<void> GpxReader::take_time(std::string_view text, TextRow& row) {
    const auto time = parse_iso_time(text);
    if (!time)
        return track_.refusal(
            row.line, fmt::format("the time is '{}'; expected one as 2024-03-05T12:00:00.25Z", text.substr(0, 40)));
    row.timed = time->in_range;
    if (!time->in_range) return {};
    if (!time->zoned) ++without_zone_;
    row.time = time->time.time_since_epoch();
    return {};
}

Result<void> GpxReader::take_place(const pugi::xml_node& point, TextRow& row) {
    for (const auto& [name, value] : {std::pair("lat", &row.latitude_deg), std::pair("lon", &row.longitude_deg)}) {
        const std::string_view text = point.attribute(name).value();
        auto number = text_number(text);
        if (!number) number = written_degrees(text, name[1] == 'a' ? Coordinate::latitude : Coordinate::longitude);
        if (!number)
            return track_.refusal(
                row.line, fmt::format("{} is '{}'; expected degrees with a decimal point", name, text.substr(0, 40)));
        *value = *number;
    }
    const auto height = child_number(point, "ele"), separation = child_number(point, "geoidheight");
    if (!height) return fail(height.error());
    if (!separation) return fail(separation.error());
    row.sea_level_m = *height;
    row.separation_m = *separation;
    return {};
}

// Nothing where the point has no such child, or an empty one.
Result<std::optional<double>> GpxReader::child_number(const pugi::xml_node& point, std::string_view name) {
    const std::string text = xml_content(xml_child(point, name));
    const std::string_view plain = trimmed_cell(text);
    if (plain.empty() || lower_case(plain) == "nan") return std::nullopt;
    const auto number = text_number(plain);
    if (!number)
        return track_.refusal(tree_.line_of(point), fmt::format("{} is '{}'; expected metres with a decimal point",
                                                                name, plain.substr(0, 40)));
    return number;
}

// The first element of that name below the point, at any depth: extensions differ in their wrappings.
std::optional<double> GpxReader::number_in(const pugi::xml_node& point, std::string_view name) const {
    for (pugi::xml_node at = xml_following(point, point); at; at = xml_following(at, point))
        if (xml_name(at) == name) return text_number(xml_content(at));
    return std::nullopt;
}

void GpxReader::take_motion(const pugi::xml_node& point, TextRow& row) {
    constexpr double fastest_mps = 12000;
    row.speed_mps = number_in(point, "speed");
    row.course_deg = number_in(point, "course");
    if (!row.course_deg) row.course_deg = number_in(point, "bearing");
    row.climb_mps = number_in(point, "vspeed");
    for (auto* value : {&row.speed_mps, &row.climb_mps})
        if (*value && std::abs(**value) > fastest_mps) value->reset(), ++senseless_motion_;
    const auto roll = number_in(point, "roll"), pitch = number_in(point, "pitch");
    auto yaw = number_in(point, "yaw");
    if (!yaw) yaw = number_in(point, "heading");
    if (roll && pitch && yaw)
        row.attitude = Attitude::roll_pitch_yaw(Angle::degrees(*roll), Angle::degrees(*pitch), Angle::degrees(*yaw));
}

void GpxReader::add_notes() {
    if (without_zone_ > 0) track_.note(fmt::format("{} times say no zone and are taken as UTC", without_zone_));
    if (senseless_motion_ > 0) track_.note(fmt::format("{} speeds beyond 12000 m/s are not used", senseless_motion_));
}

}  // namespace

Result<Track> read_gpx(const TrackFile& file) { return GpxReader(file).read(); }

}  // namespace skyloop::inline motion
