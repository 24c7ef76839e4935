// The keys of the shapes of generated paths.
#include <fmt/format.h>

#include <array>

#include "detail/trajectory_kinds.hpp"

namespace skyloop {
namespace {

using WishFound = std::optional<PathWish>;

std::optional<Eigen::Vector3d> read_needed_place(const ShapeReading& r, const std::string& key) {
    const auto place = r.places.read(r.table, key);
    const std::string level = key + "_level";
    r.table.needs_one_of({key, level}, fmt::format("has no place; expected {} = [latitude, longitude, height]", key));
    return place;
}

void read_angle(TableReader& table, std::string_view key, double& radians) {
    double degrees = Angle::radians(radians).deg();
    table.number(key, degrees, {-360, 360});
    radians = Angle::degrees(degrees).rad();
}

WishFound read_driven_waypoints(const ShapeReading& r) {
    read_speed_and_vehicle(r.table, r.vehicle);
    WaypointWish wish;
    wish.vehicle = r.vehicle;
    wish.heading = r.heading.rad();
    bool whole = true;
    read_waypoint_tables(r.table, [&](TableReader& row) {
        Waypoint corner;
        corner.speed = MetresPerSecond(wish.waypoints.empty() ? r.vehicle.along.speed : wish.waypoints.back().speed);
        const auto place = r.places.read(row, "at");
        whole = whole && place;
        read_waypoint_motion(row, corner);
        wish.waypoints.push_back({place.value_or(Eigen::Vector3d::Zero()), corner.speed.value(), corner.hold.value()});
    });
    if (!whole || wish.waypoints.size() < 2) return std::nullopt;
    return wish;
}

// What laps have in common; false when their centre is missing.
bool read_laps(const ShapeReading& r, LapWish& lap) {
    const auto centre = read_needed_place(r, "centre");
    read_speed_and_vehicle(r.table, r.vehicle);
    lap.vehicle = r.vehicle;
    lap.centre = centre.value_or(Eigen::Vector3d::Zero());
    lap.heading = r.heading.rad();
    r.table.integer("laps", lap.laps, {0, 1e6});
    return centre.has_value();
}

WishFound read_orbit(const ShapeReading& r) {
    OrbitWish wish;
    const bool whole = read_laps(r, wish.lap);
    r.table.number("radius_m", wish.radius, {0.1, 1e6});
    read_angle(r.table, "start_azimuth_deg", wish.start_azimuth);
    r.table.boolean("anticlockwise", wish.anticlockwise);
    r.table.number("climb_m", wish.climb, {-1e5, 1e5});
    return whole ? WishFound(wish) : std::nullopt;
}

WishFound read_racetrack(const ShapeReading& r) {
    RacetrackWish wish;
    const bool whole = read_laps(r, wish.lap);
    r.table.number("length_m", wish.straight, {0.1, 1e6});
    if (r.table.has("radius_m")) r.table.number("radius_m", wish.radius, {0.1, 1e6});
    return whole ? WishFound(wish) : std::nullopt;
}

WishFound read_figure_eight(const ShapeReading& r) {
    FigureEightWish wish;
    const bool whole = read_laps(r, wish.lap);
    double length = 2 * wish.half_length;
    r.table.number("length_m", length, {0.1, 1e6});
    wish.half_length = length / 2;
    return whole ? WishFound(wish) : std::nullopt;
}

WishFound read_lawnmower(const ShapeReading& r) {
    LawnmowerWish wish;
    const auto corner = read_needed_place(r, "at");
    read_speed_and_vehicle(r.table, r.vehicle);
    wish.vehicle = r.vehicle;
    wish.heading = r.heading.rad();
    r.table.number("length_m", wish.length, {0.1, 1e6});
    r.table.number("spacing_m", wish.spacing, {0.01, 1e5});
    r.table.integer("lines", wish.lines, {1, 10000});
    if (!corner) return std::nullopt;
    wish.corner = *corner;
    return wish;
}

WishFound read_hover(const ShapeReading& r) {
    HoverWish wish;
    const auto place = read_needed_place(r, "at");
    wish.heading = r.heading.rad();
    r.table.number("sway_m", wish.sway, {0, 100});
    r.table.number("wind_mps", wish.wind, {0, 100});
    read_angle(r.table, "wind_from_deg", wish.wind_from);
    if (!place) return std::nullopt;
    wish.place = *place;
    return wish;
}

WishFound read_float(const ShapeReading& r) {
    FloatWish wish;
    r.vehicle = usual_limits(VehicleClass::boat);
    const auto place = read_needed_place(r, "at");
    wish.heading = r.heading.rad();
    r.table.number("speed_mps", wish.speed, {0, 100});
    r.table.number("wave_height_m", wish.wave_height, {0, 30});
    r.table.number("wave_period_s", wish.wave_period, {0.5, 60});
    read_angle(r.table, "wave_from_deg", wish.wave_from);
    r.table.number("current_mps", wish.current, {0, 100});
    read_angle(r.table, "current_to_deg", wish.current_to);
    if (!place) return std::nullopt;
    wish.place = *place;
    return wish;
}

WishFound read_drive(const ShapeReading& r) {
    DriveWish wish;
    r.vehicle = usual_limits(VehicleClass::car);
    const auto centre = read_needed_place(r, "centre");
    read_speed_and_vehicle(r.table, r.vehicle);
    wish.vehicle = r.vehicle;
    wish.heading = r.heading.rad();
    r.table.number("area_m", wish.area, {1, 1e6});
    r.table.number("block_m", wish.block, {1, 1e5});
    r.table.number("duration_s", wish.seconds, {1, 1e7});
    r.table.number("stops", wish.stops, {0, 1});
    if (!centre) return std::nullopt;
    wish.centre = *centre;
    return wish;
}

WishFound read_rocket(const ShapeReading& r) {
    static constexpr std::array<std::string_view, 2> presets{"rocket_1km", "rocket_30km_M3"};
    RocketWish wish;
    r.vehicle = usual_limits(VehicleClass::rocket);
    const auto pad = read_needed_place(r, "at");
    wish.heading = r.heading.rad();
    if (const auto preset = r.table.choice("preset", presets)) choose_rocket(wish, presets[*preset]);
    r.table.number("boost_mps2", wish.boost, {0, 1000});
    r.table.number("burn_s", wish.burn, {0.2, 600});
    r.table.number("drag_per_m", wish.drag, {1e-7, 1});
    r.table.number("drogue_mps", wish.drogue, {1, 200});
    r.table.number("main_mps", wish.main, {1, 100});
    r.table.number("main_below_m", wish.main_below, {0, 1e5});
    if (!pad) return std::nullopt;
    wish.pad = *pad;
    return wish;
}

void read_winds(TableReader& table, std::vector<WindLayer>& winds) {
    table.tables("wind", [&](TableReader& row) {
        WindLayer layer;
        row.number("height_m", layer.height, {-1000, 1e5});
        row.number("speed_mps", layer.speed, {0, 200});
        read_angle(row, "to_deg", layer.to);
        if (!winds.empty() && layer.height <= winds.back().height)
            row.mistake("height_m", fmt::format("is {:g}, after {:g}; expected ascending heights", layer.height,
                                                winds.back().height));
        winds.push_back(layer);
    });
}

WishFound read_balloon(const ShapeReading& r) {
    static constexpr std::array<std::string_view, 1> presets{"balloon_32km"};
    BalloonWish wish;
    r.vehicle = usual_limits(VehicleClass::balloon);
    const auto place = read_needed_place(r, "at");
    wish.heading = r.heading.rad();
    if (const auto preset = r.table.choice("preset", presets)) choose_balloon(wish, presets[*preset]);
    r.table.number("ascent_mps", wish.ascent, {0.5, 50});
    r.table.number("burst_m", wish.burst, {100, 60000});
    r.table.number("descent_mps", wish.descent, {1, 100});
    read_winds(r.table, wish.winds);
    if (!place) return std::nullopt;
    wish.place = *place;
    return wish;
}

struct ShapeKind {
    std::string_view name;
    WishFound (*read)(const ShapeReading&);
    bool dice = false;
};
constexpr std::array<ShapeKind, 10> shape_kinds{{{"waypoints", read_driven_waypoints},
                                                 {"orbit", read_orbit},
                                                 {"racetrack", read_racetrack},
                                                 {"figure-eight", read_figure_eight},
                                                 {"lawnmower", read_lawnmower},
                                                 {"hover", read_hover, true},
                                                 {"float", read_float, true},
                                                 {"drive", read_drive, true},
                                                 {"rocket", read_rocket},
                                                 {"balloon", read_balloon}}};

constexpr auto names_of_shapes = [] {
    std::array<std::string_view, shape_kinds.size()> names;
    for (std::size_t i = 0; i < names.size(); ++i)
        names[i] = shape_kinds[i].name;
    return names;
}();

}  // namespace

std::optional<Eigen::Vector3d> on_plane(TableReader& table, const GeodesicPlane& plane, std::string_view key,
                                        const Geodetic& place) {
    const Eigen::Vector3d local = plane.to_local(place);
    const double distance = local.head<2>().norm();
    if (distance <= GeodesicPlane::farthest_m) return local;
    table.mistake(key, fmt::format("lies {:.0f} km from the first place of the path; expected at most {:.0f}",
                                   distance / 1000, GeodesicPlane::farthest_m / 1000));
    return std::nullopt;
}

std::optional<Eigen::Vector3d> PlaneReader::read(TableReader& table, const std::string& key) {
    const auto place = places_.read(table, key);
    if (!place) return std::nullopt;
    if (!plane_) plane_.emplace(*place);
    return on_plane(table, *plane_, key, *place);
}

std::span<const std::string_view> path_shape_names() { return names_of_shapes; }

std::optional<PathWish> read_path_shape(std::size_t kind, const ShapeReading& reading) {
    return shape_kinds.at(kind).read(reading);
}

bool has_dice(std::size_t kind) { return shape_kinds.at(kind).dice; }

}  // namespace skyloop
