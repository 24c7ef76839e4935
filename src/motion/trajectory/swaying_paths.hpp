/// Vehicles that want to stay where they are, and do not quite: hovering in wind, floating on waves.
#pragma once

#include <cstdint>

#include "motion/trajectory/local_shape.hpp"

namespace skyloop {

/// A multirotor that holds a place in gusts (FEEDS.md 2.4): on each axis six tones between 0.05 and 0.8 Hz, the
/// amplitudes falling with the power 5/6 of the frequency, as turbulence does; half as much upward.
struct HoverWish {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< east, north, height; m
    double heading = 0;                               ///< rad
    double sway = 0.3;                                ///< root mean square on the horizontal axes, m
    double wind = 0;                                  ///< m/s, into which it leans
    double wind_from = 0;                             ///< rad, clockwise from north
    std::uint64_t seed = 1;
};
std::shared_ptr<const LocalShape> hover_shape(const HoverWish& wish);

/// A boat on waves, at anchor or under way, set by a current: five tones about the period of the waves, circles of the
/// water in their direction (Airy's waves on deep water), roll and pitch by the slope of the surface, and a slow yaw of
/// 2°. Its course is not its heading.
struct FloatWish {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    double heading = 0;        ///< rad
    double speed = 0;          ///< through the water, m/s
    double wave_height = 0.5;  ///< significant: four times the root mean square of the surface, m
    double wave_period = 6;    ///< s
    double wave_from = 0;      ///< rad
    double current = 0;        ///< m/s
    double current_to = 0;     ///< rad
    std::uint64_t seed = 1;
};
std::shared_ptr<const LocalShape> float_shape(const FloatWish& wish);

}  // namespace skyloop
