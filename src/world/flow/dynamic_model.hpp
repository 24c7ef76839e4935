/// Dynamic platform models and how far a vehicle may go in them.
#pragma once

#include <limits>

#include "base/core/units.hpp"

namespace skyloop {

/// How the vehicle is expected to move (u-blox: CFG-NAV5 dynModel).
enum class DynamicModel { portable, stationary, pedestrian, automotive, sea, airborne_1g, airborne_2g, airborne_4g };

/// Beyond these a receiver takes its own solution for wrong.
struct MotionLimits {
    static constexpr double any = std::numeric_limits<double>::infinity();
    Metres height{any};  ///< above mean sea level
    MetresPerSecond horizontal_speed{any};
    MetresPerSecond vertical_speed{any};
};

/// u-blox 8 / u-blox M8 receiver description (UBX-13003221), table of the dynamic platform models. Of the airborne
/// models the ceiling alone: their speeds are not looked at.
/// @param airborne_ceiling 50 km up to generation 8, 80 km from M9 on
constexpr MotionLimits motion_limits(DynamicModel model, Metres airborne_ceiling) {
    const auto limits = [](double height, double horizontal, double vertical) {
        return MotionLimits{Metres(height), MetresPerSecond(horizontal), MetresPerSecond(vertical)};
    };
    switch (model) {
        case DynamicModel::portable:
            return limits(12'000, 310, 50);
        case DynamicModel::stationary:
            return limits(9'000, 10, 6);
        case DynamicModel::pedestrian:
            return limits(9'000, 30, 20);
        case DynamicModel::automotive:
            return limits(6'000, 100, 15);
        case DynamicModel::sea:
            return limits(500, 25, 5);
        case DynamicModel::airborne_1g:
        case DynamicModel::airborne_2g:
        case DynamicModel::airborne_4g:
            break;
    }
    return MotionLimits{.height = airborne_ceiling};
}

}  // namespace skyloop
