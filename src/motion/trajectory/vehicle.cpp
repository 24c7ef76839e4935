#include "motion/trajectory/vehicle.hpp"

#include <array>
#include <numbers>

namespace skyloop {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double everywhere = 1e9;  // a corner may begin as early as it needs to

// In the order of VehicleClass: along the way, in turns, up and down. A plane's turn is one of 45° bank, rolled into at
// 60° a second; a boat's radius is four lengths of 6 m.
constexpr std::array<VehicleLimits, vehicle_class_count> usual_values{{
    {VehicleClass::fixed, {0.1, 0.1, 0.1}, 0.1, 0, 0, 0, 0, 0.1, 0.1, 90 * degree},
    {VehicleClass::pedestrian, {1.4, 1, 2}, 1, 0, 0, 1, 0, 0.7, 0.7, 45 * degree},
    {VehicleClass::car, {14, 2, 2}, 2.5, 1.5, 6, 25, 0, 3, 3, 15 * degree},
    {VehicleClass::rover, {5, 1.5, 2}, 1.5, 0, 0, 2, 0, 3, 3, 30 * degree},
    {VehicleClass::boat, {6, 0.5, 0.4}, 0.8, 3, 24, everywhere, 0, 0.5, 0.5, 5 * degree},
    {VehicleClass::plane, {20, 2, 1}, 9.81, 0.75, 0, everywhere, 12, 4, 4, 20 * degree},
    {VehicleClass::multirotor, {12, 4, 8}, 4, 0, 0, 10, 0, 5, 3, 90 * degree},
    {VehicleClass::balloon, {30, 1, 1}, 1, 0, 0, 0, 0, 10, 300, 90 * degree},
    {VehicleClass::rocket, {3000, 200, 4000}, 100, 0, 0, 0, 0, 3000, 3000, 90 * degree},
}};

}  // namespace

VehicleLimits usual_limits(VehicleClass kind) { return usual_values.at(static_cast<std::size_t>(kind)); }

}  // namespace skyloop
