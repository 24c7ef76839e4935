/// Where an antenna is that does not stand in the middle of its vehicle.
#pragma once

#include <memory>
#include <optional>

#include "base/core/units.hpp"
#include "motion/trajectory/trajectory.hpp"

namespace skyloop {

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

}  // namespace skyloop
