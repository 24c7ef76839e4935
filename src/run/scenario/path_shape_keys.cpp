// The keys of the shapes of generated paths, and of vehicles.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "detail/trajectory_kinds.hpp"

namespace skyloop::inline run {
namespace {

// Where the path is; marks the reading when that is missing.
Eigen::Vector3d read_spot(ShapeReading& r, TableReader& table, const std::string& key, std::string_view meaning) {
    const auto spot = r.places.read(table, key, meaning);
    r.whole = r.whole && spot;
    return spot.value_or(Eigen::Vector3d::Zero());
}

void read_angle(TableReader& table, std::string_view key, double& radians, KeyText text) {
    Angle angle = Angle::radians(radians);
    table.degrees(key, angle, {-360, 360}, text);
    radians = angle.rad();
}

// speed_mps and vehicle keys of a path that is driven along.
template <class Wish>
void read_motion(ShapeReading& r, Wish& wish) {
    read_speed_and_vehicle(r.table, r.vehicle);
    wish.vehicle = r.vehicle;
    wish.heading = r.heading.rad();
}

PathWish read_driven_waypoints(ShapeReading& r) {
    WaypointWish wish;
    read_motion(r, wish);
    read_waypoint_tables(r.table, [&](TableReader& row) {
        Waypoint corner;
        corner.speed = MetresPerSecond(wish.waypoints.empty() ? r.vehicle.along.speed : wish.waypoints.back().speed);
        const auto place = read_spot(r, row, "at", "place");
        read_waypoint_motion(row, corner);
        wish.waypoints.push_back({place, corner.speed.value(), corner.hold.value()});
    });
    r.whole = r.whole && wish.waypoints.size() >= 2;
    return wish;
}

// What laps have in common.
void read_laps(ShapeReading& r, LapWish& lap) {
    lap.centre = read_spot(r, r.table, "centre", "centre");
    read_motion(r, lap);
    r.table.integer("laps", lap.laps, {0, 1e6}, "after which it comes to rest; 0: it never does");
}

PathWish read_orbit(ShapeReading& r) {
    OrbitWish wish;
    read_laps(r, wish.lap);
    r.table.number("radius_m", wish.radius, {0.1, 1e6}, "of the circle");
    read_angle(r.table, "start_azimuth_deg", wish.start_azimuth,
               "from the centre to the place at the start, clockwise from north");
    r.table.boolean("anticlockwise", wish.anticlockwise, "seen from above");
    r.table.number("climb_m", wish.climb, {-1e5, 1e5}, "change of height over all laps");
    return wish;
}

PathWish read_racetrack(ShapeReading& r) {
    RacetrackWish wish;
    read_laps(r, wish.lap);
    r.table.number("length_m", wish.straight, {0.1, 1e6}, "of the straights");
    r.table.number("radius_m", wish.radius, {0.1, 1e6}, {"of the turns", "the smallest at its speed"});
    return wish;
}

PathWish read_figure_eight(ShapeReading& r) {
    FigureEightWish wish;
    read_laps(r, wish.lap);
    double length = 2 * wish.half_length;
    r.table.number("length_m", length, {0.1, 1e6}, "of the whole eight");
    wish.half_length = length / 2;
    return wish;
}

PathWish read_lawnmower(ShapeReading& r) {
    LawnmowerWish wish;
    wish.corner = read_spot(r, r.table, "at", "place");
    read_motion(r, wish);
    r.table.number("length_m", wish.length, {0.1, 1e6}, "of the lines");
    r.table.number("spacing_m", wish.spacing, {0.01, 1e5}, "from line to line, each to the right of the one before");
    r.table.integer("lines", wish.lines, {1, 10000}, "how many");
    return wish;
}

PathWish read_hover(ShapeReading& r) {
    HoverWish wish;
    wish.place = read_spot(r, r.table, "at", "place");
    wish.heading = r.heading.rad();
    r.table.number("sway_m", wish.sway, {0, 100}, "root mean square on each horizontal axis, half of it upward");
    r.table.number("wind_mps", wish.wind, {0, 100}, "wind that it leans into");
    read_angle(r.table, "wind_from_deg", wish.wind_from, "where the wind comes from, clockwise from north");
    return wish;
}

PathWish read_float(ShapeReading& r) {
    FloatWish wish;
    r.vehicle = usual_limits(VehicleClass::boat);
    wish.place = read_spot(r, r.table, "at", "place");
    wish.heading = r.heading.rad();
    r.table.number("speed_mps", wish.speed, {0, 100}, "through the water, in the direction of the heading");
    r.table.number("wave_height_m", wish.wave_height, {0, 30},
                   "significant: four times the root mean square of the surface");
    r.table.number("wave_period_s", wish.wave_period, {0.5, 60}, "of the main wave");
    read_angle(r.table, "wave_from_deg", wish.wave_from, "where the waves come from, clockwise from north");
    r.table.number("current_mps", wish.current, {0, 100}, "that sets the boat");
    read_angle(r.table, "current_to_deg", wish.current_to, "where the current goes, clockwise from north");
    return wish;
}

PathWish read_drive(ShapeReading& r) {
    DriveWish wish;
    r.vehicle = usual_limits(VehicleClass::car);
    wish.centre = read_spot(r, r.table, "centre", "centre");
    read_motion(r, wish);
    r.table.number("area_m", wish.area, {1, 1e6}, "how far it drives from the centre, along the streets");
    r.table.number("block_m", wish.block, {1, 1e5}, "from crossing to crossing");
    r.table.number("duration_s", wish.seconds, {1, 1e7}, "about how long it drives");
    r.table.number("stops", wish.stops, {0, 1}, "share of the crossings at which it waits 5 to 40 s");
    return wish;
}

PathWish read_rocket(ShapeReading& r) {
    static constexpr std::array<std::string_view, 2> presets{"rocket_1km", "rocket_30km_M3"};
    RocketWish wish;
    r.vehicle = usual_limits(VehicleClass::rocket);
    wish.pad = read_spot(r, r.table, "at", "place");
    wish.heading = r.heading.rad();
    if (const auto preset =
            r.table.choice("preset", presets, {"a known flight, whose values the other keys change", "none"}))
        choose_rocket(wish, presets[*preset]);
    r.table.number("boost_mps2", wish.boost, {0, 1000}, "thrust by mass");
    r.table.number("burn_s", wish.burn, {0.2, 600}, "of the motor");
    r.table.number("drag_per_m", wish.drag, {1e-7, 1}, "at sea level: density · drag coefficient · area / (2 · mass)");
    r.table.number("drogue_mps", wish.drogue, {1, 200},
                   "falling speed at sea level under the first parachute, from the top on");
    r.table.number("main_mps", wish.main, {1, 100}, "the same under the second one");
    r.table.number("main_below_m", wish.main_below, {0, 1e5}, "height above the pad at which the second one opens");
    return wish;
}

void read_winds(TableReader& table, std::vector<WindLayer>& winds) {
    table.tables("wind", {"layers of wind by ascending height", "a jet of 25 m/s eastward at 11 km"},
                 [&](TableReader& row) {
                     WindLayer layer;
                     row.number("height_m", layer.height, {-1000, 1e5}, "above the ellipsoid");
                     row.number("speed_mps", layer.speed, {0, 200}, "of the wind there");
                     read_angle(row, "to_deg", layer.to, "where it goes, clockwise from north");
                     if (!winds.empty() && layer.height <= winds.back().height)
                         row.mistake("height_m", fmt::format("is {:g}, after {:g}; expected ascending heights",
                                                             layer.height, winds.back().height));
                     winds.push_back(layer);
                 });
}

PathWish read_balloon(ShapeReading& r) {
    static constexpr std::array<std::string_view, 1> presets{"balloon_32km"};
    BalloonWish wish;
    r.vehicle = usual_limits(VehicleClass::balloon);
    wish.place = read_spot(r, r.table, "at", "place");
    wish.heading = r.heading.rad();
    if (const auto preset =
            r.table.choice("preset", presets, {"a known flight, whose values the other keys change", "none"}))
        choose_balloon(wish, presets[*preset]);
    r.table.number("ascent_mps", wish.ascent, {0.5, 50}, "until it bursts");
    r.table.number("burst_m", wish.burst, {100, 60000}, "height above the ellipsoid");
    r.table.number("descent_mps", wish.descent, {1, 100}, "falling speed at sea level under the parachute");
    read_winds(r.table, wish.winds);
    return wish;
}

struct ShapeKind {
    std::string_view name;
    PathWish (*read)(ShapeReading&);
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

void read_turn_keys(TableReader& table, VehicleLimits& vehicle) {
    constexpr double gravity_mps2 = 9.80665;
    table.number("lateral_mps2", vehicle.lateral, {1e-3, 500}, {"acceleration in turns", "the vehicle's"});
    std::optional<Angle> bank;
    table.degrees("bank_deg", bank, {1, 85}, {"bank in turns, which gives lateral_mps2", "none"});
    if (bank) vehicle.lateral = gravity_mps2 * std::tan(bank->rad());
    table.not_both("lateral_mps2", "bank_deg");
    table.number("turn_time_s", vehicle.turn_ramp, {0, 60},
                 {"until a turn has its full acceleration: rolling in, steering", "the vehicle's"});
    table.number("turn_radius_m", vehicle.radius, {0, 1e6}, {"smallest", "the vehicle's"});
    table.number("corner_m", vehicle.corner, {1e-3, 1e6},
                 {"how far before a waypoint the turn there may begin", "the vehicle's"});
}

void read_vehicle_keys(TableReader& table, VehicleLimits& vehicle) {
    std::array<std::string_view, driven_vehicles.size()> names;
    std::transform(driven_vehicles.begin(), driven_vehicles.end(), names.begin(), vehicle_name);
    if (const auto kind =
            table.choice("vehicle", names,
                         {"which vehicle: it rounds corners, speeds up, leans (docs/paths.md); waypoints without "
                          "any key of a vehicle run at constant speed from corner to corner",
                          "multirotor; of drive car"}))
        vehicle = usual_limits(driven_vehicles.at(*kind));
    table.number("acceleration_mps2", vehicle.along.acceleration, {1e-3, 500}, {"along the way", "the vehicle's"});
    table.number("jerk_mps3", vehicle.along.jerk, {1e-3, 1e4},
                 {"change of the acceleration along the way", "the vehicle's"});
    read_turn_keys(table, vehicle);
    table.number("slowest_mps", vehicle.slowest, {0, 12000},
                 {"speed on the way; what has one cannot stop there", "the vehicle's"});
    table.number("climb_mps", vehicle.climb, {1e-3, 12000}, {"largest", "the vehicle's"});
    table.number("sink_mps", vehicle.sink, {1e-3, 12000}, {"largest", "the vehicle's"});
    Angle steepest = Angle::radians(vehicle.steepest);
    table.degrees("steepest_deg", steepest, {0.1, 90}, {"slope of the way", "the vehicle's"});
    vehicle.steepest = steepest.rad();
}

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

std::optional<Eigen::Vector3d> PlaneReader::read(TableReader& table, const std::string& key, std::string_view meaning) {
    const auto place = places_.read_needed(table, key, {meaning, "none"});
    if (!place) return std::nullopt;
    if (!plane_) plane_.emplace(*place);
    return on_plane(table, *plane_, key, *place);
}

std::span<const std::string_view> path_shape_names() { return names_of_shapes; }

std::optional<PathWish> read_path_shape(std::size_t kind, ShapeReading reading) {
    PathWish wish = shape_kinds.at(kind).read(reading);
    return reading.whole ? std::optional(std::move(wish)) : std::nullopt;
}

bool has_dice(std::size_t kind) { return shape_kinds.at(kind).dice; }

void read_speed_and_vehicle(TableReader& table, VehicleLimits& vehicle) {
    read_vehicle_keys(table, vehicle);
    table.number("speed_mps", vehicle.along.speed, {1e-3, 12000}, {"along the way", "the vehicle's"});
}

}  // namespace skyloop::inline run
