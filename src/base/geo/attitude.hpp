/// How a body stands.
#pragma once

#include <Eigen/Geometry>

#include "base/core/units.hpp"

namespace skyloop {

/// The turn from the axes of a body (forward, right, down) to north, east, down at its place: the field's yaw, pitch
/// and roll, in this order (z, y', x'').
class Attitude {
public:
    /// Level, looking north.
    Attitude() = default;
    /// @param body_to_ned of any length above zero; only its direction counts
    explicit Attitude(const Eigen::Quaterniond& body_to_ned) : body_to_ned_(body_to_ned.normalized()) {}
    /// @param yaw clockwise from true north
    static Attitude roll_pitch_yaw(Angle roll, Angle pitch, Angle yaw);

    [[nodiscard]] const Eigen::Quaterniond& body_to_ned() const { return body_to_ned_; }
    [[nodiscard]] Angle roll() const;   ///< −180° … +180°
    [[nodiscard]] Angle pitch() const;  ///< −90° … +90°
    [[nodiscard]] Angle yaw() const;    ///< −180° … +180°

private:
    Eigen::Quaterniond body_to_ned_ = Eigen::Quaterniond::Identity();
};

}  // namespace skyloop
