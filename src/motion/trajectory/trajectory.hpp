/// Where the antenna is over time.
#pragma once

#include "base/time/gps_time.hpp"
#include "world/flow/truth_state.hpp"

namespace skyloop {

/// A path of the antenna.
class Trajectory {
public:
    virtual ~Trajectory() = default;
    /// The true state at `time`; before its start a path stands at its beginning, after its end at its last point.
    [[nodiscard]] virtual TruthState at(GpsTime time) const = 0;
};

/// A path of a file, which can be played faster, from its middle or again and again: PlayedPath.
class FilePath : public Trajectory {
public:
    /// From its beginning to its end; infinite where it stands for ever.
    [[nodiscard]] virtual Seconds duration() const = 0;
    /// ECEF, m/s²: the derivative of at()'s velocity.
    [[nodiscard]] virtual Eigen::Vector3d acceleration(GpsTime time) const = 0;
};

}  // namespace skyloop
