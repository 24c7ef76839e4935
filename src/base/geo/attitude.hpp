/// How a body stands.
/// Attitudes against the Earth as a whole, in which they can be compared from place to place.
#pragma once

#include <Eigen/Geometry>

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"

namespace skyloop::inline base {

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

/// The turn from north, east, down at a place to the axes of ECEF (MODELS.md 3.2).
Eigen::Quaterniond ned_to_ecef(const Geodetic& place);
/// The turn from the body's axes to those of ECEF.
inline Eigen::Quaterniond body_to_ecef(const Attitude& attitude, const Geodetic& place) {
    return ned_to_ecef(place) * attitude.body_to_ned();
}
/// The attitude at `place` of a body that is turned by `body_to_ecef`.
inline Attitude attitude_at(const Geodetic& place, const Eigen::Quaterniond& body_to_ecef) {
    return Attitude(ned_to_ecef(place).conjugate() * body_to_ecef);
}

}  // namespace skyloop::inline base
