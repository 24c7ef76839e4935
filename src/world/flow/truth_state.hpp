/// Where the antenna really is.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "base/geo/attitude.hpp"
#include "base/geo/frames.hpp"
#include "base/geo/geodetic.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline world {

/// How the vehicle stands and turns.
struct Orientation {
    Attitude attitude{};
    Eigen::Vector3d turn_rate = Eigen::Vector3d::Zero();  ///< against the Earth, in the body's axes, rad/s
};

/// The true state of the antenna at one instant. `geodetic` is `position` in other words, computed once.
struct TruthState {
    GpsTime time;
    Position<Ecef> position;
    Velocity<Ecef> velocity;
    Geodetic geodetic;
    std::optional<Orientation> orientation{};  ///< of its vehicle; nothing: the path does not tell
};

}  // namespace skyloop::inline world
