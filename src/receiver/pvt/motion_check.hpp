/// Whether a vehicle of a dynamic model can move like that.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/geo/geodetic.hpp"
#include "base/time/gps_time.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop::inline receiver {

/// None where the settings have no limits.
MotionLimits motion_limits(const ReceiverSettings& settings);

/// What is solved lies within the limits of the model.
///
/// State: the last velocity, and the acceleration, averaged over half a second.
class MotionCheck {
public:
    /// @param height above mean sea level @param velocity east, north, up, m/s; times ascend
    bool passes(const MotionLimits& limits, GpsTime time, Metres height, const Eigen::Vector3d& velocity);
    void reset() { *this = MotionCheck(); }

private:
    void follow(GpsTime time, const Eigen::Vector3d& velocity);

    std::optional<GpsTime> time_;
    Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero(), acceleration_ = Eigen::Vector3d::Zero();
};

}  // namespace skyloop::inline receiver
