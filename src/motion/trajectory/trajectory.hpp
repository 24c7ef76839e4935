/// Where the antenna is over time.
/// A path that several antennas share.
/// What a simulator, or any other live source, says of its vehicle.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "world/flow/truth_state.hpp"

namespace skyloop::inline motion {

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

/// Is where another path is, which it keeps alive.
class SharedPath : public Trajectory {
public:
    explicit SharedPath(std::shared_ptr<const Trajectory> path) : path_(std::move(path)) {}
    [[nodiscard]] TruthState at(GpsTime time) const override { return path_->at(time); }

private:
    std::shared_ptr<const Trajectory> path_;
};

/// One statement of a live source, in our frames and units, whatever its own are. Every adapter gives these and nothing
/// else (FEEDS.md 0).
struct TruthSample {
    std::string vehicle = "0";                 ///< which one of the source's
    std::optional<Nanoseconds> source_time{};  ///< on the source's own clock; nothing: it tells none
    std::int64_t received_ns = 0;              ///< when it came, on our steady clock (steady_clock_ns())
    Position<Ecef> position;
    std::optional<Velocity<Ecef>> velocity{};       ///< over ground
    std::optional<Eigen::Vector3d> acceleration{};  ///< of the motion, gravity not in it; ECEF axes, m/s²
    std::optional<Attitude> attitude{};
    std::optional<Eigen::Vector3d> turn_rate{};  ///< body axes, rad/s
    bool jump = false;  ///< the source says that it begins anew here: no way leads from the sample before to this one
};

}  // namespace skyloop::inline motion
