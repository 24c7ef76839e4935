// What a vehicle is and can do.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detail/trajectory_kinds.hpp"

namespace skyloop {
namespace {

// A key whose absence leaves what the vehicle has.
void read_if_there(TableReader& table, std::string_view key, double& value, NumberRange range) {
    if (table.has(key)) table.number(key, value, range);
}

void read_turn_keys(TableReader& table, VehicleLimits& vehicle) {
    constexpr double gravity_mps2 = 9.80665, to_radians = std::numbers::pi / 180;
    read_if_there(table, "lateral_mps2", vehicle.lateral, {1e-3, 500});
    if (table.has("bank_deg")) {
        double bank = 45;
        table.number("bank_deg", bank, {1, 85});
        vehicle.lateral = gravity_mps2 * std::tan(bank * to_radians);
    }
    table.note_not_both("lateral_mps2", "bank_deg");
    if (table.has("lateral_mps2") && table.has("bank_deg") && !table.recording())
        table.mistake("bank_deg", "stands beside lateral_mps2; expected one of the two");
    read_if_there(table, "turn_time_s", vehicle.turn_ramp, {0, 60});
    read_if_there(table, "turn_radius_m", vehicle.radius, {0, 1e6});
    read_if_there(table, "corner_m", vehicle.corner, {1e-3, 1e6});
}

}  // namespace

void read_vehicle_keys(TableReader& table, VehicleLimits& vehicle) {
    std::array<std::string_view, driven_vehicles.size()> names;
    std::transform(driven_vehicles.begin(), driven_vehicles.end(), names.begin(), vehicle_name);
    if (const auto kind = table.choice("vehicle", names)) vehicle = usual_limits(driven_vehicles.at(*kind));
    read_if_there(table, "acceleration_mps2", vehicle.along.acceleration, {1e-3, 500});
    read_if_there(table, "jerk_mps3", vehicle.along.jerk, {1e-3, 1e4});
    read_turn_keys(table, vehicle);
    read_if_there(table, "slowest_mps", vehicle.slowest, {0, 12000});
    read_if_there(table, "climb_mps", vehicle.climb, {1e-3, 12000});
    read_if_there(table, "sink_mps", vehicle.sink, {1e-3, 12000});
    double steepest = vehicle.steepest * 180 / std::numbers::pi;
    read_if_there(table, "steepest_deg", steepest, {0.1, 90});
    if (table.has("steepest_deg")) vehicle.steepest = steepest * std::numbers::pi / 180;
}

void read_speed_and_vehicle(TableReader& table, VehicleLimits& vehicle) {
    read_vehicle_keys(table, vehicle);
    read_if_there(table, "speed_mps", vehicle.along.speed, {1e-3, 12000});
}

}  // namespace skyloop
