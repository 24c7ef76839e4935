// What a vehicle is and can do.
#include <algorithm>
#include <array>
#include <cmath>

#include "detail/trajectory_kinds.hpp"

namespace skyloop {
namespace {

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

}  // namespace

void read_vehicle_keys(TableReader& table, VehicleLimits& vehicle) {
    std::array<std::string_view, driven_vehicles.size()> names;
    std::transform(driven_vehicles.begin(), driven_vehicles.end(), names.begin(), vehicle_name);
    if (const auto kind = table.choice("vehicle", names,
                                       {"who goes: rounds corners, speeds up, leans (docs/paths.md); waypoints without "
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

void read_speed_and_vehicle(TableReader& table, VehicleLimits& vehicle) {
    read_vehicle_keys(table, vehicle);
    table.number("speed_mps", vehicle.along.speed, {1e-3, 12000}, {"along the way", "the vehicle's"});
}

}  // namespace skyloop
