#include "detail/trajectory_kinds.hpp"

#include <fmt/format.h>

#include <cmath>

namespace skyloop {

std::optional<Geodetic> PlaceReader::read(TableReader& table, const std::string& key) {
    const std::string level_key = key + "_level";
    const auto on_earth = table.place(key);
    const auto in_level = table.numbers(level_key, 3);
    table.note_not_both(key, level_key);
    if (on_earth && in_level) table.mistake(level_key, fmt::format("stands beside {}; expected one of the two", key));
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

Angle read_heading(TableReader& table) {
    double heading = 0;
    table.number("heading_deg", heading, {-360, 360});
    return Angle::degrees(heading);
}

void read_fixed(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory) {
    FixedSettings fixed;
    fixed.heading = read_heading(table);
    if (const auto at = places.read(table, "at")) fixed.at = *at;
    table.needs_one_of({"at", "at_level"}, "kind \"fixed\" has no place; expected at = [latitude, longitude, height]");
    trajectory = fixed;
}

void read_waypoint_motion(TableReader& row, Waypoint& corner) {
    row.needs_one_of({"at", "at_level"}, "has no place; expected at = [latitude, longitude, height]");
    row.quantity("speed_mps", corner.speed, {1e-3, 12000});
    row.quantity("hold_s", corner.hold, {0, 1e7});
}

void read_waypoint_tables(TableReader& table, const std::function<void(TableReader&)>& read_corner) {
    constexpr std::size_t fewest_corners = 2;
    std::size_t corners = 0;
    const auto read_and_count = [&](TableReader& row) { ++corners, read_corner(row); };
    table.tables("waypoint", read_and_count, fewest_corners);
    if (corners < fewest_corners)
        table.mistake_here(
            fmt::format("kind \"waypoints\" has {} waypoints; expected two or more [[trajectory.waypoint]]", corners));
}

void read_circle(TableReader& table, PlaceReader& places, TrajectorySettings& trajectory) {
    CircleSettings circle;
    circle.heading = read_heading(table);
    if (const auto centre = places.read(table, "centre")) circle.shape.centre = *centre;
    table.needs_one_of({"centre", "centre_level"},
                       "kind \"circle\" has no centre; expected centre = [latitude, longitude, height]");
    table.quantity("radius_m", circle.shape.radius, {0.1, 1e6});
    table.quantity("speed_mps", circle.shape.speed, {-12000, 12000});
    double azimuth = 0;
    table.number("start_azimuth_deg", azimuth, {-360, 360});
    circle.shape.start_azimuth = Angle::degrees(azimuth);
    trajectory = circle;
}

}  // namespace skyloop
