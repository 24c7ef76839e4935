/// A tangent frame: east, north, up at one place of the ellipsoid.
#pragma once

#include <Eigen/Core>

#include "base/geo/frames.hpp"
#include "base/geo/geodetic.hpp"

namespace skyloop::inline base {

/// Where something stands in the sky.
struct LookAngles {
    Angle azimuth;    ///< 0 … 360°, clockwise from true north
    Angle elevation;  ///< −90 … +90°
    Metres range;
};

/// The local tangent plane at an origin (MODELS.md 3.2).
class LocalFrame {
public:
    explicit LocalFrame(const Geodetic& origin);

    [[nodiscard]] const Geodetic& origin() const { return origin_; }
    [[nodiscard]] Position<Enu> to_enu(const Position<Ecef>& point) const;
    [[nodiscard]] Displacement<Enu> to_enu(const Displacement<Ecef>& vector) const;
    [[nodiscard]] Velocity<Enu> to_enu(const Velocity<Ecef>& velocity) const;
    [[nodiscard]] Position<Ecef> to_ecef(const Position<Enu>& point) const;
    [[nodiscard]] Displacement<Ecef> to_ecef(const Displacement<Enu>& vector) const;
    [[nodiscard]] Velocity<Ecef> to_ecef(const Velocity<Enu>& velocity) const;
    /// Azimuth, elevation and range from the origin to `target`.
    [[nodiscard]] LookAngles look_angles(const Position<Ecef>& target) const;

private:
    Geodetic origin_;
    Position<Ecef> origin_ecef_;
    Eigen::Matrix3d rotation_;  ///< rows east, north, up: ECEF to ENU
};

}  // namespace skyloop::inline base
