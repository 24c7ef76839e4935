#include "detail/trajectory_kinds.hpp"

#include <fmt/format.h>

#include <cmath>

namespace skyloop {

std::optional<Geodetic> PlaceReader::read(TableReader& table, const std::string& key, KeyText text) {
    const std::string level_key = key + "_level";
    const std::string meaning = fmt::format("{}: latitude, longitude, height above the ellipsoid", text.meaning);
    const auto on_earth = table.place(key, {meaning, text.standard});
    const std::string in_frame = fmt::format("the same in the coordinates of [frame], instead of `{}`: x, y, z", key);
    const auto in_level = table.numbers(level_key, 3, {in_frame, "none"});
    table.not_both(key, level_key);
    if (!in_level) return on_earth;
    if (!level_) {
        table.mistake(level_key, "needs a [frame] that says where the level lies");
        return std::nullopt;
    }
    const Position<Level> point((*in_level)[0], (*in_level)[1], (*in_level)[2]);
    const Geodetic place = to_geodetic(level_->to_ecef(point));
    const auto checked =
        place_from_degrees(place.latitude.deg(), place.longitude.deg(), place.height.above_ellipsoid.value());
    if (!checked) {
        table.mistake(level_key, checked.error());
        return std::nullopt;
    }
    if (level_->beyond_reach(point)) warn_beyond_reach(point);
    return place;
}

void PlaceReader::warn_beyond_reach(const Position<Level>& point) {
    const LevelPlacement& placement = level_->placement();
    warnings_.push_back(
        fmt::format("level point ({:g}, {:g}, {:g}) lies {:.0f} m from the frame's origin; beyond {:.0f} m a plane "
                    "leaves the curved "
                    "Earth (by {:.1f} m there): anchor the frame nearer",
                    point.vector().x(), point.vector().y(), point.vector().z(),
                    point.vector().head<2>().norm() * placement.unit.value(), placement.reach.value(),
                    point.vector().head<2>().squaredNorm() * std::pow(placement.unit.value(), 2) / (2 * 6371e3)));
}

std::optional<Geodetic> PlaceReader::read_needed(TableReader& table, const std::string& key, KeyText text) {
    const auto place = read(table, key, text);
    const std::string level_key = key + "_level";
    table.needs_one_of({key, level_key},
                       fmt::format("has no {}; expected {} = [latitude, longitude, height]", text.meaning, key));
    return place;
}

Angle read_heading(TableReader& table) {
    Angle heading;
    table.degrees("heading_deg", heading, {-360, 360},
                  "where the vehicle looks until it moves, clockwise from north; then it looks where it goes");
    return heading;
}

void read_fixed(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory) {
    FixedSettings fixed;
    fixed.heading = read_heading(table);
    if (const auto at = places.read_needed(table, "at", {"place", "none"})) fixed.at = *at;
    trajectory = fixed;
}

void read_waypoint_motion(TableReader& row, Waypoint& corner) {
    row.quantity("speed_mps", corner.speed, {1e-3, 12000},
                 {"from here to the next corner", "the last one given, at first 10"});
    row.quantity("hold_s", corner.hold, {0, 1e7}, "stop here before leaving");
}

void read_waypoint_tables(TableReader& table, const std::function<void(TableReader&)>& read_corner) {
    constexpr std::size_t fewest_corners = 2;
    std::size_t corners = 0;
    const auto read_and_count = [&](TableReader& row) { ++corners, read_corner(row); };
    table.tables("waypoint", "the corners of the way, at least two", read_and_count, fewest_corners);
    if (corners < fewest_corners)
        table.mistake_here(
            fmt::format("kind \"waypoints\" has {} waypoints; expected two or more [[trajectory.waypoint]]", corners));
}

void read_circle(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory) {
    CircleSettings circle;
    circle.heading = read_heading(table);
    if (const auto centre = places.read_needed(table, "centre", {"centre", "none"})) circle.shape.centre = *centre;
    table.quantity("radius_m", circle.shape.radius, {0.1, 1e6}, "of the circle");
    table.quantity("speed_mps", circle.shape.speed, {-12000, 12000},
                   "along the circle; a negative one runs anticlockwise");
    table.degrees("start_azimuth_deg", circle.shape.start_azimuth, {-360, 360},
                  "from the centre to the place at the start, clockwise from north");
    trajectory = circle;
}

}  // namespace skyloop
