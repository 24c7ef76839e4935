/// Rockets and balloons: flights that meet the limits of receivers (FEEDS.md 2.5).
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "motion/trajectory/local_shape.hpp"

namespace skyloop {

/// Straight up on a motor, down on a drogue and then on the main parachute. Air of 1.225 kg/m³ · exp(−h / 8500 m),
/// constant gravity; heights from the pad on are heights above the ellipsoid, as if that were the sea.
struct RocketWish {
    Eigen::Vector3d pad = Eigen::Vector3d::Zero();  ///< east, north, height; m
    double heading = 0;                             ///< rad
    double boost = 100;                             ///< thrust by mass, m/s²
    double burn = 3;                                ///< s
    double drag = 1e-4;                             ///< of the air at sea level: ρ C_D A / 2 m, 1/m
    double drogue = 25;                             ///< falling speed at sea level, m/s
    double main = 6;
    double main_below = 300;  ///< above the pad, m
};
/// No plan: the thrust does not lift it, or the flight takes longer than four hours.
PathPlanResult plan_rocket(const RocketWish& wish);

/// Wind at a height; what lies between two layers has a cubic between theirs.
struct WindLayer {
    double height = 0;  ///< above the ellipsoid, m
    double speed = 0;   ///< m/s
    double to = 0;      ///< clockwise from north, rad
};
/// Ours: light at the ground, a jet of 25 m/s at 11 km, little above 20 km; eastward, as in the middle latitudes.
std::span<const WindLayer> usual_winds();

/// Up at a constant speed with the wind, burst, and down on a parachute whose speed falls with the air's density
/// (scale height 7500 m).
struct BalloonWish {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    double heading = 0;
    double ascent = 5;             ///< m/s
    double burst = 30000;          ///< above the ellipsoid, m
    double descent = 6;            ///< at sea level, m/s
    std::vector<WindLayer> winds;  ///< ascending; empty: the usual ones
};
/// No plan: it bursts below the ground, or the wind takes it 1000 km away.
PathPlanResult plan_balloon(const BalloonWish& wish);

/// Settings with a name: "rocket_1km", "rocket_30km_M3"; false for another one, which changes nothing.
bool choose_rocket(RocketWish& wish, std::string_view preset);
/// "balloon_32km"
bool choose_balloon(BalloonWish& wish, std::string_view preset);

}  // namespace skyloop
