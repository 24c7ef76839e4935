/// A path that was moved while somebody was on it.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "base/geo/geodetic.hpp"
#include "motion/trajectory/trajectory.hpp"

namespace skyloop {

/// Another path carried to another place: from there it makes the same way over the ground, in east, north and up.
class MovedPath : public Trajectory {
public:
    /// `path` from now on: at `now` it is at `place`. One that was moved before is moved on, so that any number of
    /// moves costs as much as one.
    static std::unique_ptr<Trajectory> moved(std::unique_ptr<Trajectory> path, const Geodetic& place, GpsTime now);

    [[nodiscard]] TruthState at(GpsTime time) const override;

private:
    explicit MovedPath(std::unique_ptr<Trajectory> path) : path_(std::move(path)) {}
    void move(const Geodetic& place, GpsTime now);

    std::unique_ptr<Trajectory> path_;
    Position<Ecef> from_, to_;                            ///< where the path is at the last move, and where it is then
    Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();  ///< of all moves, ECEF
};

}  // namespace skyloop
