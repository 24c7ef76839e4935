/// Where an antenna is that does not stand in the middle of its vehicle.
/// A path that was moved while somebody was on it.
#pragma once

#include <Eigen/Core>

#include <memory>
#include <optional>

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "motion/trajectory/trajectory.hpp"

namespace skyloop::inline run {

/// From the point that follows the trajectory to the antenna, in the axes of the vehicle; metres.
struct AntennaOffset {
    double forward = 0, right = 0, down = 0;
    bool operator==(const AntennaOffset&) const = default;
};

/// The path of an antenna on a vehicle that follows another path. Where that path tells how the vehicle stands and
/// turns, the antenna is at R l and moves by ω × l besides (FEEDS.md 0). Else the vehicle is upright, pitch and roll
/// are 0, and looks where it goes; at rest it looks where it last went, and before it ever moved into a given
/// direction.
///
/// State: the heading of the last instant at which it moved. Instants are to come in ascending order.
class LeverArm : public Trajectory {
public:
    /// @param heading_at_rest clockwise from true north, until the vehicle moves
    LeverArm(std::unique_ptr<Trajectory> vehicle, const AntennaOffset& offset, Angle heading_at_rest);
    [[nodiscard]] TruthState at(GpsTime time) const override;

private:
    [[nodiscard]] std::optional<double> course(GpsTime time) const;
    [[nodiscard]] double yaw_rate(GpsTime time, double here) const;
    [[nodiscard]] TruthState turned_with(TruthState state) const;

    std::unique_ptr<Trajectory> vehicle_;
    AntennaOffset offset_;
    mutable double heading_;  // rad
};

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

}  // namespace skyloop::inline run
